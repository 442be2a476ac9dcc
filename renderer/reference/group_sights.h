// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The sights from one ray to every group of windows, each found when it is asked for.
#pragma once

#include <memory>
#include <vector>

#include "reference/group_sight.h"
#include "reference/light_scene.h"

namespace nightcity {

class GroupSights {
public:
    // `lights` must outlive it. `whole` holds every part that will be asked about.
    GroupSights(const LightScene& lights, const Ray& ray, const RayPart& whole);

    // Of the group of a window, in the window's own half space where it shines to the
    // front only; null where all of it is hidden or behind.
    const GroupSight* ofWindow(std::uint32_t window);

private:
    struct Entry {
        bool known = false;
        std::unique_ptr<GroupSight> sight;
    };

    std::unique_ptr<GroupSight> look(const WindowGroup& group);

    const LightScene& lights_;
    AlongRay along_;
    RayPart whole_;
    std::vector<Entry> entries_;          // of each group
    std::vector<std::uint32_t> blockers_;  // GroupSight
};

}  // namespace nightcity
