// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/lit_lists.h"

namespace nightcity {

std::vector<std::vector<std::uint32_t>> litLists(const FlatScene& scene, int frame,
                                                 std::optional<std::uint32_t> cap) {
    const std::vector<std::uint8_t> on = scene.windowsOn(frame);
    std::vector<std::vector<std::uint32_t>> lit(scene.mediaBoxes.size());
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const MediaBox& box = scene.mediaBoxes[i];
        for (const std::uint32_t window :
             scene.lightList.subspan(box.firstLight, box.lightCount)) {
            if (on[window] && (!cap || lit[i].size() < *cap)) {
                lit[i].push_back(window);
            }
        }
    }
    return lit;
}

}  // namespace nightcity
