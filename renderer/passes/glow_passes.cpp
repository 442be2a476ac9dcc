// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/glow_passes.h"

#include <algorithm>

#include "glow_composite_spirv.h"
#include "glow_plan_spirv.h"
#include "glow_refine_spirv.h"
#include "glow_trace_spirv.h"
#include "passes/gpu_scene.h"
#include "passes/pass_pipelines.h"

namespace nightcity {
namespace {

// The layouts that GL_EXT_scalar_block_layout gives the same records.
static_assert(sizeof(NearPane) == 64);
static_assert(sizeof(NearTable) == 3 * 8 + 32);
static_assert(sizeof(GlowSample) == 16);
static_assert(sizeof(GlowRound) == sizeof(VkDispatchIndirectCommand) + 4);
static_assert(sizeof(GlowTable) == 4 * 8 + 36);

std::uint32_t cellsFor(std::uint32_t pixels) {
    return (pixels + kGlowCell - 1) / kGlowCell;
}

}  // namespace

std::vector<GlowBand> glowBands(std::uint32_t width, std::uint32_t height, std::uint32_t first,
                                std::uint32_t count, std::uint64_t pixels) {
    const auto most = static_cast<std::uint32_t>(std::max<std::uint64_t>(pixels / width, 64));
    const std::uint32_t end = first + count;
    std::vector<GlowBand> bands;
    for (std::uint32_t row = first; row < end;) {
        GlowBand band;
        band.firstKeptRow = row;
        // Cells of the kept rows, one more row of cells above, and below one more and the first
        // row of pixels of the next.
        const std::uint32_t firstCell = row / kGlowCell;
        const std::uint32_t lastCell = std::min((firstCell * kGlowCell + most - 1) / kGlowCell,
                                                (end - 1) / kGlowCell);
        band.keptRows = std::min(end, (lastCell + 1) * kGlowCell) - row;
        band.firstRow = (firstCell - std::min(firstCell, 1u)) * kGlowCell;
        band.rows = std::min(height, (lastCell + 2) * kGlowCell + 1) - band.firstRow;
        row += band.keptRows;
        bands.push_back(band);
    }
    return bands;
}

GlowPasses::GlowPasses(gpu::Device& device, gpu::Commands& commands, std::uint32_t aovs)
    : device_(device),
      commands_(commands),
      plan_(makePipeline(device, "glow plan", kGlowPlanSpirv, {})),
      trace_(makePipeline(device, "glow trace", kGlowTraceSpirv, {})),
      refine_(makePipeline(device, "glow refine", kGlowRefineSpirv, {})),
      composite_(makePipeline(device, "glow composite", kGlowCompositeSpirv, {}, {0, aovs})),
      rounds_(device, "glow rounds", kGlowRounds * sizeof(GlowRound), gpu::MemoryKind::device,
              VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT),
      table_(device, "glow table", sizeof(GlowTable), gpu::MemoryKind::device) {
    contents_.rounds = addressWords(rounds_.address());
    clearBand();
}

void GlowPasses::clearBand() {
    const GlowRound none[kGlowRounds] = {};
    commands_.upload(rounds_, none, sizeof none);
    contents_.rows = 0;
    contents_.rowCells = 0;
    commands_.upload(table_, &contents_, sizeof contents_);
}

void GlowPasses::reserve(std::uint32_t pixels) {
    if (pixels <= contents_.capacity) {
        return;
    }
    using gpu::MemoryKind;
    contents_.capacity = 0;
    samples_ = {};
    cells_ = {};
    lists_ = {};
    samples_ = {device_, "glow samples", std::uint64_t{pixels} * sizeof(GlowSample),
                MemoryKind::device};
    // A cell has at least one pixel.
    cells_ = {device_, "glow cells", std::uint64_t{pixels} * 4, MemoryKind::device};
    lists_ = {device_, "glow rays", std::uint64_t{pixels} * 4 * kGlowRounds, MemoryKind::device};
    contents_.samples = addressWords(samples_.address());
    contents_.cells = addressWords(cells_.address());
    contents_.lists = addressWords(lists_.address());
    contents_.capacity = pixels;
}

void GlowPasses::setBand(const GlowBand& band, std::uint32_t width, float tolerance,
                         GlowRays rays) {
    contents_.rows = band.rows;
    contents_.columnCells = cellsFor(width);
    contents_.rowCells = cellsFor(band.rows);
    contents_.firstRow = band.firstRow;
    contents_.firstKeptCell = (band.firstKeptRow - band.firstRow) / kGlowCell;
    contents_.keptCells =
        cellsFor(band.firstKeptRow + band.keptRows - band.firstRow) - contents_.firstKeptCell;
    contents_.tolerance = tolerance;
    contents_.everyPixel = rays == GlowRays::all ? 1 : 0;
    commands_.upload(table_, &contents_, sizeof contents_);
}

void GlowPasses::recordWarmUp(VkCommandBuffer commands, const PushConstants& push) const {
    for (const gpu::ComputePipeline* pipeline : {&plan_, &trace_, &refine_, &composite_}) {
        pipeline->dispatch(commands, &push, 1);
    }
}

void GlowPasses::record(VkCommandBuffer commands, PushConstants push, const Timed& timed) const {
    const std::uint32_t cells = contents_.columnCells * contents_.rowCells;
    const std::uint32_t groups = (cells + kGroupSize - 1) / kGroupSize;
    const GlowRound empty[kGlowRounds] = {{0, 1, 1, 0}, {0, 1, 1, 0}, {0, 1, 1, 0}};
    vkCmdUpdateBuffer(commands, rounds_.get(), 0, sizeof empty, empty);
    vkCmdFillBuffer(commands, cells_.get(), 0, std::uint64_t{cells} * 4, 0);
    gpu::computeBarrier(commands);
    for (push.round = 0; push.round < kGlowRounds; ++push.round) {
        const bool first = push.round == 0;
        timed(first ? "plan" : "refine", [&] {
            (first ? plan_ : refine_).dispatch(commands, &push, groups);
        });
        timed("glow", [&] {
            trace_.dispatchIndirect(commands, &push, rounds_, push.round * sizeof(GlowRound));
        });
    }
    timed("composite", [&] { composite_.dispatch(commands, &push, groups); });
}

}  // namespace nightcity
