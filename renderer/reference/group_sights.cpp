// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/group_sights.h"

#include <tuple>

#include "reference/airlight.h"

namespace nightcity {

GroupSights::GroupSights(const LightScene& lights, const Ray& ray, const RayPart& whole)
    : lights_(lights), along_(ray), whole_(whole), entries_(lights.groups.size()) {}

const GroupSight* GroupSights::ofWindow(std::uint32_t window) {
    Entry& entry = entries_[lights_.groups.of(window)];
    if (!entry.known) {
        entry.known = true;
        entry.sight = look(lights_.groups[lights_.groups.of(window)]);
    }
    return entry.sight.get();
}

std::unique_ptr<GroupSight> GroupSights::look(const WindowGroup& group) {
    const Emitter emitter = lights_.model.emitter;
    RayPart part = whole_;
    if (emitter != Emitter::isotropic && group.normal != glm::dvec3(0)) {
        const PointSource lowest{group.corner[0], group.normal, Lobe::cosine, 0};
        std::tie(part.begin, part.end) = litPart(along_.ray(), lowest, part.begin, part.end);
    }
    if (part.isEmpty()) {
        return nullptr;
    }
    auto sight = std::make_unique<GroupSight>(lights_.occluders, group, emitter, along_, part,
                                              blockers_);
    return sight->isHidden() ? nullptr : std::move(sight);
}

}  // namespace nightcity
