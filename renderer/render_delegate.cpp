// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "render_delegate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <ranges>
#include <stdexcept>
#include <utility>

#include "errors.h"
#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/instance.h"
#include "gpu/physical_device.h"
#include "passes/field_alarm.h"
#include "passes/frame_renderer.h"
#include "passes/gpu_scene.h"
#include "passes/memory_plan.h"

namespace nightcity {
namespace {

constexpr std::uint64_t kMostPixels = 1u << 30;  // pixel numbers are 32 bits on the device

// The far field by the tolerance: as measured in the paper's city (docs/accuracy.md), its part of the
// error then stays below it on 99 of 100 pixels.
struct FarStep {
    double tolerance;
    float spacing;  // m
    float spread;   // FarFieldSettings
};
constexpr FarStep kFarSteps[] = {{0.03, 1.0f, 0.15f}, {0.01, 0.5f, 0.025f}};
constexpr FarStep kWidestStep = {INFINITY, 1.43f, 0.2f};  // for larger tolerances
// Near windows cost as the square of the near radius; below so many spacings the far part has
// peaks that the nodes miss.
constexpr float kRadiusSpacings = 6;
constexpr float kLargestRadius = 4;  // m

FarStep farStep(double tolerance) {
    for (const FarStep& step : std::views::reverse(kFarSteps)) {
        if (tolerance <= step.tolerance) {
            return step;
        }
    }
    return kWidestStep;
}

// Bricks of a large city are lit by thousands of windows each: fewer keep its bake to about a minute.
constexpr std::size_t kLargeCity = 50'000;  // windows
constexpr std::uint64_t kLargeCityBricks = 2000;

FarFieldSettings farFieldSettings(const RenderSettings& settings, const FlatScene& scene,
                                  const std::string& cameraName) {
    const CameraTrack& camera = scene.camera(cameraName);
    FarFieldSettings far;
    if (settings.bricks) {
        far.mostBricks = *settings.bricks;
    } else if (scene.windows.size() > kLargeCity) {
        far.mostBricks = kLargeCityBricks;
    }
    for (const CameraFrame& frame : camera.frames) {
        far.eyes.push_back(frame.position);
    }
    far.emitter = settings.model.emitter;
    far.visibility = settings.model.visibility;
    far.scattering = settings.model.scattering;
    if (far.scattering == Scattering::multiple) {
        far.surfaces = settings.model.surfaces;
    }
    const FarStep step = farStep(settings.tolerance.value_or(kFieldTolerance));
    far.spacing = step.spacing;
    far.spread = step.spread;
    far.nearRadius = std::min(kRadiusSpacings * far.spacing, kLargestRadius);
    return far;
}

class VulkanDelegate final : public RenderDelegate {
public:
    explicit VulkanDelegate(const DeviceOptions& options)
        : instance_(options.validation),
          device_(instance_.get(),
                  gpu::chooseDevice(gpu::describeDevices(instance_.get()), options.device)),
          commands_(device_),
          scene_(device_, commands_),
          renderer_(device_, commands_),
          memoryBytes_(options.memoryBytes) {
        statistics_.device = device_.name();
        if (device_.limits().nanosecondsPerTick == 0) {
            deviceNotes_.push_back(device_.name() +
                                   " has no timestamps: passes are not timed one by one");
        }
        for (const std::string& lack : device_.missingForRaster()) {
            deviceNotes_.push_back(device_.name() + " lacks " + lack +
                                   ": what the camera sees is found by ray queries");
        }
        instance_.throwIfMessages();
    }

    std::uint64_t planMemory(const FlatScene& scene, const RenderProduct& product,
                             const RenderSettings& settings) override {
        std::optional<FarFieldSettings> field;
        if (settings.method == Method::field && settings.media) {
            field = farFieldSettings(settings, scene, product.camera);
        }
        const MemoryPlan plan = nightcity::planMemory(device_, scene, product, settings,
                                                      field ? &*field : nullptr);
        scene.dropPages();
        statistics_.plannedBytes = plan.bytes();
        if (memoryBytes_) {
            requireMemory(plan, *memoryBytes_, device_.name());
            device_.ledger().setLimit(*memoryBytes_);
        }
        return plan.bytes();
    }

    void sync(const FlatScene& scene, const std::string& camera, int frame,
              const RenderSettings& settings, const SceneChanges& changes,
              const ProgressCallback& progress) override {
        const auto start = std::chrono::steady_clock::now();
        const bool all = flatScene_ != &scene;
        flatScene_ = nullptr;  // until all of it is on the device
        if (all || changes.geometry) {
            scene_.syncGeometry(scene);
        }
        scene_.syncWindowState(scene, frame, settings);
        const bool field = settings.method == Method::field && settings.media;
        if (field) {
            scene_.syncFarField(scene, scene.windowsOn(frame),
                                farFieldSettings(settings, scene, camera), progress);
        }
        if (all || changes.geometry) {
            fieldAlarm_.sceneChanged();
        }
        flatScene_ = &scene;
        renderer_.sceneChanged();
        const std::chrono::duration<double, std::milli> wall =
            std::chrono::steady_clock::now() - start;
        statistics_.bakeMilliseconds = wall.count();
        if (field) {
            statistics_.bakePasses = scene_.farField().passTimes();
            statistics_.farFieldBytes = scene_.farField().bytes();
            statistics_.farFieldBricks = scene_.farField().brickCount();
        }
        const LightPages& pages = scene_.lights().pages();
        statistics_.lightStorage =
            pages.storage == LightStorage::uniform ? "uniform" : "storage";
        statistics_.lightPages = pages.count;
        instance_.throwIfMessages();
    }

    void render(const RenderProduct& product, const RenderSettings& settings,
                const ProgressCallback& progress) override {
        checkProduct(product, settings);
        const CameraFrame& camera = flatScene_->camera(product.camera).at(product.frame);
        fieldAlarm_.update(device_, commands_, scene_, *flatScene_, product, settings);
        frame_ = {};
        if (product.pixels.empty()) {
            frame_.resize(product.width, product.rows().count);
        } else {
            frame_.resize(static_cast<std::uint32_t>(product.pixels.size()), 1);
        }
        FrameCost cost = renderer_.render(scene_, camera, product, settings, progress, frame_);
        statistics_.frameMilliseconds = cost.milliseconds;
        statistics_.passes = std::move(cost.passes);
        statistics_.lightEvaluations = cost.lightEvaluations;
        statistics_.deviceMemoryBytes = device_.ledger().bytes();
        statistics_.devicePeakBytes = device_.ledger().peakBytes();
        statistics_.deviceMemory = device_.ledger().byName();
        instance_.throwIfMessages();
    }

    Frame resolve() override { return std::move(frame_); }

    RenderStatistics statistics() const override { return statistics_; }

    std::vector<std::string> notes() const override {
        std::vector<std::string> all = deviceNotes_;
        if (!scene_.lights().note().empty()) {
            all.push_back(scene_.lights().note());
        }
        if (fieldAlarm_.note()) {
            all.push_back(*fieldAlarm_.note());
        }
        return all;
    }

private:
    void checkProduct(const RenderProduct& product, const RenderSettings& settings) const {
        if (flatScene_ == nullptr) {
            throw std::logic_error("render before a sync that succeeded");
        }
        if (settings.method == Method::reference) {
            throw std::logic_error("the reference is no work of the device");
        }
        if (settings.method == Method::march && settings.model != Model{}) {
            throw UsageError("--method march knows --model paper only: for any other model take "
                             "--method gauss, path or reference");
        }
        if (product.width == 0 || product.height == 0) {
            throw UsageError("--size: width and height must be at least 1 pixel");
        }
        if (std::uint64_t{product.width} * product.height > kMostPixels) {
            throw UsageError("--size: a frame has at most " + std::to_string(kMostPixels) +
                             " pixels; render it in tiles");
        }
        const RowRange rows = product.rows();
        if (rows.count == 0 || rows.first >= product.height ||
            rows.count > product.height - rows.first) {
            throw std::logic_error("a tile outside its frame");
        }
        if (settings.method == Method::gauss && !settings.tolerance) {
            throw UsageError("--method gauss needs --tolerance");
        }
        if (settings.subdivisions == 0) {
            throw UsageError("--subdivisions must be at least 1");
        }
        if (settings.samples == 0) {
            throw UsageError("--samples must be at least 1");
        }
        for (const glm::uvec2& pixel : product.pixels) {
            if (pixel.x >= product.width || pixel.y >= product.height) {
                throw UsageError("--pixels: pixel " + std::to_string(pixel.x) + ", " +
                                 std::to_string(pixel.y) + " lies outside the frame of " +
                                 std::to_string(product.width) + " x " +
                                 std::to_string(product.height));
            }
        }
    }

    gpu::Instance instance_;
    gpu::Device device_;
    gpu::Commands commands_;
    GpuScene scene_;
    FrameRenderer renderer_;
    std::optional<std::uint64_t> memoryBytes_;
    const FlatScene* flatScene_ = nullptr;
    Frame frame_;
    RenderStatistics statistics_;
    std::vector<std::string> deviceNotes_;
    FieldAlarm fieldAlarm_;
};

std::string describeInOneLine(std::size_t index, const gpu::DeviceDescription& device) {
    std::string line = std::to_string(index) + ": " + device.name + " (" + device.driver + ")";
    const std::vector<std::string> missing = device.missing();
    for (std::size_t i = 0; i < missing.size(); ++i) {
        line += (i == 0 ? " - lacks " : ", ") + missing[i];
    }
    return line;
}

}  // namespace

std::vector<std::string> listDevices() {
    const gpu::Instance instance(false);
    std::vector<std::string> lines;
    const std::vector<gpu::DeviceDescription> devices = gpu::describeDevices(instance.get());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        lines.push_back(describeInOneLine(i, devices[i]));
    }
    return lines;
}

std::unique_ptr<RenderDelegate> RenderDelegate::create(const DeviceOptions& options) {
    return std::make_unique<VulkanDelegate>(options);
}

}  // namespace nightcity
