// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What must hold of the records of a flat scene (docs/scene_format.md). Each
// throws SceneError, naming `file`, the array, the index, the field and the value.
#pragma once

#include <filesystem>

#include "scene/flat_scene.h"

namespace nightcity {

// Positions, texture coordinates, triangles, materials.
void checkGeometry(const FlatScene& scene, const std::filesystem::path& file);
// Buildings: ranges that follow each other, the rest of no building last.
void checkBuildings(const FlatScene& scene, const std::filesystem::path& file);
// Windows and their events.
void checkWindows(const FlatScene& scene, const std::filesystem::path& file);
// Media boxes, their light lists, and that no two boxes overlap.
void checkMedia(const FlatScene& scene, const std::filesystem::path& file);
void checkCameras(std::span<const CameraFrame> frames, const std::filesystem::path& file);

}  // namespace nightcity
