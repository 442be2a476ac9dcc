// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a frame keeps on the device: records between the passes and images, for
// one band of pixels at a time, so that memory does not grow with the frame.
#pragma once

#include <cstdint>
#include <vector>

#include "dispatch.h"
#include "frame.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/readable_buffer.h"
#include "settings.h"

namespace nightcity {

class BandBuffers {
public:
    // `rays`: pixels of a band, a multiple of kGroupSize.
    BandBuffers(gpu::Device& device, std::uint32_t rays, Method method);

    std::uint32_t rays() const { return rays_; }
    Method method() const { return method_; }
    VkDeviceAddress tableAddress() const { return table_.address(); }
    const gpu::ReadableBuffer& images() const { return images_; }
    const gpu::ReadableBuffer& counters() const { return counters_; }

    // Completes the table with the addresses of this band's buffers and uploads it. `pixels`:
    // the pixel list, or empty; `samples`: offsets from the pixel centre.
    void prepare(gpu::Commands& commands, FrameTable table, const std::vector<uvec2>& pixels,
                 const std::vector<vec2>& samples);
    // Copies `count` pixels of the images in `aovs` (aovs.h), from pixel `skipped` of the band on,
    // to the frame, from pixel `first`.
    void copyTo(Frame& frame, std::uint64_t first, std::uint32_t skipped, std::uint32_t count,
                std::uint32_t aovs) const;

private:
    // Byte offset of each image in images_.
    struct ImageOffsets {
        std::uint64_t beauty, glow, surface, transmittance, depth, normal, mediaId, materialId,
            glowError, error, cost, end;
    };
    static ImageOffsets imageOffsets(std::uint64_t rays, Method method);

    gpu::Device& device_;
    std::uint32_t rays_;
    Method method_;
    gpu::Buffer surfaces_;
    gpu::Buffer progress_;
    gpu::Buffer segments_;
    gpu::Buffer pathSums_;
    gpu::Buffer nearLights_;
    gpu::Buffer glowSquares_;
    gpu::Buffer pixels_;
    gpu::Buffer samples_;
    gpu::Buffer table_;
    gpu::ReadableBuffer images_;
    gpu::ReadableBuffer counters_;
};

}  // namespace nightcity
