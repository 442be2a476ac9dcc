// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "brute_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace nightcity {

namespace {

constexpr double kPi = std::numbers::pi;

// Signed volume test: where the way from a to b pierces the triangle, as a fraction;
// infinity where it does not.
double pierce(const std::array<glm::dvec3, 3>& t, glm::dvec3 a, glm::dvec3 b) {
    const glm::dvec3 way = b - a;
    const auto volume = [&](glm::dvec3 p, glm::dvec3 q) {
        return glm::dot(way, glm::cross(p - a, q - a));
    };
    const double u = volume(t[0], t[1]), v = volume(t[1], t[2]), w = volume(t[2], t[0]);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) {
        return std::numeric_limits<double>::infinity();
    }
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double along = glm::dot(way, normal);
    return along == 0 ? std::numeric_limits<double>::infinity()
                      : glm::dot(t[0] - a, normal) / along;
}

bool contains(const MediaBox& box, glm::dvec3 p) {
    return glm::all(glm::greaterThanEqual(p, glm::dvec3(box.lo))) &&
           glm::all(glm::lessThan(p, glm::dvec3(box.hi)));
}

}  // namespace

BruteForce::BruteForce(const FlatScene& scene, const Model& model) : scene_(scene), model_(model) {
    for (const Triangle& t : scene.triangles) {
        triangles_.push_back({glm::dvec3(scene.positions[t.vertex.x]),
                              glm::dvec3(scene.positions[t.vertex.y]),
                              glm::dvec3(scene.positions[t.vertex.z])});
    }
}

std::vector<BruteForce::Light> BruteForce::lights(int side) const {
    std::vector<Light> lights;
    const int n = model_.emitter == Emitter::pane ? side : 1;
    for (const Window& window : scene_.windows) {
        const glm::dvec3 u(window.halfU), v(window.halfV);
        for (int i = 0; i < n * n; ++i) {
            const double x = (2 * (i % n) + 1.0) / n - 1, y = (2 * (i / n) + 1.0) / n - 1;
            lights.push_back({glm::dvec3(window.centre) + x * u + y * v,
                              glm::normalize(glm::cross(u, v)),
                              double(window.power) * glm::dvec3(window.colour) / double(n * n)});
        }
    }
    return lights;
}

bool BruteForce::visible(glm::dvec3 a, glm::dvec3 b) const {
    if (scene_.ground && (a.z < scene_.ground->height) != (b.z < scene_.ground->height)) {
        return false;
    }
    return std::none_of(triangles_.begin(), triangles_.end(), [&](const auto& t) {
        const double at = pierce(t, a, b);
        return at > 0 && at < 1 - 1e-9;
    });
}

double BruteForce::opticalDepth(glm::dvec3 a, glm::dvec3 b) const {
    double depth = 0;
    for (const MediaBox& box : scene_.mediaBoxes) {
        double enter = 0, leave = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double first = (box.lo[axis] - a[axis]) / (b[axis] - a[axis]);
            const double second = (box.hi[axis] - a[axis]) / (b[axis] - a[axis]);
            enter = std::max(enter, std::min(first, second));
            leave = std::min(leave, std::max(first, second));
        }
        depth += double(box.extinction) * std::max(0.0, leave - enter);
    }
    return depth * glm::length(b - a);
}

double BruteForce::clearFluence(const Light& light, glm::dvec3 point) const {
    const glm::dvec3 way = point - light.place;
    const double d = glm::length(way);
    return model_.emitter == Emitter::isotropic
               ? 1 / (4 * kPi * d * d)
               : std::max(0.0, glm::dot(light.normal, way)) / (kPi * d * d * d);
}

glm::dvec3 BruteForce::glow(glm::dvec3 origin, glm::dvec3 direction, double farthest, int steps,
                            int side) const {
    const std::vector<Light> sources = lights(side);
    const double step = farthest / steps;
    glm::dvec3 sum(0);
    double depth = 0;  // from the eye to the step's begin
    for (int i = 0; i < steps; ++i) {
        const glm::dvec3 point = origin + direction * ((i + 0.5) * step);
        const auto box = std::find_if(scene_.mediaBoxes.begin(), scene_.mediaBoxes.end(),
                                      [&](const MediaBox& b) { return contains(b, point); });
        if (box == scene_.mediaBoxes.end()) {
            continue;
        }
        const double extinction = box->extinction;
        const double scattering = extinction * double(box->albedo);
        const double seen = std::exp(-depth - 0.5 * extinction * step) * step;
        for (const Light& light : sources) {
            const double fluence = clearFluence(light, point);
            if (fluence > 0 && visible(light.place, point)) {
                sum += scattering / (4 * kPi) * seen * fluence *
                       std::exp(-opticalDepth(light.place, point)) * light.power;
            }
        }
        depth += extinction * step;
    }
    return sum;
}

double BruteForce::firstSurface(glm::dvec3 origin, glm::dvec3 direction) const {
    double first = std::numeric_limits<double>::infinity();
    for (const auto& t : triangles_) {
        const double at = pierce(t, origin, origin + direction);
        first = at > 0 ? std::min(first, at) : first;
    }
    if (scene_.ground) {
        const double at = (scene_.ground->height - origin.z) / direction.z;
        first = at > 0 ? std::min(first, at) : first;
    }
    return first;
}

glm::dvec3 BruteForce::irradiance(glm::dvec3 point, glm::dvec3 normal, int side) const {
    const glm::dvec3 lifted = point + 1e-7 * normal;
    glm::dvec3 sum(0);
    for (const Light& light : lights(side)) {
        const glm::dvec3 way = light.place - point;
        const double cosine = glm::dot(normal, way) / glm::length(way);
        const double fluence = clearFluence(light, point);
        if (cosine > 0 && fluence > 0 && visible(light.place, lifted)) {
            sum += fluence * cosine * std::exp(-opticalDepth(light.place, point)) * light.power;
        }
    }
    return sum;
}

}  // namespace nightcity
