// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/near_panes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nightcity {
namespace {

constexpr double kMargin = 0.01;  // m: a ray's cell may be off by its rounding

NearPane nearPane(const Window& window) {
    NearPane pane{};
    pane.centre = window.centre;
    pane.halfU = glm::length(window.halfU);
    pane.flags = window.flags;
    if ((window.flags & kWindowSphere) != 0) {
        pane.uAxis = {1, 0, 0};
        pane.vAxis = {0, 1, 0};
        pane.radiance = window.colour * float(window.power / (4 * std::numbers::pi));
        return pane;
    }
    pane.halfV = glm::length(window.halfV);
    pane.uAxis = window.halfU / pane.halfU;
    pane.vAxis = window.halfV / pane.halfV;
    const double area = 4.0 * pane.halfU * pane.halfV;
    pane.radiance = window.colour * float(window.power / (std::numbers::pi * area));
    return pane;
}

// Cells of about half the near radius: few panes in each, and few steps.
NearTable latticeOver(const FarFieldTable& field) {
    NearTable table{};
    table.origin = field.origin;
    table.radius = field.nearRadius;
    const uint split = std::max(1u, uint(std::lround(2 * field.cellSide / field.nearRadius)));
    table.side = field.cellSide / float(split);
    table.counts = field.cellCounts * split;
    return table;
}

// Lattice cells that may hold a point within the near radius of a pane and before it.
class HalfBall {
public:
    HalfBall(const NearPane& pane, const NearTable& lattice)
        : centre_(glm::dvec3(pane.centre) - glm::dvec3(lattice.origin)),
          normal_(glm::cross(pane.uAxis, pane.vAxis)),
          radius_(lattice.radius + kMargin),
          side_(lattice.side),
          isBall_((pane.flags & kWindowSphere) != 0) {
        const glm::dvec3 most = glm::dvec3(lattice.counts) - 1.0;
        first_ = glm::ivec3(glm::max(glm::floor((centre_ - radius_) / side_), glm::dvec3(0)));
        last_ = glm::ivec3(glm::min(glm::floor((centre_ + radius_) / side_), most));
    }

    template <typename Visit>
    void visitCells(Visit&& visit) const {
        for (int z = first_.z; z <= last_.z; ++z) {
            for (int y = first_.y; y <= last_.y; ++y) {
                for (int x = first_.x; x <= last_.x; ++x) {
                    if (touches({x, y, z})) {
                        visit(x, y, z);
                    }
                }
            }
        }
    }

private:
    bool touches(glm::dvec3 cell) const {
        const glm::dvec3 half(0.5 * side_);
        const glm::dvec3 away = cell * side_ + half - centre_;
        const glm::dvec3 gap = glm::max(glm::abs(away) - half, glm::dvec3(0));
        const double ahead = glm::dot(normal_, away) + glm::dot(glm::abs(normal_), half);
        return glm::dot(gap, gap) < radius_ * radius_ && (isBall_ || ahead > -kMargin);
    }

    glm::dvec3 centre_, normal_;
    double radius_, side_;
    bool isBall_;
    glm::ivec3 first_, last_;
};

}  // namespace

NearPanes buildNearPanes(const FlatScene& scene, const FarFieldTable& field) {
    NearPanes near;
    near.panes.reserve(scene.windows.size());
    for (const Window& window : scene.windows) {
        near.panes.push_back(nearPane(window));
    }
    near.table = latticeOver(field);
    const glm::uvec3 counts = near.table.counts;
    near.cellStart.assign(std::size_t{counts.x} * counts.y * counts.z + 1, 0);
    const auto numberOf = [&](int x, int y, int z) {
        return (std::size_t(z) * counts.y + std::size_t(y)) * counts.x + std::size_t(x);
    };
    for (const NearPane& pane : near.panes) {
        HalfBall(pane, near.table).visitCells(
            [&](int x, int y, int z) { ++near.cellStart[numberOf(x, y, z) + 1]; });
    }
    for (std::size_t cell = 1; cell < near.cellStart.size(); ++cell) {
        near.cellStart[cell] += near.cellStart[cell - 1];
    }
    near.cellPanes.resize(near.cellStart.back());
    std::vector<uint> next(near.cellStart.begin(), near.cellStart.end() - 1);
    for (uint index = 0; index < near.panes.size(); ++index) {
        HalfBall(near.panes[index], near.table).visitCells([&](int x, int y, int z) {
            near.cellPanes[next[numberOf(x, y, z)]++] = index;
        });
    }
    return near;
}

}  // namespace nightcity
