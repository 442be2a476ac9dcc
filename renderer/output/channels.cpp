// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/channels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "aovs.h"
#include "errors.h"

namespace nightcity {

namespace {

constexpr std::array<std::string_view, 11> kAovs{  // the bits of aovs.h, from the lowest
    "beauty", "glow", "surface", "transmittance", "depth", "normal", "mediaId", "materialId",
    kErrorAov, kLedgerAovNames[0], kLedgerAovNames[1]};
static_assert(kAllAovs == (1u << kAovs.size()) - 1);

template <auto Member, int Component>
float component(const Frame& frame, std::size_t pixel) {
    return (frame.*Member)[pixel][Component];
}

template <auto Member>
float scalar(const Frame& frame, std::size_t pixel) {
    return (frame.*Member)[pixel];
}

constexpr std::array kChannels{
    Channel{"beauty", "R", component<&Frame::beauty, 0>},
    Channel{"beauty", "G", component<&Frame::beauty, 1>},
    Channel{"beauty", "B", component<&Frame::beauty, 2>},
    Channel{"beauty", "A", component<&Frame::beauty, 3>},
    Channel{"glow", "glow.R", component<&Frame::glow, 0>},
    Channel{"glow", "glow.G", component<&Frame::glow, 1>},
    Channel{"glow", "glow.B", component<&Frame::glow, 2>},
    Channel{"surface", "surface.R", component<&Frame::surface, 0>},
    Channel{"surface", "surface.G", component<&Frame::surface, 1>},
    Channel{"surface", "surface.B", component<&Frame::surface, 2>},
    Channel{"transmittance", "transmittance.Y", scalar<&Frame::transmittance>},
    Channel{"depth", "depth.Z", scalar<&Frame::depth>},
    Channel{"normal", "N.X", component<&Frame::normal, 0>},
    Channel{"normal", "N.Y", component<&Frame::normal, 1>},
    Channel{"normal", "N.Z", component<&Frame::normal, 2>},
    Channel{"mediaId", "mediaId.Y", scalar<&Frame::mediaId>},
    Channel{"materialId", "materialId.Y", scalar<&Frame::materialId>},
    Channel{kErrorAov, "glowError.R", component<&Frame::glowError, 0>},
    Channel{kErrorAov, "glowError.G", component<&Frame::glowError, 1>},
    Channel{kErrorAov, "glowError.B", component<&Frame::glowError, 2>},
    Channel{kLedgerAovNames[0], "error.Y", scalar<&Frame::error>},
    Channel{kLedgerAovNames[1], "cost.Y", scalar<&Frame::cost>},
};

void checkNames(std::span<const std::string> aovs) {
    for (const std::string& aov : aovs) {
        if (std::find(kAovs.begin(), kAovs.end(), aov) != kAovs.end()) {
            continue;
        }
        std::string known;
        for (const std::string_view name : kAovs) {
            known += (known.empty() ? "" : ", ") + std::string(name);
        }
        throw UsageError("no AOV is called '" + aov + "'; there are " + known);
    }
}

}  // namespace

std::vector<std::string> commonAovs() {
    return {kAovs.begin(), kAovs.begin() + std::popcount(kCommonAovs)};
}

std::vector<Channel> selectChannels(std::span<const std::string> aovs) {
    checkNames(aovs);
    const std::vector<std::string> common = commonAovs();
    const std::span<const std::string> wanted = aovs.empty() ? common : aovs;
    std::vector<Channel> selected;
    for (const Channel& channel : kChannels) {
        if (std::find(wanted.begin(), wanted.end(), channel.aov) != wanted.end()) {
            selected.push_back(channel);
        }
    }
    return selected;
}

std::uint32_t aovBits(std::span<const std::string> aovs) {
    checkNames(aovs);
    if (aovs.empty()) {
        return kCommonAovs;
    }
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kAovs.size(); ++i) {
        bits |= std::find(aovs.begin(), aovs.end(), kAovs[i]) != aovs.end() ? 1u << i : 0;
    }
    return bits;
}

void requireFinite(const Frame& frame) {
    const std::size_t pixels = std::size_t{frame.width} * frame.height;
    std::size_t bad = 0;
    std::string first;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        for (const Channel& channel : kChannels) {
            if (std::isfinite(channel.value(frame, pixel))) {
                continue;
            }
            if (bad++ == 0) {
                first = "x " + std::to_string(pixel % frame.width) + ", y " +
                        std::to_string(pixel / frame.width) + ", channel " +
                        std::string(channel.name);
            }
        }
    }
    if (bad > 0) {
        throw std::runtime_error("the frame holds " + std::to_string(bad) +
                                 " values that are no finite numbers, first at " + first +
                                 "; this is a fault of the renderer, and nothing was written");
    }
}

}  // namespace nightcity
