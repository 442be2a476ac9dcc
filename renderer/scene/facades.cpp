// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/facades.h"

#include <algorithm>
#include <cmath>

#include "scene/facade_walls.h"

namespace nightcity {

namespace {

// A rectangle in the plane of a wall, m along its axes from its point.
struct Extent {
    glm::dvec2 lo, hi;
};

Extent extentOf(const Window& window, const FacadeWall& wall) {
    const auto along = [&](glm::dvec3 v) {
        return glm::dvec2(glm::dot(v, wall.uAxis), glm::dot(v, wall.vAxis));
    };
    const glm::dvec2 centre = along(glm::dvec3(window.centre) - wall.point);
    const glm::dvec2 half = glm::abs(along(glm::dvec3(window.halfU))) +
                            glm::abs(along(glm::dvec3(window.halfV))) + kPaneMargin;
    return {centre - half, centre + half};
}

struct Grid {
    glm::dvec2 lo, cell;
    uint columns, rows;

    uint column(double u) const { return clampedCell((u - lo.x) / cell.x, columns); }
    uint row(double v) const { return clampedCell((v - lo.y) / cell.y, rows); }

private:
    static uint clampedCell(double place, uint count) {
        return uint(std::clamp(std::floor(place), 0.0, double(count - 1)));
    }
};

// Cells about the size of a mean window, at most about four a window.
Grid makeGrid(const std::vector<Extent>& extents) {
    Extent all = extents.front();
    glm::dvec2 mean(0);
    for (const Extent& e : extents) {
        all = {glm::min(all.lo, e.lo), glm::max(all.hi, e.hi)};
        mean += (e.hi - e.lo) / double(extents.size());
    }
    const glm::dvec2 size = all.hi - all.lo;
    const double cells = std::ceil(size.x / mean.x) * std::ceil(size.y / mean.y);
    const double most = 4.0 * double(extents.size()) + 16;
    const glm::dvec2 wanted = mean * std::max(1.0, std::sqrt(cells / most));
    const glm::dvec2 counts = glm::min(glm::ceil(size / wanted), glm::dvec2(most));
    return {all.lo, size / counts, uint(counts.x), uint(counts.y)};
}

void addFacade(FacadeTable& table, const FlatScene& scene, const FacadeWall& wall) {
    std::vector<Extent> extents;
    for (const uint window : wall.windows) {
        extents.push_back(extentOf(scene.windows[window], wall));
    }
    const Grid grid = makeGrid(extents);
    const auto forEachCell = [&](auto&& visit) {
        for (std::size_t i = 0; i < extents.size(); ++i) {
            const uint lastRow = grid.row(extents[i].hi.y);
            const uint lastColumn = grid.column(extents[i].hi.x);
            for (uint row = grid.row(extents[i].lo.y); row <= lastRow; ++row) {
                for (uint column = grid.column(extents[i].lo.x); column <= lastColumn; ++column) {
                    visit(row * grid.columns + column, wall.windows[i]);
                }
            }
        }
    };
    const std::size_t cells = std::size_t{grid.columns} * grid.rows;
    const std::size_t firstCell = table.cellStart.size();
    table.cellStart.resize(firstCell + cells + 1, 0);
    uint* start = table.cellStart.data() + firstCell;
    forEachCell([&](uint cell, uint) { ++start[cell + 1]; });
    start[0] = uint(table.cellWindow.size());
    for (std::size_t c = 0; c < cells; ++c) {
        start[c + 1] += start[c];
    }
    table.cellWindow.resize(start[cells]);
    std::vector<uint> next(start, start + cells);
    forEachCell([&](uint cell, uint window) { table.cellWindow[next[cell]++] = window; });

    for (const uint triangle : wall.triangles) {
        table.triangleFacade[triangle] = uint(table.facades.size());
    }
    const glm::dvec3 origin = wall.point + grid.lo.x * wall.uAxis + grid.lo.y * wall.vAxis;
    table.facades.push_back({vec3(origin), uint(firstCell), vec3(wall.uAxis), grid.columns,
                             vec3(wall.vAxis), grid.rows, vec2(grid.cell)});
}

}  // namespace

FacadeTable buildFacades(const FlatScene& scene) {
    FacadeTable table;
    table.triangleFacade.assign(scene.triangles.size(), kNone);
    std::size_t windows = 0;
    for (const Building& building : scene.buildings) {
        for (const FacadeWall& wall : findWalls(scene, building, table.looseWindows)) {
            addFacade(table, scene, wall);
        }
        windows += building.windowCount;
    }
    for (; windows < scene.windows.size(); ++windows) {  // of no building
        table.looseWindows.push_back(uint(windows));
    }
    std::sort(table.looseWindows.begin(), table.looseWindows.end());
    return table;
}

}  // namespace nightcity
