// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_lights.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/box_tree.h"

namespace nightcity {
namespace {

constexpr std::size_t kRoots = 128;  // about so many lights start a walk
constexpr std::size_t kRootLevels = 8;  // at most so many below the root
// Below the roots: far_sight.comp's stack holds as many rounds of a group.
constexpr std::size_t kMostLevels = (kFarStack - 2 * kRoots) / 256;
// Windows are parted by their normals while a component of those ranges over more.
constexpr float kNormalRange = 0.5f;
// Of the tree, that a brick looks into: measured in cities of 1.2 million windows.
constexpr std::uint64_t kLightsABrick = 800;
constexpr std::uint64_t kLightsALargeBrick = 3000;
constexpr uint kLargeScale = 2;  // of such bricks

struct FarEmitter {
    vec3 centre, reach, normal;  // normal 0: all directions
    float power;
    uint window;
};

FarEmitter emitterOf(const Window& window, uint index, Emitter model) {
    const bool sphere = (window.flags & kWindowSphere) != 0;
    const vec3 colour = window.colour;
    FarEmitter emitter{};
    emitter.centre = window.centre;
    emitter.reach = sphere ? vec3(glm::length(window.halfU))
                           : glm::abs(window.halfU) + glm::abs(window.halfV);
    if (!sphere && model != Emitter::isotropic) {
        emitter.normal = glm::normalize(glm::cross(window.halfU, window.halfV));
    }
    emitter.power = window.power * std::max({colour.x, colour.y, colour.z});
    emitter.window = index;
    return emitter;
}

class TreeBuilder {
public:
    TreeBuilder(std::vector<FarEmitter> emitters, std::span<const FarMedium> media,
                const FarCut& cut, FarLights& tree)
        : emitters_(std::move(emitters)),
          media_(media),
          mediaTree_(boundsOf(media)),
          cut_(cut),
          tree_(tree) {
        build(0, emitters_.size(), 0, kPartLevels);
    }

private:
    static std::vector<Bounds> boundsOf(std::span<const FarMedium> media) {
        std::vector<Bounds> bounds;
        for (const FarMedium& medium : media) {
            bounds.push_back({glm::dvec3(medium.lo), glm::dvec3(medium.hi)});
        }
        return bounds;
    }

    uint mediumAround(vec3 lo, vec3 hi) const {
        uint found = kNone;
        mediaTree_.visitTouching({glm::dvec3(lo), glm::dvec3(hi)}, [&](uint index) {
            const FarMedium& medium = media_[index];
            if (glm::all(glm::lessThanEqual(medium.lo, lo)) &&
                glm::all(glm::lessThanEqual(hi, medium.hi))) {
                found = index;
            }
        });
        return found;
    }

    FarLight describe(std::size_t first, std::size_t end) const {
        vec3 lo(INFINITY), hi(-INFINITY);
        glm::dvec3 normals(0);
        FarLight light{};
        double power = 0;
        bool allDirections = false;
        for (std::size_t i = first; i < end; ++i) {
            const FarEmitter& emitter = emitters_[i];
            lo = glm::min(lo, emitter.centre - emitter.reach);
            hi = glm::max(hi, emitter.centre + emitter.reach);
            normals += glm::dvec3(emitter.normal);
            allDirections |= emitter.normal == vec3(0);
            power += double(emitter.power);
        }
        light.centre = end == first + 1 ? emitters_[first].centre : 0.5f * (lo + hi);
        light.reach = glm::max(hi - light.centre, light.centre - lo);
        light.window = emitters_[first].window;
        light.power = float(power);
        light.medium = mediumAround(lo, hi);
        const double length = glm::length(normals);
        light.coneCos = -1;
        if (!allDirections && length > 1e-3) {
            const glm::dvec3 axis = normals / length;
            light.axis = vec3(axis);
            double least = 1;
            for (std::size_t i = first; i < end; ++i) {
                least = std::min(least, glm::dot(axis, glm::dvec3(emitters_[i].normal)));
            }
            light.coneCos = float(end == first + 1 ? 1.0 : least - 1e-6);
        }
        return light;
    }

    // Where the second half begins.
    std::size_t split(std::size_t first, std::size_t end) {
        vec3 lo(INFINITY), hi(-INFINITY), normalLo(INFINITY), normalHi(-INFINITY);
        for (std::size_t i = first; i < end; ++i) {
            lo = glm::min(lo, emitters_[i].centre);
            hi = glm::max(hi, emitters_[i].centre);
            normalLo = glm::min(normalLo, emitters_[i].normal);
            normalHi = glm::max(normalHi, emitters_[i].normal);
        }
        const auto from = emitters_.begin() + std::ptrdiff_t(first);
        const auto to = emitters_.begin() + std::ptrdiff_t(end);
        const vec3 normals = normalHi - normalLo;
        const int turned = widest(normals);
        if (normals[turned] > kNormalRange) {
            const float middle = 0.5f * (normalLo[turned] + normalHi[turned]);
            const auto second = std::stable_partition(
                from, to, [&](const FarEmitter& e) { return e.normal[turned] < middle; });
            return std::size_t(second - emitters_.begin());
        }
        const int axis = widest(hi - lo);
        const auto middle = from + (to - from) / 2;
        std::nth_element(from, middle, to, [&](const FarEmitter& a, const FarEmitter& b) {
            return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis]
                                                    : a.window < b.window;
        });
        return std::size_t(middle - emitters_.begin());
    }

    static int widest(vec3 size) {
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }

    // `parts`: levels to go below here where the light above is not opened.
    void build(std::size_t first, std::size_t end, std::size_t level, uint parts) {
        const std::size_t index = tree_.lights.size();
        tree_.lights.push_back(describe(first, end));
        if (end - first == 1) {
            return;
        }
        const bool isOpen =
            parts == kPartLevels && (level < kRootLevels || cut_.mayOpen(tree_.lights[index]));
        if (!isOpen && parts == 0) {
            bundle(uint(index), first, end);
            return;
        }
        const uint below = isOpen ? parts : parts - 1;
        const std::size_t second = split(first, end);
        build(first, second, level + 1, below);
        tree_.lights[index].second = uint(tree_.lights.size());
        build(second, end, level + 1, below);
    }

    void bundle(uint light, std::size_t first, std::size_t end) {
        tree_.bundles.push_back({light, uint(tree_.bundled.size()), uint(end - first)});
        for (std::size_t i = first; i < end; ++i) {
            tree_.bundled.push_back(emitters_[i].window);
        }
    }

    std::vector<FarEmitter> emitters_;
    std::span<const FarMedium> media_;
    BoxTree mediaTree_;
    const FarCut& cut_;
    FarLights& tree_;
};

std::size_t levelsBelow(const FarLights& tree, uint light) {
    const uint second = tree.lights[light].second;
    return second == 0 ? 0
                       : 1 + std::max(levelsBelow(tree, light + 1), levelsBelow(tree, second));
}

std::vector<uint> chooseRoots(const FarLights& tree) {
    std::vector<uint> roots{0};
    bool more = true;
    for (std::size_t level = 0; more && level < kRootLevels && roots.size() < kRoots; ++level) {
        more = false;
        std::vector<uint> next;
        for (const uint light : roots) {
            const uint second = tree.lights[light].second;
            next.push_back(second == 0 ? light : light + 1);
            if (second != 0) {
                next.push_back(second);
                more = true;
            }
        }
        roots = std::move(next);
    }
    return roots;
}

}  // namespace

FarLights buildFarLights(const FlatScene& scene, std::span<const FarMedium> media,
                         const FarCut& cut, Emitter emitter) {
    FarLights tree;
    std::vector<FarEmitter> emitters;
    for (uint i = 0; i < scene.windows.size(); ++i) {
        const FarEmitter found = emitterOf(scene.windows[i], i, emitter);
        if (found.power > 0) {
            emitters.push_back(found);
            tree.strongest = std::max(tree.strongest, found.power);
        }
    }
    if (emitters.empty()) {
        return tree;
    }
    TreeBuilder(std::move(emitters), media, cut, tree);
    tree.roots = chooseRoots(tree);
    for (const uint root : tree.roots) {
        if (levelsBelow(tree, root) > kMostLevels) {
            throw std::logic_error("the tree over the windows is too deep for the bake");
        }
    }
    return tree;
}

std::uint64_t plannedFarLights(const FarLayout& layout, std::uint64_t windows) {
    std::uint64_t lights = 0;
    for (const FarBrick& brick : layout.bricks) {
        lights += brick.scale < kLargeScale ? kLightsABrick : kLightsALargeBrick;
    }
    return std::min(2 * windows, lights);
}

std::vector<vec3> emissionOf(const FarLights& tree, const FlatScene& scene,
                             std::span<const std::uint8_t> windowOn) {
    const auto ofWindow = [&](uint index) {
        const Window& window = scene.windows[index];
        return windowOn[index] != 0 ? window.power * window.colour : vec3(0);
    };
    std::vector<vec3> emission(tree.lights.size(), vec3(0));
    auto bundle = tree.bundles.rbegin();
    for (std::size_t i = emission.size(); i-- > 0;) {
        const FarLight& light = tree.lights[i];
        if (light.second != 0) {
            emission[i] = emission[i + 1] + emission[light.second];
        } else if (bundle != tree.bundles.rend() && bundle->light == i) {
            for (uint w = 0; w < bundle->windowCount; ++w) {
                emission[i] += ofWindow(tree.bundled[bundle->firstWindow + w]);
            }
            ++bundle;
        } else {
            emission[i] = ofWindow(light.window);
        }
    }
    return emission;
}

std::vector<uint> changedLights(const FarLights& tree, std::span<const vec3> before,
                                std::span<const vec3> after) {
    std::vector<bool> changed(tree.lights.size());
    std::vector<uint> bits((changed.size() + 31) / 32);
    for (std::size_t i = changed.size(); i-- > 0;) {
        const uint second = tree.lights[i].second;
        changed[i] = second == 0 ? before[i] != after[i] : changed[i + 1] || changed[second];
        bits[i / 32] |= (changed[i] ? 1u : 0u) << (i % 32);
    }
    return bits;
}

}  // namespace nightcity
