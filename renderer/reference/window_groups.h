// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Windows that lie side by side, to find once what may hide them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/emitters.h"

namespace nightcity {

// A box about panes that face the same way; of a sphere, or of the centres alone
// where the windows are points, a box about those.
struct WindowGroup {
    std::array<glm::dvec3, 8> corner;  // HullRegion's order
    glm::dvec3 normal{0};              // unit vector, of panes; else 0
    double lowest = 0, highest = 0;    // of the windows' planes: dot(normal, centre)
};

class WindowGroups {
public:
    WindowGroups() = default;
    // Neighbours in `windows` that lie within a few metres form a group.
    WindowGroups(std::span<const LitWindow> windows, Emitter emitter);

    std::size_t size() const { return groups_.size(); }
    const WindowGroup& operator[](std::size_t group) const { return groups_[group]; }
    std::uint32_t of(std::uint32_t window) const { return groupOf_[window]; }

private:
    std::vector<WindowGroup> groups_;
    std::vector<std::uint32_t> groupOf_;
};

}  // namespace nightcity
