// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/facade_walls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/box_tree.h"
#include "scene/facades.h"
#include "scene/plane_index.h"

namespace nightcity {

namespace {

using Corners = std::array<glm::dvec3, 3>;

Corners corners(const FlatScene& scene, uint triangle) {
    const uvec3 v = scene.triangles[triangle].vertex;
    return {glm::dvec3(scene.positions[v.x]), glm::dvec3(scene.positions[v.y]),
            glm::dvec3(scene.positions[v.z])};
}

glm::dvec3 outward(const Window& window) {
    return glm::normalize(glm::cross(glm::dvec3(window.halfU), glm::dvec3(window.halfV)));
}

bool sameWay(glm::dvec3 a, glm::dvec3 b) {
    return glm::length(a - b) <= PlaneIndex::kNormalTolerance;
}

Bounds boundsOf(const FlatScene& scene, const Building& building) {
    Bounds bounds;
    for (uint i = 0; i < building.windowCount; ++i) {
        bounds.add(glm::dvec3(scene.windows[building.firstWindow + i].centre));
    }
    for (uint i = 0; i < building.triangleCount; ++i) {
        for (const glm::dvec3 corner : corners(scene, building.firstTriangle + i)) {
            bounds.add(corner);
        }
    }
    return bounds;
}

class WallFinder {
public:
    WallFinder(const FlatScene& scene, const Building& building, const Bounds& bounds)
        : scene_(scene),
          building_(building),
          planes_((bounds.lo + bounds.hi) / 2.0, glm::length(bounds.hi - bounds.lo) / 2) {}

    std::vector<FacadeWall> find(std::vector<uint>& loose) {
        for (uint i = 0; i < building_.windowCount; ++i) {
            addWindow(building_.firstWindow + i, loose);
        }
        for (uint i = 0; i < building_.triangleCount; ++i) {
            addTriangle(building_.firstTriangle + i);
        }
        for (FacadeWall& wall : walls_) {
            releaseUncovered(wall, loose);
        }
        std::erase_if(walls_, [](const FacadeWall& wall) { return wall.windows.empty(); });
        return std::move(walls_);
    }

private:
    bool holds(const FacadeWall& wall, glm::dvec3 normal, glm::dvec3 centre) const {
        return sameWay(wall.normal, normal) &&
               std::abs(glm::dot(wall.normal, centre - wall.point)) <= kPaneDistance;
    }

    void addWindow(uint index, std::vector<uint>& loose) {
        const Window& window = scene_.windows[index];
        if ((window.flags & kWindowSphere) != 0) {
            loose.push_back(index);
            return;
        }
        const glm::dvec3 normal = outward(window);
        const glm::dvec3 centre(window.centre);
        // Neighbours come one after the other: mostly it is the wall of the last one.
        std::size_t wall = last_ < walls_.size() && holds(walls_[last_], normal, centre)
                               ? last_
                               : walls_.size();
        if (wall == walls_.size()) {
            planes_.visitNear(normal, centre, [&](std::uint32_t candidate) {
                if (candidate < wall && holds(walls_[candidate], normal, centre)) {
                    wall = candidate;
                }
            });
        }
        if (wall == walls_.size()) {
            const glm::dvec3 uAxis = glm::normalize(glm::dvec3(window.halfU));
            walls_.push_back({centre, uAxis, glm::cross(normal, uAxis), normal, {}, {}});
            planes_.add(std::uint32_t(wall), normal, centre);
        }
        walls_[wall].windows.push_back(index);
        last_ = wall;
    }

    // To the wall with the most windows among those that it is coplanar with.
    void addTriangle(uint index) {
        const Corners c = corners(scene_, index);
        const glm::dvec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
        const double length = glm::length(cross);
        if (!(length > 0)) {
            return;
        }
        FacadeWall* best = nullptr;
        planes_.visitNear(cross / length, c[0], [&](std::uint32_t candidate) {
            FacadeWall& wall = walls_[candidate];
            const auto near = [&](glm::dvec3 corner) {
                return std::abs(glm::dot(wall.normal, corner - wall.point)) <= kWallDistance;
            };
            if (sameWay(wall.normal, cross / length) && std::all_of(c.begin(), c.end(), near) &&
                (best == nullptr || wall.windows.size() > best->windows.size() ||
                 (wall.windows.size() == best->windows.size() && &wall < best))) {
                best = &wall;
            }
        });
        if (best != nullptr) {
            best->triangles.push_back(index);
        }
    }

    // Keeps the windows whose corners and centre all have a triangle behind them.
    void releaseUncovered(FacadeWall& wall, std::vector<uint>& loose) const {
        std::vector<Bounds> boxes;
        for (const uint triangle : wall.triangles) {
            Bounds box;
            for (const glm::dvec3 corner : corners(scene_, triangle)) {
                box.add(corner - kWallDistance);
                box.add(corner + kWallDistance);
            }
            boxes.push_back(box);
        }
        const BoxTree tree(std::move(boxes));
        std::erase_if(wall.windows, [&](uint index) {
            const Window& window = scene_.windows[index];
            constexpr double kInset = 0.999;  // a pane may reach the wall's very edge
            for (const glm::dvec2 s : {glm::dvec2(0, 0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
                const glm::dvec3 point = glm::dvec3(window.centre) +
                                         s.x * kInset * glm::dvec3(window.halfU) +
                                         s.y * kInset * glm::dvec3(window.halfV);
                if (!isCovered(wall, tree, point)) {
                    loose.push_back(index);
                    return true;
                }
            }
            return false;
        });
    }

    bool isCovered(const FacadeWall& wall, const BoxTree& tree, glm::dvec3 point) const {
        bool covered = false;
        tree.visitTouching({point, point}, [&](std::uint32_t i) {
            covered = covered || isBehind(wall, corners(scene_, wall.triangles[i]), point);
        });
        return covered;
    }

    // Whether the triangle covers the point, seen along the wall's normal.
    static bool isBehind(const FacadeWall& wall, const Corners& c, glm::dvec3 point) {
        constexpr double kSlack = -1e-6;  // share of the area: no gap between neighbours
        const double area = glm::dot(wall.normal, glm::cross(c[1] - c[0], c[2] - c[0]));
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 a = c[i], b = c[(i + 1) % 3];
            if (glm::dot(wall.normal, glm::cross(b - a, point - a)) < kSlack * area) {
                return false;
            }
        }
        return true;
    }

    const FlatScene& scene_;
    const Building& building_;
    PlaneIndex planes_;
    std::vector<FacadeWall> walls_;
    std::size_t last_ = 0;  // wall of the window before
};

}  // namespace

std::vector<FacadeWall> findWalls(const FlatScene& scene, const Building& building,
                                  std::vector<uint>& loose) {
    if (building.windowCount == 0) {
        return {};
    }
    return WallFinder(scene, building, boundsOf(scene, building)).find(loose);
}

}  // namespace nightcity
