// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/surface_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/shadow_intervals.h"

namespace nightcity {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInnerShare = 0.1;  // of a pane's tolerance, for each line of it

// The distance times the cosine at the point: 1 in the haze.
double received(const SurfacePoint& point, glm::dvec3 way) {
    return point.normal == glm::dvec3(0) ? glm::length(way)
                                         : std::max(0.0, glm::dot(point.normal, way));
}

// Cosines at both ends over pi d^2 (m^-2): 0 behind either.
double exchange(const SurfacePoint& point, glm::dvec3 place, glm::dvec3 normal) {
    const glm::dvec3 way = place - point.place;
    const double squared = glm::dot(way, way);
    const double emitted = std::max(0.0, -glm::dot(normal, way));
    return received(point, way) * emitted / (kPi * squared * squared);
}

// Off the surface by a micrometre: above the ground for a point on it.
glm::dvec3 seenSide(const SurfacePoint& point) {
    return point.place + 1e-6 * point.normal;
}

// The fractions of a line on the bright side of the surface.
Interval facing(const SurfacePoint& point, glm::dvec3 begin, glm::dvec3 end) {
    const double a = glm::dot(point.normal, begin - point.place);
    const double b = glm::dot(point.normal, end - point.place);
    if (point.normal == glm::dvec3(0)) {
        return {0, 1};
    }
    if (a <= 0 && b <= 0) {
        return {};
    }
    const double edge = a / (a - b);
    return {a < 0 ? edge : 0.0, b < 0 ? edge : 1.0};
}

// Per watt, through clear air; never below the true value.
double bound(const SurfacePoint& point, const LitWindow& window, Emitter emitter) {
    const double distance = glm::length(window.centre - point.place);
    const bool pane = window.isPane(emitter);
    const double nearest = pane ? distance - window.reach : distance;
    if (glm::dot(point.normal, window.centre - point.place) < (pane ? -window.reach : 0)) {
        return 0;
    }
    // Irradiance under a Lambertian pane is below pi times its radiance, P / A; fluence, seen
    // over half the sphere, below 2 pi times.
    const double share = point.normal == glm::dvec3(0) ? 2 : 1;
    const double under = share / (4 * glm::length(glm::cross(window.halfU, window.halfV)));
    if (pane && nearest <= 0) {
        return under;
    }
    const bool cosine = window.pointSource(window.centre, emitter).lobe == Lobe::cosine;
    const double far = std::min(1e100, 1 / ((cosine ? kPi : 4 * kPi) * nearest * nearest));
    return pane ? std::min(under, far) : far;
}

}  // namespace

SurfaceLight::SurfaceLight(const LightScene& lights, const Accuracy& accuracy)
    : lights_(lights), accuracy_(accuracy) {}

WindowSum SurfaceLight::irradiance(const SurfacePoint& point) const {
    std::vector<WindowBound> bounds;
    const auto add = [&](std::uint32_t index) {
        const LitWindow& window = lights_.windows[index];
        const double most = bound(point, window, lights_.model.emitter);
        if (most > 0 && glm::length(window.centre - point.place) <= lights_.reach) {
            bounds.push_back({index, most * window.meanPower()});
        }
    };
    if (lights_.model.lights == Lights::all) {
        for (std::uint32_t i = 0; i < lights_.windows.size(); ++i) {
            add(i);
        }
    } else if (point.box) {
        std::for_each(lights_.listed[*point.box].begin(), lights_.listed[*point.box].end(), add);
    }
    return sumWindows(lights_.windows, std::move(bounds), accuracy_,
                      [&](std::uint32_t index, const Tolerance& tolerance) {
                          return fromWindow(point, lights_.windows[index], tolerance);
                      });
}

Estimate SurfaceLight::fromWindow(const SurfacePoint& point, const LitWindow& window,
                                  const Tolerance& tolerance) const {
    if (window.isPane(lights_.model.emitter)) {
        return fromPane(point, window, tolerance);
    }
    return {fromPoint(point, window), 0};
}

double SurfaceLight::ownExtinction(const SurfacePoint& point) const {
    return lights_.media && point.box ? double(lights_.mediaBoxes[*point.box].extinction) : 0;
}

Hiders SurfaceLight::hidersOf(const SurfacePoint& point, const LitWindow& window) const {
    const Emitter emitter = lights_.model.emitter;
    const auto corners = window.corners();
    const auto source = window.isPane(emitter) ? std::span<const glm::dvec3>(corners)
                                               : std::span<const glm::dvec3>(&window.centre, 1);
    Hiders hiders;
    for (const std::uint32_t index : lights_.occluders.between(source, point.place, point.place)) {
        hiders.addHiding(lights_.occluders.face(index), window, emitter);
    }
    return hiders;
}

double SurfaceLight::fromPoint(const SurfacePoint& point, const LitWindow& window) const {
    const PointSource source = window.pointSource(window.centre, lights_.model.emitter);
    const glm::dvec3 way = source.place - point.place;
    const double distance = glm::length(way);
    const double cosine = received(point, way) / distance;
    const double clear = source.lobe == Lobe::isotropic
                             ? cosine / (4 * kPi * distance * distance)
                             : exchange(point, source.place, source.normal);
    if (!(clear > 0) || distance < source.radius) {
        return 0;
    }
    if (lights_.model.visibility == Visibility::none) {
        return clear * std::exp(-ownExtinction(point) * distance);
    }
    if (lights_.occluders.groundBetween(source.place, seenSide(point))) {
        return 0;
    }
    const ViewTriangle view(point.place, source.place, source.place);
    const Hiders hiders = hidersOf(point, window);
    for (std::size_t i = 0; i < hiders.size(); ++i) {
        if (blocksLine(view, hiders[i])) {
            return 0;
        }
    }
    return clear * std::exp(-lights_.haze.depth(point.place, source.place));
}

// Along one line of the pane, v fixed: the mean over u. What the surface point sees
// of the line is found as what a window sees of a ray.
Estimate SurfaceLight::fromLine(const SurfacePoint& point, const LitWindow& window,
                                const Hiders& hiders, double v,
                                const Tolerance& tolerance) const {
    const glm::dvec3 begin = window.at({-1, v}), end = window.at({1, v});
    const Interval bright = facing(point, begin, end);
    const bool full = lights_.model.visibility == Visibility::full;
    if (bright.isEmpty() ||
        (full && lights_.occluders.groundBetween(0.5 * (begin + end), seenSide(point)))) {
        return {};
    }
    const ViewTriangle view(point.place, begin, end);
    std::vector<Interval> shadows;
    for (std::size_t i = 0; i < hiders.size(); ++i) {
        const Interval hidden = shadow(view, hiders[i]);
        if (!hidden.isEmpty()) {
            shadows.push_back(hidden);
        }
    }
    Estimate total;
    for (const Interval& seen : unshadowed(shadows)) {
        const double from = std::max(seen.begin, bright.begin), to = std::min(seen.end, bright.end);
        if (!(from < to)) {
            continue;
        }
        const auto at = [&](double fraction) { return begin + fraction * (end - begin); };
        const SourceDepth depth = full ? lights_.haze.between(point.place, at(from), at(to))
                                       : SourceDepth::uniform(ownExtinction(point));
        std::vector<double> breaks{from};
        for (const double kink : depth.kinks()) {
            breaks.push_back(from + kink * (to - from));
        }
        breaks.push_back(to);
        total += integrate(
            [&](double fraction) {
                const glm::dvec3 place = at(fraction);
                return exchange(point, place, window.normal) *
                       std::exp(-depth.at(place, glm::length(place - point.place)));
            },
            breaks, tolerance);
    }
    return total;
}

Estimate SurfaceLight::fromPane(const SurfacePoint& point, const LitWindow& window,
                                const Tolerance& tolerance) const {
    if (glm::dot(window.normal, point.place - window.centre) <= 0) {
        return {};
    }
    const Hiders hiders =
        lights_.model.visibility == Visibility::full ? hidersOf(point, window) : Hiders();
    const Tolerance inner{kInnerShare * tolerance.absolute, kInnerShare * tolerance.relative};
    const double across[] = {-1.0, 0.0, 1.0};
    Estimate sum = integrate(
        [&](double v) { return 0.5 * fromLine(point, window, hiders, v, inner).value; }, across,
        tolerance);
    sum.error += inner.of(sum.value);
    return sum;
}

}  // namespace nightcity
