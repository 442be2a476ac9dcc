// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a ray sees first: walls, panes, ground. Double precision.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "reference/ray.h"
#include "scene/box_tree.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct SurfaceHit {
    double distance = std::numeric_limits<double>::infinity();  // m along the ray
    glm::dvec3 normal{0};    // towards the ray's origin
    glm::dvec3 radiance{0};  // W m^-2 sr^-1, as `--surfaces dim` shows it
    glm::dvec3 reflectance{0};  // of the material there; 0 for sky and panes
    float materialId = -1;   // index of the material, -1 for sky and panes

    bool isSky() const { return distance == std::numeric_limits<double>::infinity(); }
};

class OpaqueSurfaces {
public:
    // With the windows that are on at `frame`. The scene must outlive it.
    OpaqueSurfaces(const FlatScene& scene, int frame);

    SurfaceHit nearest(const Ray& ray) const;

private:
    struct TriangleHit {
        double distance;
        std::uint32_t triangle;
        glm::dvec2 weights;  // of the second and third corner
    };

    TriangleHit nearestTriangle(const Ray& ray) const;
    // Distance at which a ray crosses a pane, or infinity.
    double crossPane(const Ray& ray, std::uint32_t window) const;
    void seeTriangle(const Ray& ray, const TriangleHit& triangle, SurfaceHit& hit) const;
    void seeGround(const Ray& ray, SurfaceHit& hit) const;
    void seePanes(const Ray& ray, SurfaceHit& hit) const;

    const FlatScene& scene_;
    std::vector<std::uint8_t> windowsOn_;
    BoxTree triangles_;
    BoxTree windows_;
};

}  // namespace nightcity
