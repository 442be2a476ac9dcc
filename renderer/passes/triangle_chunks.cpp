// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/triangle_chunks.h"

#include <algorithm>
#include <array>

namespace nightcity {
namespace {

// A few buildings: small enough to leave out most of a city, large enough that a draw pays.
constexpr std::uint32_t kChunkTriangles = 128;

// Inward normals of the planes through the eye that bound a view, not of unit length.
using View = std::array<glm::dvec3, 5>;

View viewOf(const CameraFrame& camera, const FrameRows& rows, float margin) {
    const glm::dvec3 right(camera.right), up(camera.up), forward(camera.forward);
    const double height = rows.height;
    const double reach = 2.0 * margin + 1;  // of a pixel's rays about its centre, half pixels
    const double side = (rows.width - 1 + reach) / height;
    const double top = (height - 1 - 2.0 * rows.first + reach) / height;
    const double bottom = (height + 1 - 2.0 * (rows.first + rows.count) - reach) / height;
    const double tangent = camera.tanHalfFov;
    return {forward,
            forward * (tangent * (side + camera.shiftX)) - right,
            right + forward * (tangent * (side - camera.shiftX)),
            forward * (tangent * (top + camera.shiftY)) - up,
            up - forward * (tangent * (bottom + camera.shiftY))};
}

// Not when the box lies behind one of the planes as a whole.
bool maySee(const View& view, const glm::dvec3& eye, const TriangleChunk& chunk) {
    const glm::dvec3 centre = (glm::dvec3(chunk.lo) + glm::dvec3(chunk.hi)) / 2.0 - eye;
    const glm::dvec3 half = (glm::dvec3(chunk.hi) - glm::dvec3(chunk.lo)) / 2.0;
    return std::all_of(view.begin(), view.end(), [&](const glm::dvec3& normal) {
        return glm::dot(normal, centre) + glm::dot(glm::abs(normal), half) >= 0;
    });
}

}  // namespace

std::vector<TriangleChunk> chunkTriangles(const FlatScene& scene) {
    const std::uint32_t all = static_cast<std::uint32_t>(scene.triangles.size());
    std::vector<TriangleChunk> chunks;
    for (std::uint32_t first = 0; first < all; first += kChunkTriangles) {
        const vec3 start = scene.positions[scene.triangles[first].vertex.x];
        TriangleChunk chunk{{first, std::min(kChunkTriangles, all - first)}, start, start};
        for (std::uint32_t i = first; i < first + chunk.run.count; ++i) {
            for (int corner = 0; corner < 3; ++corner) {
                const vec3 position = scene.positions[scene.triangles[i].vertex[corner]];
                chunk.lo = glm::min(chunk.lo, position);
                chunk.hi = glm::max(chunk.hi, position);
            }
        }
        chunks.push_back(chunk);
    }
    return chunks;
}

std::vector<TriangleRun> visibleRuns(std::span<const TriangleChunk> chunks,
                                     const CameraFrame& camera, const FrameRows& rows,
                                     float margin) {
    const View view = viewOf(camera, rows, margin);
    const glm::dvec3 eye(camera.position);
    std::vector<TriangleRun> runs;
    for (const TriangleChunk& chunk : chunks) {
        if (!maySee(view, eye, chunk)) {
            continue;
        }
        if (!runs.empty() && runs.back().first + runs.back().count == chunk.run.first) {
            runs.back().count += chunk.run.count;
        } else {
            runs.push_back(chunk.run);
        }
    }
    return runs;
}

}  // namespace nightcity
