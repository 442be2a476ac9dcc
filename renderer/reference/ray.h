// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "scene.h"

namespace nightcity {

struct Ray {
    glm::dvec3 origin;     // m
    glm::dvec3 direction;  // unit vector: t is metres

    glm::dvec3 at(double t) const { return origin + t * direction; }
};

// A part of a ray, m along it.
struct RayPart {
    double begin = 0;
    double end = 0;

    bool isEmpty() const { return !(begin < end); }
};

// Through an image position in pixels from the top left of a width x height frame
// (docs/scene_format.md, camera_frame). `offset` (m) is added to the position.
Ray cameraRay(const CameraFrame& camera, glm::vec3 offset, glm::dvec2 image, glm::dvec2 size);

}  // namespace nightcity
