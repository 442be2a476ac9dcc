// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The far field on a device of its own, and what the judge says of it.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/commands.h"
#include "gpu/compute_pipeline.h"
#include "gpu/instance.h"
#include "passes/gpu_scene.h"
#include "reference/surface_light.h"

namespace nightcity {

class FarFieldOnDevice {
public:
    explicit FarFieldOnDevice(bool validation);

    // Lays out and bakes, by default the windows that are on at frame 1; a message of the
    // validation fails the call.
    void sync(const FlatScene& scene, const FarFieldSettings& settings);
    void sync(const FlatScene& scene, const FarFieldSettings& settings,
              std::span<const std::uint8_t> windowOn);
    // Bakes another state of the windows, one byte each.
    void setWindows(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                    const BakeProgress& progress = {});
    // W m^-2; -1 where there is no haze near.
    std::vector<glm::vec3> fluence(std::span<const glm::vec3> places);
    // The same, and an estimate of its error.
    std::vector<glm::vec4> fluenceAndError(std::span<const glm::vec3> places);
    // The bits of all nodes.
    std::vector<glm::uvec2> nodes();
    std::uint64_t allocatedBytes() const { return device_.ledger().bytes(); }
    const FarFieldGrid& field() const { return scene_.farField(); }
    std::uint64_t nodeCount() const { return scene_.farField().nodeCount(); }

private:
    gpu::Instance instance_;
    gpu::Device device_;
    gpu::Commands commands_;
    GpuScene scene_;
    FarFieldSettings settings_;
    gpu::ComputePipeline probe_;
};

// Whether the brick about a place holds the near parts too; false where there is none.
bool isBlurredAt(const FarLayout& layout, const FarFieldSettings& settings, glm::vec3 place);
// The same in double precision, by adaptive quadrature over every pane, to `relative`: of all
// fluence what the bricks of a layout hold.
std::vector<glm::dvec3> judgedBakedFluence(const FlatScene& scene, const FarFieldSettings& settings,
                                           const FarLayout& layout,
                                           std::span<const glm::vec3> places, double relative);
// All of the fluence, near and far.
std::vector<glm::dvec3> judgedFluence(const FlatScene& scene, const FarFieldSettings& settings,
                                      std::span<const glm::vec3> places, double relative);

// Places at random inside the media boxes and outside all box buildings; `count` of them.
std::vector<glm::vec3> placesInTheAir(const FlatScene& scene, std::size_t count, unsigned seed);

}  // namespace nightcity
