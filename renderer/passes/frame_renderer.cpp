// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/frame_renderer.h"

#include <algorithm>
#include <cstddef>

#include "aovs.h"
#include "sample_positions.h"

namespace nightcity {
namespace {

// surface, lit, traverse, march or gauss; or surface, lit, media ids, three rounds of plan, tiles
// and glow, composite
constexpr std::uint32_t kSpansPerBatch = 14;
// Pixels of a band: about 100 MiB of records and images.
constexpr std::uint32_t kBandPixels = 1u << 18;
// Of --method field, whose records are smaller and whose bands overlap.
constexpr std::uint32_t kGlowBandPixels = 1u << 20;

std::uint32_t groupsFor(std::uint32_t threads) {
    return (threads + kGroupSize - 1) / kGroupSize;
}

// Splits a position into what float holds and what it loses.
void setPosition(FrameTable& table, const CameraFrame& camera, glm::vec3 offset) {
    const glm::dvec3 exact = glm::dvec3(camera.position) + glm::dvec3(offset);
    table.camera = camera;
    table.camera.position = glm::vec3(exact);
    table.positionLow = glm::vec3(exact - glm::dvec3(table.camera.position));
}

// The images that are asked for, and those that a sum or an error needs; without haze not those
// that a Frame has right from the start.
std::uint32_t writtenAovs(const RenderProduct& product, const RenderSettings& settings) {
    std::uint32_t aovs = product.aovs;
    if (settings.pixelSamples > 1 && (aovs & kAovBeauty) != 0) {
        aovs |= kAovSurface | kAovGlow;
    }
    if (settings.pixelSamples > 1 && (aovs & kAovError) != 0) {
        aovs |= kAovGlow;
    }
    if (settings.method == Method::path) {
        return aovs | kAovGlow;
    }
    return settings.media ? aovs : aovs & ~kHazeAovs;
}

float toleranceOf(const RenderSettings& settings) {
    return static_cast<float>(settings.tolerance.value_or(kFieldTolerance));
}

// The settings that pipelines of the method are specialised to; the others as they are by
// default, so that a change of them makes no pipeline anew.
PipelineChoice chooseFor(const GpuScene& scene, const RenderProduct& product,
                         const RenderSettings& settings) {
    PipelineChoice choice;
    choice.method = settings.method;
    choice.media = settings.media;
    choice.aovs = writtenAovs(product, settings);
    const bool lit = settings.method != Method::march &&
                     settings.model.surfaces == Surfaces::lit &&
                     (choice.aovs & (kAovBeauty | kAovSurface)) != 0;
    if (!settings.media && settings.method != Method::path && !lit) {
        choice.task = settings.writeOnly ? kTaskWrite : kTaskImages;
        return choice;
    }
    if (settings.method == Method::field) {
        choice.near = scene.nearKinds(double(toleranceOf(settings)));
        if (lit) {
            choice.model = settings.model;
        }
        return choice;
    }
    if (settings.method == Method::path) {
        choice.model = settings.model;
        choice.model.scattering = Scattering::single;  // the orders are in the frame table
    } else {
        choice.lights = scene.lights().pages();
        if (settings.method == Method::gauss) {
            choice.model = settings.model;
            choice.uniformHaze = scene.isHazeUniform();
        } else {
            choice.order = settings.marchOrder;
            choice.subdivisions = settings.subdivisions;
        }
    }
    return choice;
}

// Without haze the field is not asked for.
RenderSettings ofHaze(RenderSettings settings) {
    if (!settings.media && settings.method == Method::field) {
        settings.method = Method::gauss;
        settings.tolerance = settings.tolerance.value_or(kFieldTolerance);
    }
    return settings;
}

constexpr double kNoReach = 1e15;  // m; a float holds its square

void setPaths(FrameTable& table, const RenderSettings& settings) {
    const bool single = settings.model.scattering == Scattering::single;
    table.paths = settings.samples;
    table.firstOrder = settings.orders.first;
    table.lastOrder = settings.orders.last.value_or(single ? 1 : kNoLastOrder);
    table.anisotropy = settings.anisotropy;
    table.seed = {static_cast<std::uint32_t>(settings.seed),
                  static_cast<std::uint32_t>(settings.seed >> 32)};
}

}  // namespace

struct FrameRenderer::Band {
    std::uint32_t firstPixel = 0, pixels = 0;  // in the order of the frame or the pixel list
    std::uint32_t skipped = 0, kept = 0;       // of them
    GlowBand glow;                             // of --method field
};

struct FrameRenderer::Work {
    const GpuScene& scene;
    const RenderSettings& settings;
    std::vector<vec2> samples;
    std::vector<Band> bands;
    FrameTable table{};        // of the frame, without the addresses of the band
    bool listed = false;       // a list of pixels, not all
    bool rasterised = false;
    FrameCost cost{};
};

FrameRenderer::FrameRenderer(gpu::Device& device, gpu::Commands& commands)
    : device_(device), commands_(commands), timestamps_(device, kSpansPerBatch), raster_(device) {}

FrameCost FrameRenderer::render(const GpuScene& scene, const CameraFrame& camera,
                                const RenderProduct& product, const RenderSettings& asked,
                                const std::function<void(double)>& progress, Frame& frame) {
    const RenderSettings settings = ofHaze(asked);
    Work work{.scene = scene,
              .settings = settings,
              .samples = samplePositions(settings),
              .bands = bandsOf(product, settings.method)};
    work.listed = !product.pixels.empty() && settings.method != Method::field;
    copied_ = 0;
    preparePipelines(scene, product, settings);
    prepareBand(work, camera, product);

    PushConstants push{};
    push.scene = addressWords(scene.tableAddress());
    push.frame = addressWords(band_->tableAddress());
    for (std::size_t number = 0; number < work.bands.size(); ++number) {
        const Band& band = work.bands[number];
        push.firstPixel = band.firstPixel;
        push.pixelCount = band.pixels;
        if (glow_) {
            glow_->setBand(band.glow, product.width, toleranceOf(settings), settings.glowRays);
        }
        for (std::uint32_t sample = 0; sample < work.samples.size(); ++sample) {
            push.sampleIndex = sample;
            const auto report = [&](double share) {  // of this sample
                if (progress) {
                    const double within = (sample + share) / static_cast<double>(work.samples.size());
                    progress((static_cast<double>(number) + within) /
                             static_cast<double>(work.bands.size()));
                }
            };
            renderSample(work, push, report);
            report(1);
        }
        copyBand(band, product, settings.method, frame);
    }
    return work.cost;
}

void FrameRenderer::renderSample(Work& work, const PushConstants& push,
                                 const std::function<void(double)>& progress) {
    const bool last = push.sampleIndex + 1 == work.samples.size();
    rasterise(work, push);
    if (pipelines_->choice.task != kTaskRecords) {
        surfaceSample(work, push, last);
    } else if (work.settings.method == Method::field) {
        traceGlow(work, push, last);
    } else if (work.settings.method == Method::path) {
        tracePaths(work, push, progress);
        accumulateSample(work, push, last);
    } else {
        scatterSample(work, push);
        accumulateSample(work, push, last);
    }
}

// The rows of --method field serve as neighbours of each other: of a list of pixels, whole rows
// are rendered, so that a pixel is what it is in the frame.
std::vector<FrameRenderer::Band> FrameRenderer::bandsOf(const RenderProduct& product,
                                                        Method method) {
    std::vector<Band> bands;
    if (method == Method::field) {
        const RowRange rows = product.pixels.empty() ? product.rows() : RowRange{0, product.height};
        for (const GlowBand& glow :
             glowBands(product.width, product.height, rows.first, rows.count, kGlowBandPixels)) {
            bands.push_back({glow.firstRow * product.width, glow.rows * product.width,
                             (glow.firstKeptRow - glow.firstRow) * product.width,
                             glow.keptRows * product.width, glow});
        }
        return bands;
    }
    std::uint64_t first = 0;
    std::uint64_t count = product.pixels.size();
    if (product.pixels.empty()) {
        first = std::uint64_t{product.width} * product.rows().first;
        count = std::uint64_t{product.width} * product.rows().count;
    }
    for (std::uint64_t done = 0; done < count; done += kBandPixels) {
        const auto pixels =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(kBandPixels, count - done));
        bands.push_back({static_cast<std::uint32_t>(first + done), pixels, 0, pixels, {}});
    }
    return bands;
}

std::uint64_t FrameRenderer::mostRays(const RenderProduct& product, Method method) {
    std::uint32_t most = 0;
    for (const Band& band : bandsOf(product, method)) {
        most = std::max(most, band.pixels);
    }
    return groupsFor(most) * kGroupSize;
}

void FrameRenderer::copyBand(const Band& band, const RenderProduct& product, Method method,
                             Frame& frame) {
    const std::uint32_t aovs = product.aovs & pipelines_->choice.aovs;
    if (method != Method::field || product.pixels.empty()) {
        band_->copyTo(frame, copied_, band.skipped, band.kept, aovs);
        copied_ += band.kept;
        return;
    }
    const std::uint32_t first = band.firstPixel + band.skipped;
    for (std::size_t i = 0; i < product.pixels.size(); ++i) {
        const std::uint32_t pixel = product.pixels[i].y * product.width + product.pixels[i].x;
        if (pixel >= first && pixel - first < band.kept) {
            band_->copyTo(frame, i, pixel - band.firstPixel, 1, aovs);
        }
    }
}

void FrameRenderer::preparePipelines(const GpuScene& scene, const RenderProduct& product,
                                     const RenderSettings& settings) {
    const PipelineChoice choice = chooseFor(scene, product, settings);
    if (!pipelines_ || pipelines_->choice != choice) {
        pipelines_ = std::make_unique<PassPipelines>(device_, choice);
        glow_.reset();
        if (choice.method == Method::field && choice.task == kTaskRecords) {
            glow_ = std::make_unique<GlowPasses>(device_, commands_, choice.aovs,
                                                 choice.near);
        }
        bound_ = false;
    }
    if (!bound_) {
        pipelines_->bind(scene);
    }
}

void FrameRenderer::prepareBand(Work& work, const CameraFrame& camera,
                                const RenderProduct& product) {
    const Method method = work.settings.method;
    const auto rays = static_cast<std::uint32_t>(mostRays(product, method));
    if (!band_ || band_->rays() != rays || band_->method() != method) {
        band_.reset();
        band_ = std::make_unique<BandBuffers>(device_, rays, method);
    }
    FrameTable& table = work.table;
    setPosition(table, camera, product.cameraOffset);
    table.width = product.width;
    table.height = product.height;
    table.sampleCount = static_cast<std::uint32_t>(work.samples.size());
    table.centreSample = static_cast<std::uint32_t>(centreSample(work.samples));
    table.tolerance =
        method == Method::field ? toleranceOf(work.settings)
                                : static_cast<float>(work.settings.tolerance.value_or(0));
    table.lightCap = work.settings.lightCap.value_or(kNone);
    table.reach = static_cast<float>(work.settings.reach.value_or(kNoReach));
    if (method == Method::path) {
        setPaths(table, work.settings);
    }
    work.rasterised = work.settings.primary == Primary::raster && !work.settings.writeOnly &&
                      raster_.serves(work.scene, product.width, product.height);
    table.proposals = work.rasterised ? raster_.prepare(product.width, product.height) : uvec2(0);
    if (glow_) {
        std::uint32_t rows = 0;
        for (const Band& band : work.bands) {
            rows = std::max(rows, band.glow.rows);
        }
        glow_->reserve(product.width, rows);
        glow_->clearBand();
        table.glowTable = addressWords(glow_->tableAddress());
    }
    band_->prepare(commands_, table, work.listed ? product.pixels : std::vector<uvec2>{},
                   work.samples);
    if (!bound_) {
        warmUp(work.scene);
        bound_ = true;
    }
}

// Drivers finish compiling a pipeline at its first dispatch: an empty one keeps that out of
// the frame's time.
void FrameRenderer::warmUp(const GpuScene& scene) {
    PushConstants push{};
    push.scene = addressWords(scene.tableAddress());
    push.frame = addressWords(band_->tableAddress());
    commands_.run("warm-up", [&](VkCommandBuffer commands) {
        for (const gpu::ComputePipeline* pipeline : pipelines_->all()) {
            pipeline->dispatch(commands, &push, 1);
        }
        if (glow_) {
            glow_->recordWarmUp(commands, push);
        }
    });
}

// Of all bands, where nothing was proposed for this sample yet. A batch of its own: behind a
// drawing in the same batch lavapipe takes the times of dispatches before they have run.
void FrameRenderer::rasterise(Work& work, const PushConstants& push) {
    // The proposals of one sample serve all bands; those of several replace each other.
    const bool oneSample = work.samples.size() == 1;
    if (!work.rasterised || (push.firstPixel != work.bands.front().firstPixel && oneSample)) {
        return;
    }
    FrameRows rows{work.table.width, work.table.height, 0, work.table.height};
    if (!work.listed) {
        const Band& last = work.bands.back();
        const std::uint64_t count =
            oneSample ? last.firstPixel - push.firstPixel + last.pixels : push.pixelCount;
        rows.first = push.firstPixel / rows.width;
        rows.count =
            static_cast<std::uint32_t>((push.firstPixel + count - 1) / rows.width) + 1 - rows.first;
    }
    const vec2 offset = glm::abs(work.samples[push.sampleIndex]);
    const double milliseconds = commands_.run("raster", [&](VkCommandBuffer commands) {
        timestamps_.begin(commands);
        timestamps_.span(commands, "raster", [&] {
            raster_.record(commands, work.scene, push, work.table.camera, rows,
                           std::max(offset.x, offset.y));
        });
        gpu::computeBarrier(commands);
    });
    collectTimes(work.cost, milliseconds);
}

void FrameRenderer::surfaceSample(Work& work, const PushConstants& push, bool last) {
    const double milliseconds = commands_.run("surface frame", [&](VkCommandBuffer commands) {
        timestamps_.begin(commands);
        gpu::computeBarrier(commands);
        dispatch(commands, "surface", pipelines_->surface, push);
        if (last) {
            band_->images().recordReadback(commands);
        }
    });
    collectTimes(work.cost, milliseconds);
}

void FrameRenderer::tracePaths(Work& work, PushConstants push,
                               const std::function<void(double)>& progress) {
    const std::uint32_t rounds = (work.settings.samples - 1) / kPathsPerDispatch + 1;
    for (push.round = 0; push.round < rounds; ++push.round) {
        const double milliseconds = commands_.run("trace", [&](VkCommandBuffer commands) {
            timestamps_.begin(commands);
            vkCmdFillBuffer(commands, band_->counters().buffer().get(), 0, sizeof(PassCounters), 0);
            gpu::computeBarrier(commands);
            if (push.round == 0) {
                dispatch(commands, "surface", pipelines_->surface, push);
            }
            dispatch(commands, "path", pipelines_->path, push);
            band_->counters().recordReadback(commands);
        });
        collectTimes(work.cost, milliseconds);
        work.cost.lightEvaluations +=
            counters().lightSegmentsLow | std::uint64_t{counters().lightSegmentsHigh} << 32;
        progress((push.round + 1.0) / rounds);
    }
}

void FrameRenderer::scatterSample(Work& work, PushConstants push) {
    const VkBuffer counterBuffer = band_->counters().buffer().get();
    const bool media = work.settings.media;
    const bool gauss = work.settings.method == Method::gauss;
    for (push.round = 0;; ++push.round) {
        const double milliseconds = commands_.run("trace", [&](VkCommandBuffer commands) {
            timestamps_.begin(commands);
            vkCmdFillBuffer(commands, counterBuffer, 0, sizeof(PassCounters), 0);
            gpu::computeBarrier(commands);
            if (push.round == 0) {
                dispatch(commands, "surface", pipelines_->surface, push);
                if (pipelines_->choice.lightsSurfaces()) {
                    dispatch(commands, "lit", pipelines_->lit, push);
                }
            }
            if (media) {
                dispatch(commands, "traverse", pipelines_->traverse, push);
                dispatch(commands, gauss ? "gauss" : "march", pipelines_->inScatter, push);
            }
            band_->counters().recordReadback(commands);
        });
        collectTimes(work.cost, milliseconds);
        const std::uint64_t lightSegments =
            counters().lightSegmentsLow | std::uint64_t{counters().lightSegmentsHigh} << 32;
        work.cost.lightEvaluations += lightSegments * (gauss ? 1 : work.settings.subdivisions);
        if (counters().unfinished == 0) {
            return;
        }
    }
}

void FrameRenderer::traceGlow(Work& work, const PushConstants& push, bool last) {
    do {
        const double milliseconds = commands_.run("trace", [&](VkCommandBuffer commands) {
            timestamps_.begin(commands);
            dispatch(commands, "surface", pipelines_->surface, push);
            if (pipelines_->choice.lightsSurfaces()) {
                dispatch(commands, "lit", pipelines_->lit, push);
            }
            const auto timed = [&](const char* name, const std::function<void()>& pass) {
                timestamps_.span(commands, name, pass);
                gpu::computeBarrier(commands);
            };
            if ((pipelines_->choice.aovs & kAovMediaId) != 0 &&
                push.sampleIndex == work.table.centreSample) {  // no other's is kept
                glow_->recordMedia(commands, push, timed);
                timed("media ids", [&] {
                    pipelines_->mediaIds.dispatch(commands, &push, kListGroups);
                });
            }
            glow_->record(commands, push, timed);
            if (last) {
                band_->images().recordReadback(commands);
            }
        });
        collectTimes(work.cost, milliseconds);
    } while (glow_->makeRoom());
}

void FrameRenderer::accumulateSample(Work& work, const PushConstants& push, bool last) {
    const double milliseconds = commands_.run("accumulate", [&](VkCommandBuffer commands) {
        timestamps_.begin(commands);
        gpu::computeBarrier(commands);
        dispatch(commands, "accumulate", pipelines_->accumulate, push);
        if (last) {
            band_->images().recordReadback(commands);
        }
    });
    collectTimes(work.cost, milliseconds);
}

void FrameRenderer::dispatch(VkCommandBuffer commands, const char* name,
                             const gpu::ComputePipeline& pipeline, const PushConstants& push) {
    timestamps_.span(commands, name, [&] {
        pipeline.dispatch(commands, &push, groupsFor(push.pixelCount));
    });
    gpu::computeBarrier(commands);
}

void FrameRenderer::collectTimes(FrameCost& cost, double milliseconds) {
    cost.milliseconds += milliseconds;
    for (const auto& [name, elapsed] : timestamps_.read()) {
        addPassTime(cost.passes, name, elapsed);
    }
}

const PassCounters& FrameRenderer::counters() const {
    return *static_cast<const PassCounters*>(band_->counters().data());
}

}  // namespace nightcity
