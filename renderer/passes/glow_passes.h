// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The passes of --method field over one band (shaders/shared/glow.h): choose rays, integrate
// along them, choose more where glow bends, composite; and which media are seen first.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "dispatch.h"
#include "glow.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/compute_pipeline.h"
#include "gpu/readable_buffer.h"
#include "passes/near_panes.h"
#include "settings.h"

namespace nightcity {

// Whole rows of a frame. What the passes cover reaches past the rows that are kept, as far as
// these depend on their neighbours; so a frame is the same in any bands.
struct GlowBand {
    std::uint32_t firstRow = 0, rows = 0;          // covered
    std::uint32_t firstKeptRow = 0, keptRows = 0;  // of the frame
};

// Bands that keep `count` rows of a frame from row `first` on, each covering at most about
// `pixels` pixels.
std::vector<GlowBand> glowBands(std::uint32_t width, std::uint32_t height, std::uint32_t first,
                                std::uint32_t count, std::uint64_t pixels);

class GlowPasses {
public:
    // `aovs`: images that the composite writes (aovs.h).
    GlowPasses(gpu::Device& device, gpu::Commands& commands, std::uint32_t aovs, NearKinds near);

    // For bands of at most so many pixels a row and rows.
    void reserve(std::uint32_t width, std::uint32_t rows);
    // Of the GlowTable.
    VkDeviceAddress tableAddress() const { return table_.address(); }

    // To be called before the passes of a band are recorded. `tolerance`: relative.
    void setBand(const GlowBand& band, std::uint32_t width, float tolerance, GlowRays rays);
    // Forgets the band: the passes then find nothing to do.
    void clearBand();
    // One dispatch of each, to be called after clearBand().
    void recordWarmUp(VkCommandBuffer commands, const PushConstants& push) const;
    // Surfaces of the band must be found. `timed(name, record)` times what it records and puts a
    // compute barrier behind it.
    using Timed = std::function<void(const char*, const std::function<void()>&)>;
    void record(VkCommandBuffer commands, PushConstants push, const Timed& timed) const;
    // With kAovMediaId, before that: the ids of the media that rays meet first, but those of the
    // cells that it lists as kMixedCells.
    void recordMedia(VkCommandBuffer commands, const PushConstants& push, const Timed& timed) const;

    // After the passes of a band have run: whether its lists of panes did not fit. There is
    // room then, and the passes are to be recorded anew, from setBand on.
    bool makeRoom();

private:
    std::uint32_t cellGroups() const;  // of a pass over all cells
    void recordRefine(VkCommandBuffer commands, const PushConstants& push) const;
    void reservePanes(std::uint32_t count);

    gpu::Device& device_;
    gpu::Commands& commands_;
    std::uint64_t ledgerBytes_;  // a pixel; 0: none is kept
    bool seesMedia_;             // their ids are asked for
    gpu::ComputePipeline plan_, tiles_, trace_;
    std::array<gpu::ComputePipeline, kRefineSteps> refine_;
    // The lists that pixels are composited from.
    static constexpr std::array kCompositeLists{kClearCells, kSmoothCells, kOtherCells};
    std::array<gpu::ComputePipeline, kCompositeLists.size()> composite_;
    gpu::ComputePipeline mediaCorners_, mediaCells_;
    gpu::Buffer samples_, ledger_, cells_, traced_, lists_, tileTable_, tileRays_, tilePanes_;
    gpu::Buffer mediaSeen_;
    gpu::ReadableBuffer paneCounter_;
    gpu::Buffer table_;
    std::uint32_t pixels_ = 0, tileCount_ = 0;  // that there is room for
    GlowTable contents_{};
};

}  // namespace nightcity
