// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/haze.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "reference/hull_region.h"
#include "reference/view_triangle.h"

namespace nightcity {

namespace {

constexpr double kTriangleArea = 0.5;   // of all weights (a, b) with a, b >= 0 and a + b <= 1
constexpr double kAreaRounding = 1e-13;
constexpr double kSameFraction = 1e-12;

// Boxes of one haze that share a whole face become one: fewer ways to cut, and no
// kinks where nothing changes.
void joinAlong(int axis, std::vector<HazeBox>& boxes) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const auto section = [&](const HazeBox& box) {
        const Bounds& at = box.bounds;
        return std::tuple(at.lo[b], at.hi[b], at.lo[c], at.hi[c], box.extinction);
    };
    std::sort(boxes.begin(), boxes.end(), [&](const HazeBox& x, const HazeBox& y) {
        return std::tuple(section(x), x.bounds.lo[axis]) < std::tuple(section(y), y.bounds.lo[axis]);
    });
    std::vector<HazeBox> joined;
    for (const HazeBox& box : boxes) {
        if (!joined.empty() && section(joined.back()) == section(box) &&
            joined.back().bounds.hi[axis] == box.bounds.lo[axis]) {
            joined.back().bounds.hi[axis] = box.bounds.hi[axis];
        } else {
            joined.push_back(box);
        }
    }
    boxes = std::move(joined);
}

std::vector<HazeBox> hazeBoxes(std::span<const MediaBox> media) {
    std::vector<HazeBox> boxes;
    for (const MediaBox& box : media) {
        if (box.extinction > 0) {
            boxes.push_back({{glm::dvec3(box.lo), glm::dvec3(box.hi)}, double(box.extinction)});
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        joinAlong(axis, boxes);
    }
    return boxes;
}

std::vector<Bounds> boundsOf(const std::vector<HazeBox>& boxes) {
    std::vector<Bounds> bounds;
    for (const HazeBox& box : boxes) {
        bounds.push_back(box.bounds);
    }
    return bounds;
}

// A convex polygon in the weights of a view triangle. Each of the six faces of a
// box adds at most one corner to the triangle's three.
class WeightPolygon {
public:
    WeightPolygon() : count_(3) { corner_[0] = {0, 0}, corner_[1] = {1, 0}, corner_[2] = {0, 1}; }

    // Keeps the part where constant + dot(slope, weights) >= 0.
    void cut(double constant, glm::dvec2 slope) {
        std::array<glm::dvec2, 9> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const glm::dvec2 a = corner_[i], b = corner_[(i + 1) % count_];
            const double atA = constant + glm::dot(slope, a);
            const double atB = constant + glm::dot(slope, b);
            if (atA >= 0) {
                kept[count++] = a;
            }
            if ((atA >= 0) != (atB >= 0)) {
                kept[count++] = a + (b - a) * (atA / (atA - atB));
            }
        }
        corner_ = kept;
        count_ = count;
    }

    void cutToBox(const ViewTriangle& view, const Bounds& box) {
        for (int axis = 0; axis < 3 && count_ > 0; ++axis) {
            const glm::dvec2 slope(view.toBegin()[axis], view.toEnd()[axis]);
            cut(view.apex()[axis] - box.lo[axis], slope);
            if (count_ > 0) {
                cut(box.hi[axis] - view.apex()[axis], -slope);
            }
        }
    }

    double area() const {
        double twice = 0;
        for (std::size_t i = 2; i < count_; ++i) {
            const glm::dvec2 a = corner_[i - 1] - corner_[0], b = corner_[i] - corner_[0];
            twice += a.x * b.y - a.y * b.x;
        }
        return 0.5 * twice;
    }

    void addKinks(std::vector<double>& kinks) const {
        for (std::size_t i = 0; i < count_; ++i) {
            if (corner_[i].x + corner_[i].y > kSameFraction) {
                kinks.push_back(stretchFraction(corner_[i]));
            }
        }
    }

private:
    std::array<glm::dvec2, 9> corner_;
    std::size_t count_;
};

void sortKinks(std::vector<double>& kinks) {
    std::sort(kinks.begin(), kinks.end());
    double last = 0;
    std::erase_if(kinks, [&](double kink) {
        const bool keep = kink > last + kSameFraction && kink < 1 - kSameFraction;
        last = keep ? kink : last;
        return !keep;
    });
}

// A straight way between two points.
class Way {
public:
    Way(glm::dvec3 from, glm::dvec3 to) : from_(from), way_(to - from), inverse_(1.0 / way_) {}

    // Length of the part inside a box, as a fraction; lo <= x < hi.
    double partInside(const Bounds& box) const {
        double enter = 0, leave = 1;
        for (int axis = 0; axis < 3; ++axis) {
            if (way_[axis] == 0) {
                if (!(from_[axis] >= box.lo[axis] && from_[axis] < box.hi[axis])) {
                    return 0;
                }
                continue;
            }
            const double a = (box.lo[axis] - from_[axis]) * inverse_[axis];
            const double b = (box.hi[axis] - from_[axis]) * inverse_[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return std::max(0.0, leave - enter);
    }

private:
    glm::dvec3 from_, way_, inverse_;  // inverse: per m, infinite along a face
};

bool holds(const HazeBox& box, std::span<const glm::dvec3> points) {
    return std::all_of(points.begin(), points.end(), [&](glm::dvec3 point) {
        return box.bounds.touches({point, point});
    });
}

}  // namespace

SourceDepth SourceDepth::uniform(double extinction) {
    SourceDepth depth({}, {}, {});
    depth.uniform_ = extinction;
    return depth;
}

double SourceDepth::at(glm::dvec3 place, double distance) const {
    if (uniform_) {
        return *uniform_ * distance;
    }
    const Way way(source_, place);
    double depth = 0;
    for (const HazeBox& box : boxes_) {
        depth += box.extinction * way.partInside(box.bounds);
    }
    return depth * distance;
}

HazeBetween HazeBetween::uniform(double extinction) {
    HazeBetween haze({{{}, extinction}});
    haze.uniform_ = true;
    return haze;
}

HazeBetween::HazeBetween(std::vector<HazeBox> boxes) : boxes_(std::move(boxes)) {
    for (const HazeBox& box : boxes_) {
        largest_ = std::max(largest_, box.extinction);
    }
}

double HazeBetween::depth(glm::dvec3 from, glm::dvec3 to, double distance) const {
    if (uniform_) {
        return largest_ * distance;
    }
    const Way way(from, to);
    double depth = 0;
    for (const HazeBox& box : boxes_) {
        depth += box.extinction * way.partInside(box.bounds);
    }
    return depth * distance;
}

Haze::Haze(std::span<const MediaBox> media) : boxes_(hazeBoxes(media)), tree_(boundsOf(boxes_)) {}

SourceDepth Haze::between(glm::dvec3 source, glm::dvec3 begin, glm::dvec3 end) const {
    const ViewTriangle view(source, begin, end);
    Bounds around;
    for (const glm::dvec3 corner : {source, begin, end}) {
        around.add(corner);
    }
    std::vector<HazeBox> boxes;
    std::vector<double> kinks;
    double covered = 0;
    tree_.visitTouching(around, [&](std::uint32_t index) {
        WeightPolygon polygon;
        polygon.cutToBox(view, boxes_[index].bounds);
        const double area = polygon.area();
        if (area > 0) {
            boxes.push_back(boxes_[index]);
            covered += area;
            polygon.addKinks(kinks);
        }
    });
    const auto differs = [&](const HazeBox& box) {
        return box.extinction != boxes.front().extinction;
    };
    if (boxes.empty()) {
        return SourceDepth::uniform(0);
    }
    if (covered >= kTriangleArea * (1 - kAreaRounding) && std::none_of(boxes.begin(), boxes.end(), differs)) {
        return SourceDepth::uniform(boxes.front().extinction);
    }
    sortKinks(kinks);
    return {source, std::move(boxes), std::move(kinks)};
}

HazeBetween Haze::between(std::span<const glm::dvec3> source, glm::dvec3 begin,
                          glm::dvec3 end) const {
    std::vector<glm::dvec3> points(source.begin(), source.end());
    points.push_back(begin);
    points.push_back(end);
    const HullRegion region(source, begin, end);
    std::vector<std::uint32_t> touched;
    tree_.visitWhere([&](const Bounds& box) { return region.mayTouch(box); },
                     [&](std::uint32_t index) { touched.push_back(index); });
    std::sort(touched.begin(), touched.end());
    std::vector<HazeBox> boxes;
    for (const std::uint32_t index : touched) {
        if (holds(boxes_[index], points)) {
            return HazeBetween::uniform(boxes_[index].extinction);
        }
        boxes.push_back(boxes_[index]);
    }
    return HazeBetween(std::move(boxes));
}

double Haze::depth(glm::dvec3 from, glm::dvec3 to) const {
    Bounds around;
    around.add(from);
    around.add(to);
    const Way way(from, to);
    double depth = 0;
    tree_.visitTouching(around, [&](std::uint32_t index) {
        depth += boxes_[index].extinction * way.partInside(boxes_[index].bounds);
    });
    return depth * glm::length(to - from);
}

}  // namespace nightcity
