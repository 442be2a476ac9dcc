// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "reference/contribution_bound.h"
#include "reference/group_sights.h"
#include "reference/pane_airlight.h"
#include "reference/sight.h"

namespace nightcity {

namespace {

RayPart hull(std::span<const HazeStretch> stretches) {
    return {stretches.front().begin, stretches.back().end};
}

// Whether one stretch goes on in the next as if they were one.
bool continues(const HazeStretch& a, const HazeStretch& b) {
    return a.end == b.begin && a.extinction == b.extinction && a.scattering == b.scattering;
}

// The part of a part of the ray that lies within `reach` of a point.
RayPart withinReach(const Ray& ray, glm::dvec3 point, double reach, const RayPart& part) {
    const double foot = glm::dot(point - ray.origin, ray.direction);
    const glm::dvec3 across = ray.at(foot) - point;
    const double half = std::sqrt(std::max(reach * reach - glm::dot(across, across), 0.0));
    return {std::max(part.begin, foot - half), std::min(part.end, foot + half)};
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
    std::optional<GroupSights> sights;
    if (lights_.model.visibility == Visibility::full && !stretches.empty()) {
        sights.emplace(lights_, ray, hull(stretches));
    }
    return sumWindows(lights_.windows, std::move(bounds), accuracy_,
                      [&](std::uint32_t window, const Tolerance& tolerance) {
                          return fromWindow(ray, lit[window], window, sights ? &*sights : nullptr,
                                            tolerance);
                      });
}

Estimate SingleScattering::fromWindow(const Ray& ray, std::span<const HazeStretch> stretches,
                                      std::uint32_t index, GroupSights* sights,
                                      const Tolerance& tolerance) const {
    const LitWindow& window = lights_.windows[index];
    const Emitter emitter = lights_.model.emitter;
    const PointSource middle = window.pointSource(window.centre, emitter);
    RayPart part = hull(stretches);
    std::tie(part.begin, part.end) = litPart(ray, middle, part.begin, part.end);
    part = withinReach(ray, window.centre, lights_.reach, part);
    if (part.isEmpty()) {
        return {};
    }
    std::optional<Hiders> hiders;
    if (sights) {
        const GroupSight* sight = sights->ofWindow(index);
        if (sight == nullptr) {
            return {};
        }
        hiders = sight->hidersOf(window, emitter);
    }
    const Hiders* between = hiders ? &*hiders : nullptr;
    return window.isPane(emitter) ? fromPane(ray, stretches, window, between, part, tolerance)
                                  : fromPoint(ray, stretches, middle, between, part, tolerance);
}

// A Lambertian pane: P / (pi A) times the solid angle, with visibility and attenuation
// inside the integral over the pane.
Estimate SingleScattering::fromPane(const Ray& ray, std::span<const HazeStretch> stretches,
                                    const LitWindow& window, const Hiders* hiders,
                                    const RayPart& part, const Tolerance& tolerance) const {
    const PaneSight sight(window, hiders ? *hiders : Hiders(),
                          hiders ? lights_.occluders.groundHeight() : std::nullopt, ray, part);
    const double pieces = double(std::max<std::size_t>(1, sight.open().size() * stretches.size()));
    const Tolerance share{tolerance.absolute / pieces, tolerance.relative};
    Estimate total;
    for (const RayPart& open : sight.open()) {
        for (const HazeStretch& stretch : stretches) {
            const RayPart piece{std::max(open.begin, stretch.begin), std::min(open.end, stretch.end)};
            if (!piece.isEmpty()) {
                const HazeBetween haze =
                    hiders ? lights_.haze.between(window.corners(), ray.at(piece.begin),
                                                  ray.at(piece.end))
                           : HazeBetween::uniform(stretch.extinction);
                total += paneAirlight(ray, stretch, piece, window, sight, haze, share);
            }
        }
    }
    return total;
}

Estimate SingleScattering::fromPoint(const Ray& ray, std::span<const HazeStretch> stretches,
                                     const PointSource& source, const Hiders* hiders,
                                     const RayPart& part, const Tolerance& tolerance) const {
    if (hiders && lights_.occluders.groundBetween(source.place, ray.at(0.5 * (part.begin + part.end)))) {
        return {};
    }
    const std::vector<RayPart> seen =
        hiders ? seenFrom(source.place, *hiders, ray, part) : std::vector<RayPart>{part};
    const double pieces = double(std::max<std::size_t>(1, seen.size() * stretches.size()));
    const Tolerance share{tolerance.absolute / pieces, tolerance.relative};
    Estimate total;
    for (const RayPart& open : seen) {
        for (const HazeStretch& stretch : stretches) {
            const RayPart piece{std::max(open.begin, stretch.begin), std::min(open.end, stretch.end)};
            if (!piece.isEmpty()) {
                const SourceDepth depth =
                    hiders ? lights_.haze.between(source.place, ray.at(piece.begin), ray.at(piece.end))
                           : SourceDepth::uniform(stretch.extinction);
                total += airlight(ray, stretch, piece.begin, piece.end, source, depth, share);
            }
        }
    }
    return total;
}

}  // namespace nightcity
