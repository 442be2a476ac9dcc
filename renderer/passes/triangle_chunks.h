// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which triangles a camera may see: those of a scene in chunks of neighbours in
// number, each with its bounds. No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dispatch.h"
#include "scene/flat_scene.h"

namespace nightcity {

// Triangles first to first + count, exclusive.
struct TriangleRun {
    std::uint32_t first = 0;
    std::uint32_t count = 0;

    bool operator==(const TriangleRun&) const = default;
};

struct TriangleChunk {
    TriangleRun run;
    vec3 lo;  // m, bounds
    vec3 hi;
};

std::vector<TriangleChunk> chunkTriangles(const FlatScene& scene);

// Rows of a frame, from the top.
struct FrameRows {
    std::uint32_t width = 0;   // pixels, of the frame
    std::uint32_t height = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

// The runs that hold every triangle which a ray of those rows can meet, its sample within
// `margin` pixels of the pixel's centre; ascending, apart.
std::vector<TriangleRun> visibleRuns(std::span<const TriangleChunk> chunks,
                                     const CameraFrame& camera, const FrameRows& rows,
                                     float margin);

}  // namespace nightcity
