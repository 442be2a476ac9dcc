// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "far_field_device.h"

#include <optional>
#include <random>

#include "far_field_probe_spirv.h"
#include "gpu/physical_device.h"
#include "gpu/readable_buffer.h"
#include "transport/near_far_split.h"

namespace nightcity {
namespace {

const gpu::Binding kPlaces{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
const gpu::Binding kAnswers{1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};

// Weighted by `share(place, distance from the window's centre)`.
template <typename Share>
std::vector<glm::dvec3> judged(const FlatScene& scene, const FarFieldSettings& settings,
                               std::span<const glm::vec3> places, double relative, Share&& share) {
    RenderSettings model;
    model.model = {Lights::all, settings.visibility, settings.emitter};
    const LightScene lights(scene, 1, model);
    const SurfaceLight light(lights, Accuracy{relative, relative});
    std::vector<glm::dvec3> values;
    for (const glm::vec3& place : places) {
        glm::dvec3 sum(0);
        const SurfacePoint point{glm::dvec3(place), glm::dvec3(0), std::nullopt};
        for (const LitWindow& window : lights.windows) {
            const double weight = share(place, glm::length(point.place - window.centre));
            if (weight > 0) {
                // Far windows bring less than a thousandth of a near one: 1e-9 per watt is
                // below anything that counts.
                sum += weight * window.power *
                       light.fromWindow(point, window, {1e-9, relative}).value;
            }
        }
        values.push_back(sum);
    }
    return values;
}

std::optional<unsigned> scaleAt(const FarLayout& layout, glm::vec3 place) {
    const glm::ivec3 cell(glm::floor((place - layout.origin) / layout.cellSide));
    if (glm::any(glm::lessThan(cell, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(cell, glm::ivec3(layout.counts)))) {
        return std::nullopt;
    }
    const glm::uvec3 at(cell);
    const uint word = layout.index[(std::size_t{at.z} * layout.counts.y + at.y) * layout.counts.x +
                                   at.x];
    return word == ~0u ? std::nullopt : std::optional<unsigned>(word >> kScaleShift);
}

bool isInBuilding(const FlatScene& scene, glm::vec3 place) {
    for (const Building& building : scene.buildings) {
        glm::vec3 lo(INFINITY), hi(-INFINITY);
        for (const Triangle& triangle :
             scene.triangles.subspan(building.firstTriangle, building.triangleCount)) {
            for (int i = 0; i < 3; ++i) {
                lo = glm::min(lo, scene.positions[triangle.vertex[i]]);
                hi = glm::max(hi, scene.positions[triangle.vertex[i]]);
            }
        }
        if (glm::all(glm::greaterThan(place, lo - 0.02f)) &&
            glm::all(glm::lessThan(place, hi + 0.02f))) {
            return true;
        }
    }
    return false;
}

}  // namespace

FarFieldOnDevice::FarFieldOnDevice(bool validation)
    : instance_(validation),
      device_(instance_.get(), gpu::chooseDevice(gpu::describeDevices(instance_.get()), "")),
      commands_(device_),
      scene_(device_, commands_),
      probe_(device_, {"far field probe", kFarFieldProbeSpirv, {kPlaces, kAnswers},
                       sizeof(PushConstants), {}}) {}

void FarFieldOnDevice::sync(const FlatScene& scene, const FarFieldSettings& settings) {
    sync(scene, settings, scene.windowsOn(1));
}

void FarFieldOnDevice::sync(const FlatScene& scene, const FarFieldSettings& settings,
                            std::span<const std::uint8_t> windowOn) {
    settings_ = settings;
    scene_.syncGeometry(scene);
    scene_.syncWindowState(scene, 1, {});
    setWindows(scene, windowOn);
}

void FarFieldOnDevice::setWindows(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                                  const BakeProgress& progress) {
    scene_.syncFarField(scene, windowOn, settings_, progress);
    instance_.throwIfMessages();
}

std::vector<glm::vec3> FarFieldOnDevice::fluence(std::span<const glm::vec3> places) {
    const std::vector<glm::vec4> answers = fluenceAndError(places);
    return {answers.begin(), answers.end()};
}

std::vector<glm::vec4> FarFieldOnDevice::fluenceAndError(std::span<const glm::vec3> places) {
    gpu::Buffer source(device_, "places", places.size_bytes(), gpu::MemoryKind::device);
    commands_.upload(source, places.data(), places.size_bytes());
    const gpu::ReadableBuffer target(device_, "answers", places.size() * sizeof(glm::vec4));
    probe_.bindBuffers(kPlaces, source, source.bytes());
    probe_.bindBuffers(kAnswers, target.buffer(), target.bytes());
    PushConstants push{};
    push.scene = addressWords(scene_.tableAddress());
    commands_.run("far field probe", [&](VkCommandBuffer recording) {
        probe_.dispatch(recording, &push, std::uint32_t(places.size() + 255) / 256);
        gpu::computeBarrier(recording);
        target.recordReadback(recording);
    });
    instance_.throwIfMessages();
    const auto* answers = static_cast<const glm::vec4*>(target.data());
    return {answers, answers + places.size()};
}

std::vector<glm::uvec2> FarFieldOnDevice::nodes() {
    const gpu::Buffer& source = scene_.farField().nodes();
    const gpu::ReadableBuffer target(device_, "nodes read", source.bytes());
    commands_.run("reading nodes", [&](VkCommandBuffer recording) {
        const VkBufferCopy copy{0, 0, source.bytes()};
        vkCmdCopyBuffer(recording, source.get(), target.buffer().get(), 1, &copy);
        gpu::computeBarrier(recording);
        target.recordReadback(recording);
    });
    instance_.throwIfMessages();
    const auto* nodes = static_cast<const glm::uvec2*>(target.data());
    return {nodes, nodes + nodeCount()};
}

bool isBlurredAt(const FarLayout& layout, const FarFieldSettings& settings, glm::vec3 place) {
    const unsigned blurred = blurredScale(settings.nearRadius, layout.cellSide / float(kBrickSteps));
    const std::optional<unsigned> scale = scaleAt(layout, place);
    return scale && *scale >= blurred;
}

std::vector<glm::dvec3> judgedBakedFluence(const FlatScene& scene, const FarFieldSettings& settings,
                                           const FarLayout& layout,
                                           std::span<const glm::vec3> places, double relative) {
    const float spacing = layout.cellSide / float(kBrickSteps);
    return judged(scene, settings, places, relative, [&](glm::vec3 place, double distance) {
        const bool isBlurred = isBlurredAt(layout, settings, place);
        const float wide = spacing * float(1u << scaleAt(layout, place).value_or(0));
        const double radius = double(splitRadius(settings.nearRadius, wide, isBlurred));
        return double(bakedShare(float(std::pow(distance / radius, 2)), isBlurred));
    });
}

std::vector<glm::dvec3> judgedFluence(const FlatScene& scene, const FarFieldSettings& settings,
                                      std::span<const glm::vec3> places, double relative) {
    return judged(scene, settings, places, relative, [](glm::vec3, double) { return 1.0; });
}

std::vector<glm::vec3> placesInTheAir(const FlatScene& scene, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<glm::vec3> places;
    while (places.size() < count) {
        const MediaBox& box = scene.mediaBoxes[random() % scene.mediaBoxes.size()];
        const auto fraction = [&] { return float(random() % 65536) / 65536.0f; };
        const glm::vec3 at(fraction(), fraction(), fraction());
        const glm::vec3 place = box.lo + at * (box.hi - box.lo);
        if (!isInBuilding(scene, place)) {
            places.push_back(place);
        }
    }
    return places;
}

}  // namespace nightcity
