// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace nightcity {
namespace {

constexpr double kPi = std::numbers::pi;

// Directions within an angle of an axis.
struct Cone {
    glm::dvec3 axis{0, 0, 1};
    double angle = kPi;  // rad; pi: all directions
};

// A cone that holds both, about the mean of the axes: not the least one, but near it for
// windows that face about the same way.
Cone joined(const Cone& a, const Cone& b) {
    const glm::dvec3 sum = a.axis + b.axis;
    if (a.angle >= kPi || b.angle >= kPi || glm::dot(sum, sum) < 1e-6) {
        return {};
    }
    Cone cone;
    cone.axis = glm::normalize(sum);
    const auto reach = [&](const Cone& part) {
        return std::acos(std::clamp(glm::dot(cone.axis, part.axis), -1.0, 1.0)) + part.angle;
    };
    cone.angle = std::min(kPi, std::max(reach(a), reach(b)));
    return cone;
}

struct Light {
    std::uint32_t window;
    std::uint32_t side;  // of a cube about the window: the one that it faces most
    glm::vec3 centre;
};

struct Subtree {
    std::uint32_t node;
    Cone cone;
    double power;
};

class Builder {
public:
    Builder(const FlatScene& scene, Emitter emitter) : scene_(scene), emitter_(emitter) {
        tree_.trails.assign(scene.windows.size(), 0);
    }

    LightTree build(std::span<const std::uint8_t> windowOn) {
        for (std::uint32_t i = 0; i < scene_.windows.size(); ++i) {
            const Window& window = scene_.windows[i];
            if (windowOn[i] != 0 && meanPower(window) > 0) {
                lights_.push_back({i, sideOf(window), window.centre});
            }
        }
        if (!lights_.empty()) {
            tree_.nodes.reserve(2 * lights_.size() - 1);
            std::stable_sort(lights_.begin(), lights_.end(),
                             [](const Light& a, const Light& b) { return a.side < b.side; });
            buildSides(lights_, 0, 0);
        }
        return std::move(tree_);
    }

private:
    static double meanPower(const Window& window) {
        return double(window.power) *
               (double(window.colour.x) + double(window.colour.y) + double(window.colour.z)) / 3;
    }

    static glm::dvec3 normal(const Window& window) {
        return glm::normalize(glm::cross(glm::dvec3(window.halfU), glm::dvec3(window.halfV)));
    }

    static bool isSphere(const Window& window) { return (window.flags & kWindowSphere) != 0; }

    static std::uint32_t sideOf(const Window& window) {
        if (isSphere(window)) {
            return 6;
        }
        const glm::dvec3 n = normal(window), size = glm::abs(n);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        return std::uint32_t(2 * axis + (n[axis] < 0 ? 1 : 0));
    }

    // While a part faces several ways, it is cut where the way changes nearest its middle.
    Subtree buildSides(std::span<Light> part, std::uint32_t trail, std::uint32_t level) {
        if (part.front().side == part.back().side) {
            return buildHalves(part, trail, level);
        }
        const auto changes = [&](std::size_t i) { return part[i - 1].side != part[i].side; };
        const std::size_t middle = part.size() / 2;
        std::size_t best = 0;
        for (std::size_t i = 1; i < part.size(); ++i) {
            const auto off = [&](std::size_t at) { return at > middle ? at - middle : middle - at; };
            if (changes(i) && (best == 0 || off(i) < off(best))) {
                best = i;
            }
        }
        return buildInner(part, best, trail, level, &Builder::buildSides);
    }

    // Halves by number along the longest side of the centres' bounds.
    Subtree buildHalves(std::span<Light> part, std::uint32_t trail, std::uint32_t level) {
        if (part.size() == 1) {
            return buildLeaf(part.front().window, trail);
        }
        glm::vec3 lo = part.front().centre, hi = lo;
        for (const Light& light : part) {
            lo = glm::min(lo, light.centre);
            hi = glm::max(hi, light.centre);
        }
        const glm::vec3 size = hi - lo;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t middle = part.size() / 2;
        std::nth_element(part.begin(), part.begin() + std::ptrdiff_t(middle), part.end(),
                         [axis](const Light& a, const Light& b) {
                             return a.centre[axis] != b.centre[axis]
                                        ? a.centre[axis] < b.centre[axis]
                                        : a.window < b.window;
                         });
        return buildInner(part, middle, trail, level, &Builder::buildHalves);
    }

    using BuildPart = Subtree (Builder::*)(std::span<Light>, std::uint32_t, std::uint32_t);

    Subtree buildInner(std::span<Light> part, std::size_t cut, std::uint32_t trail,
                       std::uint32_t level, BuildPart build) {
        const auto index = std::uint32_t(tree_.nodes.size());
        tree_.nodes.emplace_back();
        const Subtree first = (this->*build)(part.first(cut), trail, level + 1);
        const Subtree second =
            (this->*build)(part.subspan(cut), trail | 1u << level, level + 1);
        const LightNode& a = tree_.nodes[first.node];
        const LightNode& b = tree_.nodes[second.node];
        return store(index, glm::min(a.lo, b.lo), glm::max(a.hi, b.hi),
                     joined(first.cone, second.cone), first.power + second.power, second.node,
                     std::uint32_t(part.size()));
    }

    Subtree buildLeaf(std::uint32_t index, std::uint32_t trail) {
        const Window& window = scene_.windows[index];
        tree_.trails[index] = trail;
        const auto node = std::uint32_t(tree_.nodes.size());
        tree_.nodes.emplace_back();
        const bool pane = emitter_ == Emitter::pane && !isSphere(window);
        const glm::vec3 extent =
            pane ? glm::abs(window.halfU) + glm::abs(window.halfV) : glm::vec3(0);
        const Cone cone = isSphere(window) ? Cone{} : Cone{normal(window), 0};
        return store(node, window.centre - extent, window.centre + extent, cone,
                     meanPower(window), kLightLeaf | index, 1);
    }

    Subtree store(std::uint32_t index, glm::vec3 lo, glm::vec3 hi, const Cone& cone, double power,
                  std::uint32_t child, std::uint32_t count) {
        constexpr double kRounding = 1e-3;  // rad: the shader's cosines are floats
        const double angle = std::min(kPi, cone.angle + kRounding);
        tree_.nodes[index] = {lo,
                              float(power),
                              hi,
                              angle >= kPi ? -1.0f : float(std::cos(angle)),
                              glm::vec3(cone.axis),
                              child,
                              count};
        return {index, cone, power};
    }

    const FlatScene& scene_;
    Emitter emitter_;
    std::vector<Light> lights_;
    LightTree tree_;
};

}  // namespace

LightTree buildLightTree(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                         Emitter emitter) {
    return Builder(scene, emitter).build(windowOn);
}

}  // namespace nightcity
