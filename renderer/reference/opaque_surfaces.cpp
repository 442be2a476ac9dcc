// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/opaque_surfaces.h"

#include <cmath>
#include <numbers>

#include "reference/texture.h"

namespace nightcity {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Surfaces are shown at a tenth of their colour (the paper, `--surfaces dim`).
constexpr double kDim = 0.1;

// Share of a triangle's size by which its edges reach further, so that rounding
// leaves no gap between neighbours.
constexpr double kEdgeSlack = 1e-9;

std::vector<Bounds> triangleBounds(const FlatScene& scene) {
    std::vector<Bounds> bounds(scene.triangles.size());
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            bounds[i].add(glm::dvec3(scene.positions[scene.triangles[i].vertex[corner]]));
        }
    }
    return bounds;
}

std::vector<Bounds> windowBounds(const FlatScene& scene) {
    std::vector<Bounds> bounds(scene.windows.size());
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const Window& window = scene.windows[i];
        const glm::dvec3 extent =
            glm::abs(glm::dvec3(window.halfU)) + glm::abs(glm::dvec3(window.halfV));
        bounds[i].add(glm::dvec3(window.centre) - extent);
        bounds[i].add(glm::dvec3(window.centre) + extent);
    }
    return bounds;
}

glm::dvec3 paneNormal(const Window& window) {
    return glm::normalize(glm::cross(glm::dvec3(window.halfU), glm::dvec3(window.halfV)));
}

// A Lambertian pane that shines to its front only: L = P / (pi A).
glm::dvec3 paneRadiance(const Window& window) {
    const double area = 4 * glm::length(glm::cross(glm::dvec3(window.halfU), glm::dvec3(window.halfV)));
    return double(window.power) / (std::numbers::pi * area) * glm::dvec3(window.colour);
}

}  // namespace

OpaqueSurfaces::OpaqueSurfaces(const FlatScene& scene, int frame)
    : scene_(scene),
      windowsOn_(scene.windowsOn(frame)),
      triangles_(triangleBounds(scene)),
      windows_(windowBounds(scene)) {}

// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
OpaqueSurfaces::TriangleHit OpaqueSurfaces::nearestTriangle(const Ray& ray) const {
    TriangleHit best{kInfinity, kNone, {}};
    const auto farthest = [&] { return best.distance; };
    triangles_.visitAlong(ray.origin, ray.direction, farthest, [&](std::uint32_t index) {
        const uvec3 v = scene_.triangles[index].vertex;
        const glm::dvec3 a(scene_.positions[v.x]);
        const glm::dvec3 ab = glm::dvec3(scene_.positions[v.y]) - a;
        const glm::dvec3 ac = glm::dvec3(scene_.positions[v.z]) - a;
        const glm::dvec3 p = glm::cross(ray.direction, ac);
        const double determinant = glm::dot(ab, p);
        if (determinant == 0) {
            return;
        }
        const glm::dvec3 s = ray.origin - a;
        const glm::dvec3 q = glm::cross(s, ab);
        const double second = glm::dot(s, p) / determinant;
        const double third = glm::dot(ray.direction, q) / determinant;
        const double distance = glm::dot(ac, q) / determinant;
        const bool inside =
            second >= -kEdgeSlack && third >= -kEdgeSlack && second + third <= 1 + kEdgeSlack;
        const bool nearer = distance < best.distance ||
                            (distance == best.distance && index < best.triangle);
        if (inside && distance > 0 && nearer) {
            best = {distance, index, {second, third}};
        }
    });
    return best;
}

void OpaqueSurfaces::seeTriangle(const Ray& ray, const TriangleHit& found, SurfaceHit& hit) const {
    if (!(found.distance < hit.distance)) {
        return;
    }
    const Triangle& triangle = scene_.triangles[found.triangle];
    const uvec3 v = triangle.vertex;
    const glm::dvec3 a(scene_.positions[v.x]);
    const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(scene_.positions[v.y]) - a,
                                                        glm::dvec3(scene_.positions[v.z]) - a));
    const Material& material = scene_.materials[triangle.material];
    glm::dvec3 colour(material.reflectance);
    if (!scene_.texcoords.empty()) {
        const glm::dvec2 uv =
            (1 - found.weights.x - found.weights.y) * glm::dvec2(scene_.texcoords[v.x]) +
            found.weights.x * glm::dvec2(scene_.texcoords[v.y]) +
            found.weights.y * glm::dvec2(scene_.texcoords[v.z]);
        colour *= textureColour(scene_, material, uv);
    }
    hit.distance = found.distance;
    hit.normal = glm::dot(normal, ray.direction) > 0 ? -normal : normal;
    hit.reflectance = colour;
    hit.radiance = kDim * colour;
    hit.materialId = float(triangle.material);
}

void OpaqueSurfaces::seeGround(const Ray& ray, SurfaceHit& hit) const {
    if (!scene_.ground || ray.direction.z == 0) {
        return;
    }
    const double distance = (double(scene_.ground->height) - ray.origin.z) / ray.direction.z;
    if (distance > 0 && distance < hit.distance) {
        hit.distance = distance;
        hit.normal = {0, 0, ray.direction.z > 0 ? -1 : 1};
        hit.reflectance = glm::dvec3(scene_.materials[scene_.ground->material].reflectance);
        hit.radiance = kDim * hit.reflectance;
        hit.materialId = float(scene_.ground->material);
    }
}

double OpaqueSurfaces::crossPane(const Ray& ray, std::uint32_t index) const {
    const Window& window = scene_.windows[index];
    const glm::dvec3 u(window.halfU), v(window.halfV);
    const glm::dvec3 normal = paneNormal(window);
    const double approach = glm::dot(ray.direction, normal);
    if ((window.flags & kWindowSphere) != 0 || approach == 0) {  // spheres light, but are not seen
        return kInfinity;
    }
    const double distance = glm::dot(glm::dvec3(window.centre) - ray.origin, normal) / approach;
    const glm::dvec3 place = ray.at(distance) - glm::dvec3(window.centre);
    const bool inside = std::abs(glm::dot(place, u)) <= glm::dot(u, u) &&
                        std::abs(glm::dot(place, v)) <= glm::dot(v, v);
    return inside && distance > 0 ? distance : kInfinity;
}

// `hit` is what is seen without panes: where it lies before the pane by more than
// kPaneOnWall, the pane is hidden.
void OpaqueSurfaces::seePanes(const Ray& ray, SurfaceHit& hit) const {
    const double opaque = hit.distance;
    double nearest = kInfinity;
    const auto farthest = [&] { return nearest; };
    windows_.visitAlong(ray.origin, ray.direction, farthest, [&](std::uint32_t index) {
        const Window& window = scene_.windows[index];
        const glm::dvec3 normal = paneNormal(window);
        const double facing = glm::dot(ray.direction, normal);
        const double distance = crossPane(ray, index);
        const double wallInFront = (distance - opaque) * std::abs(facing);
        const double reach = facing < 0 ? kPaneOnWall : 0;
        if (!(distance < nearest) || !(wallInFront <= reach)) {
            return;
        }
        nearest = distance;
        hit.distance = distance;
        hit.normal = facing > 0 ? -normal : normal;
        hit.radiance = facing < 0 && windowsOn_[index] ? paneRadiance(window) : glm::dvec3(0);
        hit.reflectance = glm::dvec3(0);
        hit.materialId = -1;
    });
}

SurfaceHit OpaqueSurfaces::nearest(const Ray& ray) const {
    SurfaceHit hit;
    seeTriangle(ray, nearestTriangle(ray), hit);
    seeGround(ray, hit);
    seePanes(ray, hit);
    return hit;
}

}  // namespace nightcity
