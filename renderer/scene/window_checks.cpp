// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/checks.h"
#include "scene/number_checks.h"

namespace nightcity {

namespace {

// Cosine of the angle between the edges of a pane: float32 edges of a rectangle
// stay below 1e-6, a shear that would change the picture is above this.
constexpr float kLargestSkew = 1e-3f;

bool isRectangle(vec3 u, vec3 v) {
    const float lengths = glm::length(u) * glm::length(v);
    return lengths > 0 && std::isfinite(lengths) && std::abs(glm::dot(u, v)) <= kLargestSkew * lengths;
}

void checkShape(const Window& window, std::size_t i, const std::filesystem::path& file) {
    if (!finite(window.centre)) {
        failScene(file, fieldName("window", i, "centre"), text(window.centre), "must be finite");
    }
    if ((window.flags & ~(kWindowOn | kWindowSphere)) != 0) {
        failScene(file, fieldName("window", i, "flags"), std::to_string(window.flags),
                  "only bits 0 and 1 have a meaning; export the stage with this version");
    }
    if ((window.flags & kWindowSphere) != 0) {
        const float radius = glm::length(window.halfU);
        if (!(radius > 0) || !std::isfinite(radius)) {
            failScene(file, fieldName("window", i, "half_u"), text(window.halfU),
                      "the radius of a sphere must be finite and above 0 m");
        }
        return;
    }
    if (!isRectangle(window.halfU, window.halfV)) {
        failScene(file, fieldName("window", i, "half_u"),
                  text(window.halfU) + " beside half_v " + text(window.halfV),
                  "half edges must be finite, longer than 0 m and at right angles; mend the "
                  "window's size or the shear of its transform");
    }
}

void checkEvents(const FlatScene& scene, const std::filesystem::path& file) {
    for (std::size_t i = 0; i < scene.windowEvents.size(); ++i) {
        const WindowEvent& event = scene.windowEvents[i];
        if (!std::isfinite(event.frame)) {
            failScene(file, fieldName("window_event", i, "frame"), text(event.frame),
                      "must be finite");
        }
        if (event.window >= scene.windows.size()) {
            failScene(file, fieldName("window_event", i, "window"), std::to_string(event.window),
                      "must be below the " + std::to_string(scene.windows.size()) + " windows");
        }
        if (event.on > 1) {
            failScene(file, fieldName("window_event", i, "on"), std::to_string(event.on),
                      "must be 0 or 1");
        }
        if (i == 0) {
            continue;
        }
        const WindowEvent& before = scene.windowEvents[i - 1];
        if (event.frame < before.frame ||
            (event.frame == before.frame && event.window <= before.window)) {
            failScene(file, fieldName("window_event", i, "frame"), text(event.frame),
                      std::string("events must rise by frame, then window; ") + kExportAgain);
        }
    }
}

}  // namespace

void checkWindows(const FlatScene& scene, const std::filesystem::path& file) {
    std::vector<uint> ids(scene.windows.size());
    for (std::size_t i = 0; i < scene.windows.size(); ++i) {
        const Window& window = scene.windows[i];
        ids[i] = window.windowId;
        if (!notNegative(window.power)) {
            failScene(file, fieldName("window", i, "power"), text(window.power),
                      "must be finite and not negative, in watts");
        }
        if (!notNegative(window.colour) || !finite(window.power * window.colour)) {
            failScene(file, fieldName("window", i, "colour"), text(window.colour),
                      "must be finite and not negative, also times the power");
        }
        checkShape(window, i, file);
    }
    const std::size_t twice = findDuplicate(ids);
    if (twice < ids.size()) {
        failScene(file, fieldName("window", twice, "window_id"), std::to_string(ids[twice]),
                  "another window has this id; give each its own on the stage");
    }
    checkEvents(scene, file);
}

}  // namespace nightcity
