// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/glow_passes.h"

#include <algorithm>

#include "aovs.h"
#include "glow_composite_spirv.h"
#include "glow_plan_spirv.h"
#include "glow_refine_spirv.h"
#include "glow_tiles_spirv.h"
#include "glow_trace_spirv.h"
#include "media_cells_spirv.h"
#include "media_corners_spirv.h"
#include "passes/gpu_scene.h"
#include "passes/pass_pipelines.h"

namespace nightcity {
namespace {

// The layouts that GL_EXT_scalar_block_layout gives the same records.
static_assert(sizeof(NearPane) == 64);
static_assert(sizeof(NearTable) == 3 * 8 + 4);
static_assert(sizeof(GlowSample) == 16);
static_assert(sizeof(GlowTile) == 12);
static_assert(sizeof(GlowLedger) == 8);
static_assert(sizeof(MediumSeen) == 8);
static_assert(sizeof(GlowTable) == 10 * 8 + 44);

std::uint32_t cellsFor(std::uint32_t pixels) {
    return (pixels + kGlowCell - 1) / kGlowCell;
}

constexpr std::uint32_t kFirstPanes = 1u << 16;  // in the lists of a band

std::uint32_t tilesFor(std::uint32_t cells) {
    return (cells + kTileCells - 1) / kTileCells;
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

GlowPasses::GlowPasses(gpu::Device& device, gpu::Commands& commands, std::uint32_t aovs,
                       NearKinds near)
    : device_(device),
      commands_(commands),
      ledgerBytes_((aovs & kLedgerAovs) != 0 ? sizeof(GlowLedger) : 0),
      seesMedia_((aovs & kAovMediaId) != 0),
      plan_(makePipeline(device, "glow plan", kGlowPlanSpirv, {})),
      tiles_(makePipeline(device, "glow tiles", kGlowTilesSpirv, {})),
      trace_(makePipeline(device, "glow trace", kGlowTraceSpirv, {},
                          {near.points ? 1u : 0u, near.cutAll ? 1u : 0u, near.thinHaze ? 1u : 0u,
                           ledgerBytes_ != 0 ? 1u : 0u, emitterConstant(near.emitter)})),
      mediaCorners_(makePipeline(device, "media corners", kMediaCornersSpirv, {})),
      mediaCells_(makePipeline(device, "media cells", kMediaCellsSpirv, {})),
      paneCounter_(device, "glow pane counter", 4),
      table_(device, "glow table", sizeof(GlowTable), gpu::MemoryKind::device) {
    for (std::uint32_t step = 0; step < kRefineSteps; ++step) {
        refine_[step] = makePipeline(device, "glow refine", kGlowRefineSpirv, {}, {step});
    }
    for (std::size_t i = 0; i < kCompositeLists.size(); ++i) {
        composite_[i] = makePipeline(device, "glow composite", kGlowCompositeSpirv, {},
                                     {kCompositeLists[i], aovs});
    }
    contents_.paneCounter = addressWords(paneCounter_.buffer().address());
    reservePanes(kFirstPanes);
    clearBand();
}

void GlowPasses::clearBand() {
    contents_.rows = 0;
    contents_.rowCells = 0;
    contents_.rowTiles = 0;
    commands_.upload(table_, &contents_, sizeof contents_);
}

void GlowPasses::reserve(std::uint32_t width, std::uint32_t rows) {
    const std::uint32_t pixels = width * rows;
    const std::uint32_t tiles = tilesFor(cellsFor(width)) * tilesFor(cellsFor(rows));
    if (pixels <= pixels_ && tiles <= tileCount_) {
        return;
    }
    pixels_ = 0;
    const auto make = [&](gpu::Buffer& buffer, const char* name, std::uint64_t bytes) {
        buffer = {};
        buffer = {device_, name, bytes, gpu::MemoryKind::device};
        return addressWords(buffer.address());
    };
    contents_.samples = make(samples_, "glow samples", std::uint64_t{pixels} * sizeof(GlowSample));
    if (ledgerBytes_ != 0) {
        contents_.ledger = make(ledger_, "glow ledger", std::uint64_t{pixels} * ledgerBytes_);
    }
    const std::uint64_t cells = std::uint64_t{tiles} * kTileCells * kTileCells;  // or fewer
    contents_.cells = make(cells_, "glow cells", cells * 4);
    contents_.traced = make(traced_, "glow cells traced", cells * 4);
    if (seesMedia_) {
        contents_.mediaSeen = make(mediaSeen_, "media seen", cells * sizeof(MediumSeen));
    }
    contents_.lists = make(lists_, "lists of cells", kCellLists * (cells + 1) * 4);
    contents_.tiles = make(tileTable_, "glow tiles", std::uint64_t{tiles} * sizeof(GlowTile));
    contents_.tileRays = make(tileRays_, "glow rays", std::uint64_t{tiles} * kTilePixels * 4);
    pixels_ = pixels;
    tileCount_ = tiles;
}

bool GlowPasses::makeRoom() {
    const std::uint32_t needed = *static_cast<const std::uint32_t*>(paneCounter_.data());
    if (needed <= contents_.paneCapacity) {
        return false;
    }
    reservePanes(needed + needed / 4);
    commands_.upload(table_, &contents_, sizeof contents_);
    return true;
}

void GlowPasses::reservePanes(std::uint32_t count) {
    tilePanes_ = {};
    tilePanes_ = {device_, "glow panes", std::uint64_t{count} * 4, gpu::MemoryKind::device};
    contents_.tilePanes = addressWords(tilePanes_.address());
    contents_.paneCapacity = count;
}

void GlowPasses::setBand(const GlowBand& band, std::uint32_t width, float tolerance,
                         GlowRays rays) {
    contents_.rows = band.rows;
    contents_.columnCells = cellsFor(width);
    contents_.rowCells = cellsFor(band.rows);
    contents_.columnTiles = tilesFor(contents_.columnCells);
    contents_.rowTiles = tilesFor(contents_.rowCells);
    contents_.firstRow = band.firstRow;
    contents_.firstKeptCell = (band.firstKeptRow - band.firstRow) / kGlowCell;
    contents_.keptCells =
        cellsFor(band.firstKeptRow + band.keptRows - band.firstRow) - contents_.firstKeptCell;
    contents_.tolerance = tolerance;
    contents_.everyPixel = rays == GlowRays::all ? 1 : 0;
    commands_.upload(table_, &contents_, sizeof contents_);
}

void GlowPasses::recordWarmUp(VkCommandBuffer commands, const PushConstants& push) const {
    for (const gpu::ComputePipeline* pipeline : {&plan_, &tiles_, &trace_}) {
        pipeline->dispatch(commands, &push, 1);
    }
    if (seesMedia_) {
        mediaCorners_.dispatch(commands, &push, 1);
        mediaCells_.dispatch(commands, &push, 1);
    }
    for (const gpu::ComputePipeline& pipeline : refine_) {
        pipeline.dispatch(commands, &push, 1);
    }
    for (const gpu::ComputePipeline& pipeline : composite_) {
        pipeline.dispatch(commands, &push, 1);
    }
}

void GlowPasses::recordMedia(VkCommandBuffer commands, const PushConstants& push,
                             const Timed& timed) const {
    vkCmdFillBuffer(commands, lists_.get(), kMixedCells * 4, 4, 0);
    timed("media ids", [&] {
        mediaCorners_.dispatch(commands, &push, cellGroups());
        gpu::computeBarrier(commands);
        mediaCells_.dispatch(commands, &push, cellGroups());
    });
}

std::uint32_t GlowPasses::cellGroups() const {
    return (contents_.columnCells * contents_.rowCells + kGroupSize - 1) / kGroupSize;
}

void GlowPasses::recordRefine(VkCommandBuffer commands, const PushConstants& push) const {
    if (push.round == 1) {
        refine_[kRefineEdges].dispatch(commands, &push, kListGroups);
        refine_[kRefineSort].dispatch(commands, &push, cellGroups());
        gpu::computeBarrier(commands);  // the next adds to the list that the first goes through
        refine_[kRefinePatches].dispatch(commands, &push, kListGroups);
    } else {
        refine_[kRefineQuarters].dispatch(commands, &push, kListGroups);
    }
}

void GlowPasses::record(VkCommandBuffer commands, PushConstants push, const Timed& timed) const {
    const std::uint32_t cells = contents_.columnCells * contents_.rowCells;
    const std::uint32_t tiles = contents_.columnTiles * contents_.rowTiles;
    for (const gpu::Buffer* masks : {&cells_, &traced_}) {
        vkCmdFillBuffer(commands, masks->get(), 0, std::uint64_t{cells} * 4, 0);
    }
    vkCmdFillBuffer(commands, lists_.get(), 0, kCellLists * 4, 0);
    vkCmdFillBuffer(commands, paneCounter_.buffer().get(), 0, 4, 0);
    gpu::computeBarrier(commands);
    for (push.round = 0; push.round < kGlowRounds; ++push.round) {
        if (push.round == 0) {
            timed("plan", [&] { plan_.dispatch(commands, &push, cellGroups()); });
        } else {
            timed("refine", [&] { recordRefine(commands, push); });
        }
        timed("tiles", [&] {
            tiles_.dispatch(commands, &push, (tiles + kTileGroup - 1) / kTileGroup);
        });
        timed("glow", [&] { trace_.dispatch(commands, &push, tiles); });
    }
    timed("composite", [&] {
        for (const gpu::ComputePipeline& pipeline : composite_) {
            pipeline.dispatch(commands, &push, kListGroups);
        }
    });
    paneCounter_.recordReadback(commands);
}

}  // namespace nightcity
