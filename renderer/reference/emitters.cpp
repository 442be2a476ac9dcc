// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/emitters.h"

namespace nightcity {

PointSource LitWindow::pointSource(glm::dvec3 place, Emitter emitter) const {
    if (sphere) {
        return {place, glm::dvec3(0), Lobe::isotropic, reach};
    }
    return {place, normal, emitter == Emitter::isotropic ? Lobe::isotropic : Lobe::cosine, 0};
}

std::vector<LitWindow> litWindows(const FlatScene& scene, int frame) {
    const std::vector<std::uint8_t> on = scene.windowsOn(frame);
    std::vector<LitWindow> lit;
    for (std::uint32_t i = 0; i < scene.windows.size(); ++i) {
        const Window& window = scene.windows[i];
        LitWindow emitter{};
        emitter.window = i;
        emitter.centre = glm::dvec3(window.centre);
        emitter.halfU = glm::dvec3(window.halfU);
        emitter.halfV = glm::dvec3(window.halfV);
        emitter.power = double(window.power) * glm::dvec3(window.colour);
        emitter.sphere = (window.flags & kWindowSphere) != 0;
        if (!on[i] || !(emitter.meanPower() > 0)) {
            continue;
        }
        if (emitter.sphere) {
            emitter.reach = glm::length(emitter.halfU);
        } else {
            emitter.normal = glm::normalize(glm::cross(emitter.halfU, emitter.halfV));
            emitter.reach = std::max(glm::length(emitter.halfU + emitter.halfV),
                                     glm::length(emitter.halfU - emitter.halfV));
        }
        lit.push_back(emitter);
    }
    return lit;
}

}  // namespace nightcity
