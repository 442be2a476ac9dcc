// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/timestamps.h"

#include <stdexcept>

#include "gpu/result.h"

namespace nightcity::gpu {

Timestamps::Timestamps(Device& device, uint32_t spans) : device_(device), capacity_(2 * spans) {
    if (device.limits().nanosecondsPerTick == 0) {
        return;
    }
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = capacity_;
    VkQueryPool pool = VK_NULL_HANDLE;
    check(vkCreateQueryPool(device.get(), &info, nullptr, &pool), "vkCreateQueryPool",
          "timestamps");
    pool_ = {device.get(), pool};
}

void Timestamps::begin(VkCommandBuffer commands) {
    names_.clear();
    next_ = 0;
    if (pool_.get() != VK_NULL_HANDLE) {
        vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
    }
}

void Timestamps::stamp(VkCommandBuffer commands, VkPipelineStageFlagBits stage) {
    if (pool_.get() == VK_NULL_HANDLE) {
        return;
    }
    if (next_ == capacity_) {
        throw std::logic_error("more timed spans in a batch than announced");
    }
    vkCmdWriteTimestamp(commands, stage, pool_.get(), next_++);
}

std::vector<std::pair<std::string, double>> Timestamps::read() const {
    std::vector<std::pair<std::string, double>> spans;
    if (next_ == 0) {
        return spans;
    }
    std::vector<uint64_t> ticks(next_);
    check(vkGetQueryPoolResults(device_.get(), pool_.get(), 0, next_, ticks.size() * 8,
                                ticks.data(), 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults", "timestamps");
    for (size_t i = 0; i < names_.size(); ++i) {
        const double elapsed = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]);
        spans.emplace_back(names_[i], elapsed * device_.limits().nanosecondsPerTick * 1e-6);
    }
    return spans;
}

}  // namespace nightcity::gpu
