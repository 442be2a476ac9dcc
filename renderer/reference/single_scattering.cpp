// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "reference/contribution_bound.h"
#include "reference/lit_lists.h"
#include "reference/rectangle_quadrature.h"
#include "reference/sight.h"

namespace nightcity {

namespace {

// Of a point source inside a pane's integral, as a share of the pane's tolerance.
constexpr double kInnerShare = 0.1;

RayPart hull(std::span<const HazeStretch> stretches) {
    return {stretches.front().begin, stretches.back().end};
}

// Whether one stretch goes on in the next as if they were one.
bool continues(const HazeStretch& a, const HazeStretch& b) {
    return a.end == b.begin && a.extinction == b.extinction && a.scattering == b.scattering;
}

// Where on the pane, in [-1, 1]^2, the ray comes nearest to its plane; what lies
// outside the square is clamped to it.
glm::dvec2 nearestOnPane(const Ray& ray, const RayPart& part, const LitWindow& window) {
    const double height = glm::dot(window.normal, ray.origin - window.centre);
    const double slope = glm::dot(window.normal, ray.direction);
    const double crossing = slope != 0 ? -height / slope
                                       : glm::dot(window.centre - ray.origin, ray.direction);
    const glm::dvec3 from = ray.at(std::clamp(crossing, part.begin, part.end)) - window.centre;
    const glm::dvec2 uv(glm::dot(from, window.halfU) / glm::dot(window.halfU, window.halfU),
                        glm::dot(from, window.halfV) / glm::dot(window.halfV, window.halfV));
    return glm::clamp(uv, glm::dvec2(-1), glm::dvec2(1));
}

}  // namespace

SingleScattering::SingleScattering(const FlatScene& scene, int frame,
                                   const RenderSettings& settings, const Accuracy& accuracy)
    : scene_(scene),
      model_(settings.model),
      accuracy_(accuracy),
      occluders_(scene),
      haze_(scene),
      windows_(litWindows(scene, frame)) {
    if (model_.lights != Lights::listed) {
        return;
    }
    std::vector<std::uint32_t> place(scene.windows.size(), kNone);
    for (std::uint32_t i = 0; i < windows_.size(); ++i) {
        place[windows_[i].window] = i;
    }
    for (const auto& list : litLists(scene, frame, settings.lightCap)) {
        std::vector<std::uint32_t>& listed = listed_.emplace_back();
        for (const std::uint32_t window : list) {
            if (place[window] != kNone) {
                listed.push_back(place[window]);
            }
        }
    }
}

std::vector<HazeStretch> SingleScattering::stretchesOf(std::span<const Segment> segments) const {
    std::vector<HazeStretch> stretches;
    double depth = 0;
    for (const Segment& segment : segments) {
        const MediaBox& box = scene_.mediaBoxes[segment.box];
        const double extinction = box.extinction;
        stretches.push_back({segment.begin, segment.end, extinction,
                             extinction * double(box.albedo), depth});
        depth += extinction * (segment.end - segment.begin);
    }
    return stretches;
}

std::vector<SingleScattering::Task> SingleScattering::tasks(
    const Ray& ray, std::span<const Segment> segments, std::span<const HazeStretch> stretches,
    std::vector<std::vector<HazeStretch>>& listed) const {
    std::vector<Task> tasks;
    const auto add = [&](std::size_t window, std::span<const HazeStretch> lit) {
        const double most = lit.empty() ? 0 : bound(ray, lit, windows_[window]);
        if (most > 0) {
            tasks.push_back({&windows_[window], lit, most});
        }
    };
    if (model_.lights == Lights::listed) {
        listed.resize(windows_.size());
        for (std::size_t i = 0; i < segments.size(); ++i) {
            for (const std::uint32_t window : listed_[segments[i].box]) {
                listed[window].push_back(stretches[i]);
            }
        }
    }
    for (std::size_t i = 0; i < windows_.size(); ++i) {
        add(i, model_.lights == Lights::listed ? std::span<const HazeStretch>(listed[i]) : stretches);
    }
    std::stable_sort(tasks.begin(), tasks.end(),
                     [](const Task& a, const Task& b) { return a.bound > b.bound; });
    return tasks;
}

double SingleScattering::bound(const Ray& ray, std::span<const HazeStretch> stretches,
                               const LitWindow& window) const {
    double sum = 0;
    for (const HazeStretch& stretch : stretches) {
        sum += contributionBound(ray, stretch, window, model_.emitter);
    }
    return sum * window.meanPower();
}

ScatteredLight SingleScattering::along(const Ray& ray, std::span<const Segment> segments) const {
    std::vector<HazeStretch> stretches = stretchesOf(segments);
    if (model_.lights == Lights::all) {
        // Neighbours of one haze are one stretch.
        std::vector<HazeStretch> joined;
        for (const HazeStretch& stretch : stretches) {
            if (!joined.empty() && continues(joined.back(), stretch)) {
                joined.back().end = stretch.end;
            } else {
                joined.push_back(stretch);
            }
        }
        stretches = std::move(joined);
    }
    ScatteredLight result;
    if (stretches.empty()) {
        return result;
    }
    std::vector<std::vector<HazeStretch>> listed;
    const std::vector<Task> sorted = tasks(ray, segments, stretches, listed);
    std::vector<double> rest(sorted.size() + 1, 0.0);  // bound of a task and all after it
    for (std::size_t i = sorted.size(); i-- > 0;) {
        rest[i] = rest[i + 1] + sorted[i].bound;
    }
    double mean = 0;  // of the channels, so far: all that is to come adds to it
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (rest[i] <= accuracy_.leftOut * mean) {
            result.leftOut = rest[i];
            break;
        }
        const Task& task = sorted[i];
        const double power = task.window->meanPower();
        const double share = task.bound / rest[0];
        const Tolerance tolerance{0.5 * accuracy_.relative * mean * share / power,
                                  0.5 * accuracy_.relative};
        const Estimate perWatt = fromWindow(ray, task.stretches, *task.window, tolerance);
        result.radiance += perWatt.value * task.window->power;
        result.error += perWatt.error * power;
        mean += perWatt.value * power;
        ++result.windows;
    }
    return result;
}

Estimate SingleScattering::fromWindow(const Ray& ray, std::span<const HazeStretch> stretches,
                                      const LitWindow& window, const Tolerance& tolerance) const {
    if (window.isPane(model_.emitter)) {
        return fromPane(ray, stretches, window, tolerance);
    }
    const PointSource source = window.pointSource(window.centre, model_.emitter);
    if (model_.visibility == Visibility::none) {
        return fromPoint(ray, stretches, source, nullptr, tolerance);
    }
    const RayPart whole = hull(stretches);
    const auto [begin, end] = litPart(ray, source, whole.begin, whole.end);
    if (!(begin < end)) {
        return {};
    }
    const Sight sight(occluders_, window.centre, 0, ray, {begin, end});
    return fromPoint(ray, stretches, source, &sight, tolerance);
}

// The mean of cosine sources over the pane: P / (pi A) times the solid angle, with
// visibility and attenuation inside the integral.
Estimate SingleScattering::fromPane(const Ray& ray, std::span<const HazeStretch> stretches,
                                    const LitWindow& window, const Tolerance& tolerance) const {
    const PointSource middle = window.pointSource(window.centre, model_.emitter);
    const RayPart whole = hull(stretches);
    const auto [begin, end] = litPart(ray, middle, whole.begin, whole.end);
    if (!(begin < end)) {
        return {};
    }
    std::optional<Sight> sight;
    if (model_.visibility == Visibility::full) {
        sight.emplace(occluders_, window.centre, window.reach, ray, RayPart{begin, end});
        if (!sight->trim({window.at({-1, -1}), window.at({1, -1}), window.at({1, 1}),
                          window.at({-1, 1})})) {
            return {};
        }
    }
    const Tolerance inner{kInnerShare * tolerance.absolute, kInnerShare * tolerance.relative};
    const auto mean = [&](glm::dvec2 uv) {
        const PointSource source = window.pointSource(window.at(uv), model_.emitter);
        return 0.25 * fromPoint(ray, stretches, source, sight ? &*sight : nullptr, inner).value;
    };
    const glm::dvec2 nearest = nearestOnPane(ray, {begin, end}, window);
    Estimate sum = integrateRectangle(mean, nearest, tolerance);
    sum.error += inner.of(sum.value);
    return sum;
}

Estimate SingleScattering::fromPoint(const Ray& ray, std::span<const HazeStretch> stretches,
                                     const PointSource& source, const Sight* sight,
                                     const Tolerance& tolerance) const {
    const std::vector<RayPart> seen =
        sight ? sight->seenFrom(source.place) : std::vector<RayPart>{hull(stretches)};
    const double pieces = double(std::max<std::size_t>(1, seen.size() * stretches.size()));
    const Tolerance share{tolerance.absolute / pieces, tolerance.relative};
    Estimate total;
    for (const RayPart& part : seen) {
        for (const HazeStretch& stretch : stretches) {
            const double begin = std::max(part.begin, stretch.begin);
            const double end = std::min(part.end, stretch.end);
            if (begin < end) {
                const SourceDepth depth =
                    sight ? haze_.between(source.place, ray.at(begin), ray.at(end))
                          : SourceDepth::uniform(stretch.extinction);
                total += airlight(ray, stretch, begin, end, source, depth, share);
            }
        }
    }
    return total;
}

}  // namespace nightcity
