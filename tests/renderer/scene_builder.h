// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Flat scenes for tests: fill the arrays, then write a valid folder or load it.
// Every member is public, so that a test can spoil any field before it writes.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scene/flat_scene.h"

namespace nightcity {

struct SceneBuilder {
    struct Camera {
        std::string name;
        int firstFrame = 1;
        std::vector<CameraFrame> frames;
    };

    std::vector<vec3> positions;
    std::vector<vec2> texcoords;
    std::vector<Triangle> triangles;
    std::vector<Building> buildings;
    std::vector<Material> materials;
    std::vector<std::uint32_t> texels;
    std::vector<Window> windows;
    std::vector<MediaBox> mediaBoxes;
    std::vector<std::uint32_t> lightList;
    std::vector<WindowEvent> windowEvents;
    std::vector<Camera> cameras;
    std::optional<GroundPlane> ground;
    // Last word on the manifest, before it is written.
    std::function<void(nlohmann::json&)> editManifest;
    std::function<void(std::vector<std::uint8_t>&)> editBinary;  // before it is hashed

    uint addMaterial(vec3 reflectance);
    // Twelve triangles facing outward; opens a new building.
    void addBoxBuilding(vec3 lo, vec3 hi, uint material);
    // A pane of the last building, or of none.
    void addWindow(vec3 centre, vec3 halfU, vec3 halfV, float power = 50, vec3 colour = vec3(1),
                   bool ofBuilding = true);
    // `lights` are indices of windows, ascending.
    void addMediaBox(vec3 lo, vec3 hi, float extinction, float albedo,
                     const std::vector<uint>& lights = {});
    // Vertical field of view in degrees; up is z.
    void addCamera(const std::string& name, vec3 position, vec3 target, double fovDegrees);

    void write(const std::filesystem::path& folder) const;
    FlatScene load() const;  // through a temporary folder
};

// The paper's n x n city of small buildings (design section 3) with its light
// lists, ground and the cameras overview75 (placed for 4 x 4), street and far25.
SceneBuilder paperCity(uint n, float extinction = 0.01f, float albedo = 0.9f);

// A camera record; vertical field of view in degrees, up is z.
CameraFrame lookAt(vec3 position, vec3 target, double fovDegrees);

}  // namespace nightcity
