// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The memory that a device has lent to buffers and images, by their names. No Vulkan.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

namespace nightcity::gpu {

class MemoryLedger {
public:
    void add(const std::string& name, uint64_t bytes) {
        byName_[name] += bytes;
        bytes_ += bytes;
        peakBytes_ = std::max(peakBytes_, bytes_);
    }

    void remove(const std::string& name, uint64_t bytes) {
        const auto found = byName_.find(name);
        found->second -= bytes;
        if (found->second == 0) {
            byName_.erase(found);
        }
        bytes_ -= bytes;
    }

    void setLimit(uint64_t bytes) { limit_ = bytes; }
    uint64_t limit() const { return limit_; }
    bool hasRoomFor(uint64_t bytes) const { return bytes <= limit_ - std::min(bytes_, limit_); }

    uint64_t bytes() const { return bytes_; }          // of all that is alive
    uint64_t peakBytes() const { return peakBytes_; }  // the most at any time
    const std::map<std::string, uint64_t>& byName() const { return byName_; }  // of what is alive

private:
    std::map<std::string, uint64_t> byName_;
    uint64_t bytes_ = 0;
    uint64_t peakBytes_ = 0;
    uint64_t limit_ = UINT64_MAX;
};

}  // namespace nightcity::gpu
