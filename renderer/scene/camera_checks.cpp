// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/checks.h"
#include "scene/number_checks.h"

namespace nightcity {

namespace {

// How far float32 axes may be from unit length and right angles.
constexpr float kAxisTolerance = 1e-4f;

void checkCamera(const CameraFrame& camera, std::size_t i, const std::filesystem::path& file) {
    if (!finite(camera.position)) {
        failScene(file, fieldName("camera_frame", i, "position"), text(camera.position),
                  "must be finite");
    }
    const auto positive = [&](float value, const char* field) {
        if (!(value > 0) || !std::isfinite(value)) {
            failScene(file, fieldName("camera_frame", i, field), text(value),
                      "must be finite and above 0; mend the camera's aperture or focal length");
        }
    };
    positive(camera.tanHalfFov, "tan_half_fov");
    positive(camera.aspect, "aspect");
    const auto isFinite = [&](float value, const char* field) {
        if (!std::isfinite(value)) {
            failScene(file, fieldName("camera_frame", i, field), text(value), "must be finite");
        }
    };
    isFinite(camera.shiftX, "shift_x");
    isFinite(camera.shiftY, "shift_y");
    const auto unit = [&](vec3 axis, const char* field) {
        if (!(std::abs(glm::length(axis) - 1) <= kAxisTolerance)) {  // false for NaN
            failScene(file, fieldName("camera_frame", i, field), text(axis),
                      "must be a unit vector; mend the camera's transform");
        }
    };
    unit(camera.right, "right");
    unit(camera.up, "up");
    unit(camera.forward, "forward");
    const vec3 backward = glm::cross(camera.right, camera.up);
    if (!(glm::length(backward + camera.forward) <= kAxisTolerance)) {
        failScene(file, fieldName("camera_frame", i, "forward"), text(camera.forward),
                  "right x up must be -forward; mend the shear or mirror in the camera's transform");
    }
}

}  // namespace

void checkCameras(std::span<const CameraFrame> frames, const std::filesystem::path& file) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
        checkCamera(frames[i], i, file);
    }
}

}  // namespace nightcity
