// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/band_buffers.h"

#include <cstring>

#include "aovs.h"
#include "passes/gpu_scene.h"

namespace nightcity {
namespace {

template <typename T>
void copyImage(std::vector<T>& target, std::uint64_t first, std::uint32_t skipped,
               std::uint32_t count, const void* images, std::uint64_t offset) {
    const char* source = static_cast<const char*>(images) + offset + skipped * sizeof(T);
    std::memcpy(target.data() + first, source, count * sizeof(T));
}

}  // namespace

BandBuffers::ImageOffsets BandBuffers::imageOffsets(std::uint64_t rays, Method method) {
    ImageOffsets at{};
    at.glow = at.beauty + rays * sizeof(vec4);
    at.surface = at.glow + rays * sizeof(vec3);
    at.transmittance = at.surface + rays * sizeof(vec3);
    at.depth = at.transmittance + rays * sizeof(float);
    at.normal = at.depth + rays * sizeof(float);
    at.mediaId = at.normal + rays * sizeof(vec3);
    at.materialId = at.mediaId + rays * sizeof(float);
    at.glowError = at.materialId + rays * sizeof(float);
    at.error = at.glowError + (method == Method::path ? rays * sizeof(vec3) : 0);
    const std::uint64_t ledger = method == Method::field ? rays * sizeof(float) : 0;
    at.cost = at.error + ledger;
    at.end = at.cost + ledger;
    return at;
}

BandBuffers::BandBuffers(gpu::Device& device, std::uint32_t rays, Method method)
    : device_(device), rays_(rays), method_(method) {
    using gpu::MemoryKind;
    const std::uint64_t count = rays;
    surfaces_ = {device, "surface records", count * sizeof(SurfaceRecord), MemoryKind::device};
    progress_ = {device, "ray progress", count * sizeof(RayProgress), MemoryKind::device};
    if (method == Method::path) {
        pathSums_ = {device, "path sums", count * sizeof(PathSums), MemoryKind::device};
        nearLights_ = {device, "near lights", count * sizeof(NearLights), MemoryKind::device};
        glowSquares_ = {device, "squares of glow", count * sizeof(vec3), MemoryKind::device};
    } else if (method != Method::field) {
        segments_ = {device, "segments", count * kSegmentSlots * sizeof(Segment),
                     MemoryKind::device};
    }
    table_ = {device, "frame table", sizeof(FrameTable), MemoryKind::device};
    images_ = {device, "images", imageOffsets(count, method).end};
    counters_ = {device, "pass counters", sizeof(PassCounters)};
}

void BandBuffers::prepare(gpu::Commands& commands, FrameTable table,
                          const std::vector<uvec2>& pixels, const std::vector<vec2>& samples) {
    table.pixels = uvec2(0);
    if (!pixels.empty()) {
        pixels_ = {};
        pixels_ = {device_, "pixel list", pixels.size() * sizeof(uvec2), gpu::MemoryKind::device};
        commands.upload(pixels_, pixels.data(), pixels.size() * sizeof(uvec2));
        table.pixels = addressWords(pixels_.address());
    }
    samples_ = {};
    samples_ = {device_, "sample positions", samples.size() * sizeof(vec2),
                gpu::MemoryKind::device};
    commands.upload(samples_, samples.data(), samples.size() * sizeof(vec2));
    table.samples = addressWords(samples_.address());
    table.surfaces = addressWords(surfaces_.address());
    table.progress = addressWords(progress_.address());
    if (method_ == Method::path) {
        table.pathSums = addressWords(pathSums_.address());
        table.nearLights = addressWords(nearLights_.address());
        table.glowSquares = addressWords(glowSquares_.address());
    } else if (method_ != Method::field) {
        table.segments = addressWords(segments_.address());
    }
    table.counters = addressWords(counters_.buffer().address());

    const ImageOffsets at = imageOffsets(rays_, method_);
    const VkDeviceAddress images = images_.buffer().address();
    table.beauty = addressWords(images + at.beauty);
    table.glow = addressWords(images + at.glow);
    table.surface = addressWords(images + at.surface);
    table.transmittance = addressWords(images + at.transmittance);
    table.depth = addressWords(images + at.depth);
    table.normal = addressWords(images + at.normal);
    table.mediaId = addressWords(images + at.mediaId);
    table.materialId = addressWords(images + at.materialId);
    table.glowError = addressWords(images + at.glowError);
    table.error = addressWords(images + at.error);
    table.cost = addressWords(images + at.cost);
    table.bandRays = rays_;
    commands.upload(table_, &table, sizeof(FrameTable));
}

void BandBuffers::copyTo(Frame& frame, std::uint64_t first, std::uint32_t skipped,
                         std::uint32_t count, std::uint32_t aovs) const {
    const ImageOffsets at = imageOffsets(rays_, method_);
    const auto copy = [&](std::uint32_t aov, auto& target, std::uint64_t offset) {
        if ((aovs & aov) != 0) {
            copyImage(target, first, skipped, count, images_.data(), offset);
        }
    };
    copy(kAovBeauty, frame.beauty, at.beauty);
    copy(kAovGlow, frame.glow, at.glow);
    copy(kAovSurface, frame.surface, at.surface);
    copy(kAovTransmittance, frame.transmittance, at.transmittance);
    copy(kAovDepth, frame.depth, at.depth);
    copy(kAovNormal, frame.normal, at.normal);
    copy(kAovMediaId, frame.mediaId, at.mediaId);
    copy(kAovMaterialId, frame.materialId, at.materialId);
    if (method_ == Method::path) {
        copy(kAovGlowError, frame.glowError, at.glowError);
    }
    if (method_ == Method::field) {
        copy(kAovError, frame.error, at.error);
        copy(kAovCost, frame.cost, at.cost);
    }
}

}  // namespace nightcity
