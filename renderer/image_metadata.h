// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What an image and the statistics say of how they were made.
#pragma once

#include "options.h"
#include "output/image_file.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

// Versions, scene, camera, frame, every setting, and last "settingsHash", the hash of
// all of them: equal hashes mean equal images on the same device. A tile has the hash of
// its frame, and "tile" before it.
ImageMetadata describeImage(const FlatScene& scene, const RenderProduct& product,
                            const RenderSettings& settings, const ImageOptions& image,
                            ImageFormat format, std::optional<Tile> tile = {});

}  // namespace nightcity
