// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Device time of named spans of one batch of commands.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace nightcity::gpu {

class Timestamps {
public:
    // At most `spans` spans a batch. Where the device has no timestamps, nothing is recorded.
    Timestamps(Device& device, uint32_t spans);

    void begin(VkCommandBuffer commands);  // first in the batch: forgets the spans before
    // Measures what `record` records. A compute barrier must follow it, so that spans are apart.
    template <typename Record>
    void span(VkCommandBuffer commands, const char* name, const Record& record) {
        stamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT);
        record();
        stamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
        names_.emplace_back(name);
    }
    // Of the finished batch, in order: name, milliseconds.
    std::vector<std::pair<std::string, double>> read() const;

private:
    void stamp(VkCommandBuffer commands, VkPipelineStageFlagBits stage);

    Device& device_;
    Handle<VkQueryPool, vkDestroyQueryPool> pool_;
    uint32_t capacity_ = 0;
    uint32_t next_ = 0;
    std::vector<std::string> names_;
};

}  // namespace nightcity::gpu
