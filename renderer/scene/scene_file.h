// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/flat_scene.h"

namespace nightcity {

// Maps a flat scene (docs/scene_format.md) and checks all of it: what the result
// holds can be trusted. Throws SceneError naming file, field, index and value.
FlatScene loadScene(const std::filesystem::path& folder);

}  // namespace nightcity
