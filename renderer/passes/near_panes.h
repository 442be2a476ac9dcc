// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The windows whose near parts rays integrate, and a tree over the places that these reach
// (shaders/shared/glow.h). Does not depend on which windows are on. No Vulkan.
#pragma once

#include <memory>
#include <vector>

#include "dispatch.h"
#include "glow.h"
#include "passes/near_cells.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

// What their integrals need not look at, for a tolerance.
struct NearKinds {
    Emitter emitter = Emitter::pane;
    bool points = false;    // some windows are points or spheres of light
    bool cutAll = true;     // all rays are cut at the edges of panes close by, not only grazing ones
    bool thinHaze = false;  // a pane's light is attenuated as from its centre

    bool operator==(const NearKinds&) const = default;
};

// What of all of them decides their kinds.
struct NearExtremes {
    Emitter emitter = Emitter::pane;
    bool hasPoints = false;
    double opticalHalf = 0;  // half the longest diagonal in the densest haze

    // tolerance: relative, of the glow.
    NearKinds kinds(double tolerance) const;
};

// Those that reach the cells.
struct NearField {
    std::vector<NearPane> panes;
    std::vector<uint> windows;  // of each pane
    std::vector<BoxNode> tree;  // over what each lights of its ball of the radius
};

class NearPanes {
public:
    // `radius`: m, the near radius. With full visibility an isotropic window on a wall lights
    // nothing behind it; other walls within the radius hide nothing. The scene must outlive this.
    NearPanes(const FlatScene& scene, Emitter emitter, Visibility visibility, float radius);
    NearPanes(NearPanes&&) = delete;
    ~NearPanes();

    NearExtremes extremes() const;
    NearField build(const NearCells& cells) const;

private:
    class Walls;

    NearPane pane(std::size_t window) const;

    const FlatScene& scene_;
    Emitter emitter_;
    float radius_;
    std::unique_ptr<const Walls> walls_;  // where they are asked for
};

}  // namespace nightcity
