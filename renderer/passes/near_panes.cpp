// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/near_panes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "passes/box_nodes.h"
#include "scene/box_tree.h"
#include "scene/convex_faces.h"
#include "transport/near_window.h"

namespace nightcity {
namespace {

constexpr float kWithoutEnd = 1e15f;  // m; a float holds its square
constexpr double kMostTilt = 1e-3;    // sine of the angle between a window and the wall behind it

glm::dvec3 normalOf(const NearPane& pane) {
    return glm::cross(glm::dvec3(pane.uAxis), glm::dvec3(pane.vAxis));
}

bool isSphere(const NearPane& pane) {
    return (pane.flags & kWindowSphere) != 0;
}

NearPane nearPane(const Window& window, Emitter emitter) {
    NearPane pane{};
    pane.centre = window.centre;
    pane.halfU = glm::length(window.halfU);
    pane.flags = window.flags;
    if (isSphere(pane)) {
        pane.uAxis = {1, 0, 0};
        pane.vAxis = {0, 1, 0};
        pane.halfV = kWithoutEnd;
        pane.radiance = window.colour * float(window.power / (4 * std::numbers::pi));
        return pane;
    }
    pane.halfV = glm::length(window.halfV);
    pane.uAxis = window.halfU / pane.halfU;
    pane.vAxis = window.halfV / pane.halfV;
    if (emitter == Emitter::pane) {
        const double area = 4.0 * pane.halfU * pane.halfV;
        pane.closeBy =
            float(std::hypot(pane.halfU, pane.halfV) + 1.01 * kNearCutSides * std::sqrt(area));
        pane.radiance = window.colour * float(window.power / (std::numbers::pi * area));
        return pane;
    }
    const bool isotropic = emitter == Emitter::isotropic;
    pane.halfU = 0;
    pane.halfV = isotropic ? kWithoutEnd : 0;
    pane.radiance = window.colour * float(window.power / ((isotropic ? 4 : 1) * std::numbers::pi));
    return pane;
}

// Of the part of the ball about a pane that it lights. Along an axis it ends at the ball where the
// normal points that way, else at the rim of the pane's plane, `back` m behind it.
Bounds reachOf(const NearPane& pane, double radius, double back) {
    const glm::dvec3 normal = normalOf(pane);
    Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const double rim =
            std::min(radius, radius * std::sqrt(std::max(0.0, 1 - normal[axis] * normal[axis])) +
                                 back * std::abs(normal[axis]));
        bounds.lo[axis] = pane.centre[axis] - (normal[axis] <= 0 ? radius : rim);
        bounds.hi[axis] = pane.centre[axis] + (normal[axis] >= 0 ? radius : rim);
    }
    return bounds;
}

}  // namespace

// The walls that stand close behind windows.
class NearPanes::Walls {
public:
    explicit Walls(const FlatScene& scene) : faces_(scene), tree_(faces_.bounds()) {}

    // m behind the centre of a window to the wall that it hangs on; nothing where it hangs on none.
    std::optional<double> behind(const NearPane& pane) const {
        const glm::dvec3 centre(pane.centre);
        const glm::dvec3 normal = normalOf(pane);
        std::optional<double> nearest;
        const double reach = kPaneOnWall;
        tree_.visitTouching({centre - reach, centre + reach}, [&](std::uint32_t face) {
            const std::optional<double> depth = depthOf(faces_.face(face), centre, normal);
            if (depth && *depth <= reach && *depth < nearest.value_or(INFINITY)) {
                nearest = depth;
            }
        });
        return nearest;
    }

private:
    // Of the centre's foot on a face that is parallel to the window and behind it.
    static std::optional<double> depthOf(std::span<const glm::dvec3> face, glm::dvec3 centre,
                                         glm::dvec3 normal) {
        const glm::dvec3 area = areaVector(face);
        const double size = glm::length(area);
        const double depth = glm::dot(centre - face.front(), normal);
        if (glm::length(glm::cross(area, normal)) > kMostTilt * size || size == 0 || depth < 0) {
            return std::nullopt;
        }
        for (std::size_t i = 0; i < face.size(); ++i) {
            const glm::dvec3 edge = face[(i + 1) % face.size()] - face[i];
            if (glm::dot(glm::cross(edge, centre - face[i]), area) < 0) {
                return std::nullopt;
            }
        }
        return depth;
    }

    ConvexFaces faces_;
    BoxTree tree_;
};

NearKinds NearExtremes::kinds(double tolerance) const {
    // From 0.5 % on a ray that does not graze needs no cuts (transport/near_window.h).
    return {emitter, hasPoints, tolerance < 0.005, opticalHalf <= tolerance};
}

NearPanes::NearPanes(const FlatScene& scene, Emitter emitter, Visibility visibility, float radius)
    : scene_(scene), emitter_(emitter), radius_(radius) {
    if (emitter == Emitter::isotropic && visibility == Visibility::full) {
        walls_ = std::make_unique<Walls>(scene);
    }
}

NearPanes::~NearPanes() = default;

NearPane NearPanes::pane(std::size_t window) const {
    NearPane pane = nearPane(scene_.windows[window], emitter_);
    if (walls_ && !isSphere(pane)) {
        pane.halfV = float(walls_->behind(pane).value_or(double(pane.halfV)));
    }
    return pane;
}

NearExtremes NearPanes::extremes() const {
    NearExtremes found;
    found.emitter = emitter_;
    double longest = 0;
    for (const Window& window : scene_.windows) {
        found.hasPoints |= emitter_ != Emitter::pane || (window.flags & kWindowSphere) != 0;
        longest = std::max(longest, std::hypot(double(glm::length(window.halfU)),
                                               double(glm::length(window.halfV))));
    }
    for (const MediaBox& box : scene_.mediaBoxes) {
        found.opticalHalf = std::max(found.opticalHalf, longest * double(box.extinction));
    }
    return found;
}

NearField NearPanes::build(const NearCells& cells) const {
    constexpr std::uint32_t kBetweenDrops = 1u << 20;  // windows
    NearField field;
    for (std::uint32_t i = 0; i < scene_.windows.size(); ++i) {
        if (i % kBetweenDrops == kBetweenDrops - 1) {
            scene_.dropPages();
        }
        if (cells.reaches(scene_.windows[i].centre)) {
            field.windows.push_back(i);
            field.panes.push_back(pane(i));
        }
    }
    field.tree = buildBoxNodes(field.panes.size(), [&](std::uint32_t i) {
        const NearPane& found = field.panes[i];
        const bool isPane = emitter_ == Emitter::pane && !isSphere(found);
        return reachOf(found, double(radius_), isPane ? 0 : double(found.halfV));
    });
    return field;
}

}  // namespace nightcity
