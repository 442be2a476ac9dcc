// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_builder.h"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>

#include <nlohmann/json.hpp>

#include "scene/content_hash.h"
#include "scene/record_layout.h"
#include "scene/scene_file.h"
#include "temporary_folder.h"

namespace nightcity {

namespace {

class BinaryWriter {
public:
    template <typename Record>
    void add(SceneArray name, const std::vector<Record>& records) {
        const RecordLayout& layout = recordLayouts()[std::size_t(name)];
        nlohmann::json fields = nlohmann::json::array();
        for (const FieldLayout& field : layout.fields) {
            fields.push_back({field.name, field.type, field.components, field.offset});
        }
        bytes.resize((bytes.size() + 63) / 64 * 64);
        arrays[std::string(layout.name)] = {{"offset", bytes.size()},
                                            {"count", records.size()},
                                            {"stride", layout.stride},
                                            {"fields", fields}};
        const auto* first = reinterpret_cast<const std::uint8_t*>(records.data());
        bytes.insert(bytes.end(), first, first + records.size() * sizeof(Record));
    }

    std::vector<std::uint8_t> bytes;
    nlohmann::json arrays = nlohmann::json::object();
};

void writeBytes(const std::filesystem::path& file, const void* data, std::size_t size) {
    std::ofstream out(file, std::ios::binary);
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out.write(static_cast<const char*>(data), std::streamsize(size));
}

}  // namespace

uint SceneBuilder::addMaterial(vec3 reflectance) {
    materials.push_back({reflectance, kNone, 0, 0});
    return uint(materials.size() - 1);
}

void SceneBuilder::addBoxBuilding(vec3 lo, vec3 hi, uint material) {
    // Corner c has x from bit 0, y from bit 1, z from bit 2.
    constexpr std::array<std::array<uint, 4>, 6> kFaces{{
        {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    const uint base = uint(positions.size());
    for (uint c = 0; c < 8; ++c) {
        positions.emplace_back(c & 1 ? hi.x : lo.x, c & 2 ? hi.y : lo.y, c & 4 ? hi.z : lo.z);
    }
    buildings.push_back({uint(triangles.size()), 12, uint(windows.size()), 0,
                         int(buildings.size())});
    for (const auto& f : kFaces) {
        triangles.push_back({uvec3(base + f[0], base + f[1], base + f[2]), material});
        triangles.push_back({uvec3(base + f[0], base + f[2], base + f[3]), material});
    }
}

void SceneBuilder::addWindow(vec3 centre, vec3 halfU, vec3 halfV, float power, vec3 colour,
                             bool ofBuilding) {
    const uint building = ofBuilding ? uint(buildings.size() - 1) : kNone;
    if (ofBuilding) {
        ++buildings.back().windowCount;
    }
    windows.push_back({centre, power, halfU, building, halfV, uint(windows.size()), colour,
                       kWindowOn});
}

void SceneBuilder::addMediaBox(vec3 lo, vec3 hi, float extinction, float albedo,
                               const std::vector<uint>& lights) {
    mediaBoxes.push_back({lo, extinction, hi, albedo, int(mediaBoxes.size()),
                          uint(lightList.size()), uint(lights.size()), 0});
    lightList.insert(lightList.end(), lights.begin(), lights.end());
}

CameraFrame lookAt(vec3 position, vec3 target, double fovDegrees) {
    const glm::dvec3 forward = glm::normalize(glm::dvec3(target) - glm::dvec3(position));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    CameraFrame camera{};
    camera.position = position;
    camera.tanHalfFov = float(std::tan(fovDegrees * std::numbers::pi / 360));
    camera.right = vec3(right);
    camera.up = vec3(glm::cross(right, forward));
    camera.forward = vec3(forward);
    camera.aspect = 1920.0f / 1061.0f;
    return camera;
}

void SceneBuilder::addCamera(const std::string& name, vec3 position, vec3 target,
                             double fovDegrees) {
    cameras.push_back({name, 1, {lookAt(position, target, fovDegrees)}});
}

void SceneBuilder::write(const std::filesystem::path& folder) const {
    BinaryWriter binary;
    binary.add(SceneArray::position, positions);
    binary.add(SceneArray::texcoord, texcoords);
    binary.add(SceneArray::triangle, triangles);
    binary.add(SceneArray::building, buildings);
    binary.add(SceneArray::material, materials);
    binary.add(SceneArray::texel, texels);
    binary.add(SceneArray::window, windows);
    binary.add(SceneArray::mediaBox, mediaBoxes);
    binary.add(SceneArray::lightList, lightList);
    binary.add(SceneArray::windowEvent, windowEvents);
    std::vector<CameraFrame> frames;
    nlohmann::json cameraEntries = nlohmann::json::array();
    for (const Camera& camera : cameras) {
        cameraEntries.push_back({{"name", camera.name},
                                 {"prim", "/City/Cameras/" + camera.name},
                                 {"first_frame", camera.firstFrame},
                                 {"first", frames.size()},
                                 {"count", camera.frames.size()}});
        frames.insert(frames.end(), camera.frames.begin(), camera.frames.end());
    }
    binary.add(SceneArray::cameraFrame, frames);
    if (editBinary) {
        editBinary(binary.bytes);
    }
    nlohmann::json manifest = {
        {"format", "nightcity-scene"}, {"version", 1}, {"byte_order", "little"},
        {"generator", "scene builder of the tests"}, {"up_axis", "z"}, {"origin", {0.0, 0.0, 0.0}},
        {"units", {{"length", "m"}, {"power", "W"}, {"extinction", "1/m"},
                   {"radiance", "W m^-2 sr^-1"}}},
        {"binary", {{"file", "scene.bin"}, {"bytes", binary.bytes.size()},
                    {"hash", contentHash(std::as_bytes(std::span(binary.bytes)))}}},
        {"arrays", binary.arrays}, {"cameras", cameraEntries}, {"ground", nullptr},
        {"frames", {{"first", 1}, {"last", 1}, {"per_second", 24.0}}},
        {"render", {{"camera", nullptr}, {"width", 0}, {"height", 0},
                    {"aovs", nlohmann::json::array()}}},
        {"notes", nlohmann::json::array()}};
    if (ground) {
        manifest["ground"] = {{"height", ground->height}, {"material", ground->material}};
    }
    if (editManifest) {
        editManifest(manifest);
    }
    const std::string text = manifest.dump(1);
    writeBytes(folder / "scene.json", text.data(), text.size());
    writeBytes(folder / "scene.bin", binary.bytes.data(), binary.bytes.size());
}

FlatScene SceneBuilder::load() const {
    const TemporaryFolder folder;  // the mapping outlives the names
    write(folder.path());
    return loadScene(folder.path());
}

}  // namespace nightcity
