// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/checks.h"
#include "scene/number_checks.h"

namespace nightcity {

namespace {

void checkMaterial(const FlatScene& scene, std::size_t i, const std::filesystem::path& file) {
    const Material& material = scene.materials[i];
    for (int axis = 0; axis < 3; ++axis) {
        if (!unitInterval(material.reflectance[axis])) {
            failScene(file, fieldName("material", i, "reflectance", axis),
                      text(material.reflectance[axis]), "must lie from 0 to 1");
        }
    }
    const bool textured = material.firstTexel != kNone;
    if (textured != (material.width > 0) || textured != (material.height > 0)) {
        failScene(file, fieldName("material", i, "width"),
                  std::to_string(material.width) + " x " + std::to_string(material.height) +
                      " texels from " + std::to_string(material.firstTexel),
                  "a texture has a first texel, a width and a height, or none of them");
    }
    const std::uint64_t texels = std::uint64_t{material.width} * material.height;
    if (textured && (material.firstTexel > scene.texels.size() ||
                     texels > scene.texels.size() - material.firstTexel)) {
        failScene(file, fieldName("material", i, "first_texel"),
                  std::to_string(material.firstTexel),
                  "the texture ends past the " + std::to_string(scene.texels.size()) + " texels");
    }
}

void checkTriangles(const FlatScene& scene, const std::filesystem::path& file) {
    const std::size_t positions = scene.positions.size();
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& triangle = scene.triangles[i];
        for (int corner = 0; corner < 3; ++corner) {
            if (triangle.vertex[corner] >= positions) {
                failScene(file, fieldName("triangle", i, "vertex", corner),
                          std::to_string(triangle.vertex[corner]),
                          "must be below the " + std::to_string(positions) + " positions");
            }
        }
        if (triangle.material >= scene.materials.size()) {
            failScene(file, fieldName("triangle", i, "material"), std::to_string(triangle.material),
                      "must be below the " + std::to_string(scene.materials.size()) + " materials");
        }
    }
}

// [first, first + count) within `total`, after what earlier buildings hold.
void checkRange(const std::filesystem::path& file, std::size_t building, const char* field,
                uint first, uint count, std::size_t& used, std::size_t total) {
    if (count == 0) {
        return;
    }
    if (first != used || count > total - used) {
        failScene(file, fieldName("building", building, field),
                  std::to_string(first) + " with " + std::to_string(count) + " records",
                  "must begin at " + std::to_string(used) + ", where the building before ends, " +
                      "and end within " + std::to_string(total));
    }
    used += count;
}

}  // namespace

void checkGeometry(const FlatScene& scene, const std::filesystem::path& file) {
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        if (!finite(scene.positions[i])) {
            failScene(file, fieldName("position", i, ""), text(scene.positions[i]),
                      "must be finite; mend the mesh on the stage");
        }
    }
    if (!scene.texcoords.empty() && scene.texcoords.size() != scene.positions.size()) {
        failScene(file, "arrays.texcoord.count", std::to_string(scene.texcoords.size()),
                  "must be 0 or the " + std::to_string(scene.positions.size()) + " positions");
    }
    for (std::size_t i = 0; i < scene.texcoords.size(); ++i) {
        const vec2 uv = scene.texcoords[i];
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
            failScene(file, fieldName("texcoord", i, ""), text(vec3(uv, 0)),
                      "must be finite; mend the mesh on the stage");
        }
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        checkMaterial(scene, i, file);
    }
    checkTriangles(scene, file);
}

void checkBuildings(const FlatScene& scene, const std::filesystem::path& file) {
    std::size_t triangles = 0;
    std::size_t windows = 0;
    for (std::size_t i = 0; i < scene.buildings.size(); ++i) {
        const Building& building = scene.buildings[i];
        checkRange(file, i, "first_triangle", building.firstTriangle, building.triangleCount,
                   triangles, scene.triangles.size());
        const std::size_t first = windows;
        checkRange(file, i, "first_window", building.firstWindow, building.windowCount, windows,
                   scene.windows.size());
        for (std::size_t w = first; w < windows; ++w) {
            if (scene.windows[w].building != i) {
                failScene(file, fieldName("window", w, "building"),
                          std::to_string(scene.windows[w].building),
                          "building[" + std::to_string(i) + "] claims this window; " +
                              kExportAgain);
            }
        }
    }
    for (std::size_t w = windows; w < scene.windows.size(); ++w) {
        if (scene.windows[w].building != kNone) {
            failScene(file, fieldName("window", w, "building"),
                      std::to_string(scene.windows[w].building),
                      std::string("no building claims this window; ") + kExportAgain);
        }
    }
}

}  // namespace nightcity
