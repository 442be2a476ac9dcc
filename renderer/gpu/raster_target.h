// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a RasterPipeline draws into: numbers and depths of a whole frame, and the
// buffer in which shaders find the numbers.
#pragma once

#include <cstdint>
#include <functional>

#include "gpu/buffer.h"
#include "gpu/handle.h"
#include "gpu/image.h"
#include "gpu/raster_pipeline.h"

namespace nightcity::gpu {

class RasterTarget {
public:
    RasterTarget() = default;
    RasterTarget(Device& device, const RasterPipeline& pipeline, VkExtent2D extent);

    VkExtent2D extent() const { return extent_; }
    // uint, one a pixel of the frame, row by row.
    VkDeviceAddress numbers() const { return numbers_.address(); }
    // Draws what `draw` records into whole rows of the frame and copies them to the buffer;
    // where nothing is drawn stands `clear`. The viewport is the frame's, whatever the rows, so
    // that every row comes out the same alone. A compute barrier must follow.
    void record(VkCommandBuffer commands, const RasterPipeline& pipeline, uint32_t firstRow,
                uint32_t rows, uint32_t clear, const std::function<void()>& draw) const;

private:
    void recordCopy(VkCommandBuffer commands, uint32_t firstRow, uint32_t rows) const;

    VkExtent2D extent_{};
    Image numberImage_;
    Image depthImage_;
    Handle<VkFramebuffer, vkDestroyFramebuffer> framebuffer_;
    Buffer numbers_;
};

}  // namespace nightcity::gpu
