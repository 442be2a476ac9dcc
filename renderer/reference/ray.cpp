// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/ray.h"

namespace nightcity {

Ray cameraRay(const CameraFrame& camera, glm::vec3 offset, glm::dvec2 image, glm::dvec2 size) {
    const double tangent = camera.tanHalfFov;
    const double right = tangent * (2 * image.x - size.x) / size.y + tangent * camera.shiftX;
    const double up = tangent * (size.y - 2 * image.y) / size.y + tangent * camera.shiftY;
    return {glm::dvec3(camera.position) + glm::dvec3(offset),
            glm::normalize(glm::dvec3(camera.forward) + right * glm::dvec3(camera.right) +
                           up * glm::dvec3(camera.up))};
}

}  // namespace nightcity
