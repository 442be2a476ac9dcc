// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/contribution_bound.h"
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

void joinNeighbours(std::vector<HazeStretch>& stretches) {
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

SingleScattering::SingleScattering(const LightScene& lights, const Accuracy& accuracy)
    : lights_(lights), accuracy_(accuracy) {}

std::vector<HazeStretch> SingleScattering::stretchesOf(std::span<const Segment> segments) const {
    std::vector<HazeStretch> stretches;
    double depth = 0;
    for (const Segment& segment : segments) {
        const MediaBox& box = lights_.mediaBoxes[segment.box];
        const double extinction = box.extinction;
        stretches.push_back({segment.begin, segment.end, extinction,
                             extinction * double(box.albedo), depth});
        depth += extinction * (segment.end - segment.begin);
    }
    return stretches;
}

std::vector<std::span<const HazeStretch>> SingleScattering::litStretches(
    std::span<const Segment> segments, std::span<const HazeStretch> stretches,
    std::vector<std::vector<HazeStretch>>& storage) const {
    const std::size_t count = lights_.windows.size();
    if (lights_.model.lights == Lights::all) {
        return std::vector<std::span<const HazeStretch>>(count, stretches);
    }
    storage.assign(count, {});
    for (std::size_t i = 0; i < segments.size(); ++i) {
        for (const std::uint32_t window : lights_.listed[segments[i].box]) {
            storage[window].push_back(stretches[i]);
        }
    }
    return {storage.begin(), storage.end()};
}

WindowSum SingleScattering::along(const Ray& ray, std::span<const Segment> segments) const {
    std::vector<HazeStretch> stretches = stretchesOf(segments);
    if (lights_.model.lights == Lights::all) {
        joinNeighbours(stretches);
    }
    std::vector<std::vector<HazeStretch>> storage;
    const auto lit = litStretches(segments, stretches, storage);
    std::vector<WindowBound> bounds;
    for (std::uint32_t i = 0; i < lit.size(); ++i) {
        const LitWindow& window = lights_.windows[i];
        double bound = 0;
        for (const HazeStretch& stretch : lit[i]) {
            bound += contributionBound(ray, stretch, window, lights_.model.emitter);
        }
        if (bound > 0) {
            bounds.push_back({i, bound * window.meanPower()});
        }
    }
    return sumWindows(lights_.windows, std::move(bounds), accuracy_,
                      [&](std::uint32_t window, const Tolerance& tolerance) {
                          return fromWindow(ray, lit[window], lights_.windows[window], tolerance);
                      });
}

Estimate SingleScattering::fromWindow(const Ray& ray, std::span<const HazeStretch> stretches,
                                      const LitWindow& window, const Tolerance& tolerance) const {
    if (window.isPane(lights_.model.emitter)) {
        return fromPane(ray, stretches, window, tolerance);
    }
    const PointSource source = window.pointSource(window.centre, lights_.model.emitter);
    if (lights_.model.visibility == Visibility::none) {
        return fromPoint(ray, stretches, source, nullptr, tolerance);
    }
    const RayPart whole = hull(stretches);
    const auto [begin, end] = litPart(ray, source, whole.begin, whole.end);
    if (!(begin < end)) {
        return {};
    }
    const Sight sight(lights_.occluders, window.centre, 0, ray, {begin, end});
    return fromPoint(ray, stretches, source, &sight, tolerance);
}

// The mean of cosine sources over the pane: P / (pi A) times the solid angle, with
// visibility and attenuation inside the integral.
Estimate SingleScattering::fromPane(const Ray& ray, std::span<const HazeStretch> stretches,
                                    const LitWindow& window, const Tolerance& tolerance) const {
    const PointSource middle = window.pointSource(window.centre, lights_.model.emitter);
    const RayPart whole = hull(stretches);
    const auto [begin, end] = litPart(ray, middle, whole.begin, whole.end);
    if (!(begin < end)) {
        return {};
    }
    std::optional<Sight> sight;
    if (lights_.model.visibility == Visibility::full) {
        sight.emplace(lights_.occluders, window.centre, window.reach, ray, RayPart{begin, end});
        if (!sight->trim({window.at({-1, -1}), window.at({1, -1}), window.at({1, 1}),
                          window.at({-1, 1})})) {
            return {};
        }
    }
    const Tolerance inner{kInnerShare * tolerance.absolute, kInnerShare * tolerance.relative};
    const auto mean = [&](glm::dvec2 uv) {
        const PointSource source = window.pointSource(window.at(uv), lights_.model.emitter);
        return 0.25 * fromPoint(ray, stretches, source, sight ? &*sight : nullptr, inner).value;
    };
    // Where edges of shadows meet ends of the ray or other edges.
    const auto hasKinks = [&] { return sight && sight->hasShadows(); };
    const glm::dvec2 nearest = nearestOnPane(ray, {begin, end}, window);
    Estimate sum = integrateRectangle(mean, nearest, tolerance, hasKinks);
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
                    sight ? lights_.haze.between(source.place, ray.at(begin), ray.at(end))
                          : SourceDepth::uniform(stretch.extinction);
                total += airlight(ray, stretch, begin, end, source, depth, share);
            }
        }
    }
    return total;
}

}  // namespace nightcity
