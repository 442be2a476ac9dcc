// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/reference_renderer.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "reference/exact_integral.h"
#include "reference/march.h"
#include "reference/work_units.h"
#include "sample_positions.h"

namespace nightcity {

namespace {

// A thread's share of the work at a time.
constexpr std::size_t kMarchedPixels = 256;
constexpr std::size_t kExactPixels = 4;

std::unique_ptr<RayIntegrator> makeIntegrator(const FlatScene& scene, int frame,
                                              const RenderSettings& settings) {
    if (settings.tolerance) {
        return std::make_unique<ExactIntegral>(
            scene, frame, settings, judgeAccuracy(*settings.tolerance, scene.windows.size()));
    }
    return std::make_unique<March>(scene, frame, settings);
}

// Light terms computed, and the largest stated errors.
struct PixelCost {
    std::uint64_t lightEvaluations = 0;
    double error = 0;
    double leftOut = 0;

    void add(const PixelCost& other) {
        lightEvaluations += other.lightEvaluations;
        error = std::max(error, other.error);
        leftOut = std::max(leftOut, other.leftOut);
    }
};

class PixelRenderer {
public:
    PixelRenderer(const FlatScene& scene, const RenderProduct& product,
                  const RenderSettings& settings)
        : integrator_(makeIntegrator(scene, product.frame, settings)),
          camera_(scene.camera(product.camera).at(product.frame)),
          product_(product),
          positions_(samplePositions(settings)),
          centre_(centreSample(positions_)) {}

    // Writes entry `index` of the frame.
    PixelCost render(glm::uvec2 pixel, std::size_t index, Frame& frame) const {
        glm::dvec3 glow(0), surface(0);
        double transmittance = 0, alpha = 0;
        PixelCost cost;
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            const glm::dvec2 image = glm::dvec2(pixel) + 0.5 + glm::dvec2(positions_[i]);
            const Ray ray = cameraRay(camera_, product_.cameraOffset, image,
                                      {product_.width, product_.height});
            const RayResult result = integrator_->trace(ray);
            glow += result.glow;
            surface += result.surface.radiance * result.transmittance;
            transmittance += result.transmittance;
            alpha += result.surface.isSky() ? 1 - result.transmittance : 1;
            cost.add({result.lightEvaluations, result.error, result.leftOut});
            if (i == centre_) {
                writeCentre(ray, result, index, frame);
            }
        }
        const double weight = 1.0 / double(positions_.size());
        frame.beauty[index] = glm::vec4((surface + glow) * weight, alpha * weight);
        frame.glow[index] = glm::vec3(glow * weight);
        frame.surface[index] = glm::vec3(surface * weight);
        frame.transmittance[index] = float(transmittance * weight);
        return cost;
    }

private:
    void writeCentre(const Ray& ray, const RayResult& result, std::size_t index,
                     Frame& frame) const {
        frame.mediaId[index] = result.mediaId;
        frame.materialId[index] = result.surface.materialId;
        if (!result.surface.isSky()) {
            const double along = glm::dot(ray.direction, glm::dvec3(camera_.forward));
            frame.depth[index] = float(result.surface.distance * along);
            frame.normal[index] = glm::vec3(result.surface.normal);
        }
    }

    std::unique_ptr<RayIntegrator> integrator_;
    const CameraFrame& camera_;
    const RenderProduct& product_;
    std::vector<glm::vec2> positions_;
    std::size_t centre_;
};

}  // namespace

ReferenceImage renderReference(const FlatScene& scene, const RenderProduct& product,
                               const RenderSettings& settings,
                               const std::function<void(double)>& progress) {
    using Clock = std::chrono::steady_clock;
    const auto milliseconds = [](Clock::duration d) {
        return std::chrono::duration<double, std::milli>(d).count();
    };
    const Clock::time_point start = Clock::now();
    const PixelRenderer renderer(scene, product, settings);
    const Clock::time_point ready = Clock::now();
    ReferenceImage image;
    const bool listed = !product.pixels.empty();
    const RowRange rows = product.rows();
    const std::size_t count =
        listed ? product.pixels.size() : std::size_t{product.width} * rows.count;
    image.frame.resize(listed ? std::uint32_t(count) : product.width, listed ? 1 : rows.count);
    PixelCost cost;
    std::mutex mutex;
    const std::size_t unitPixels = settings.tolerance ? kExactPixels : kMarchedPixels;
    const auto unit = [&](std::size_t index) {
        PixelCost unitCost;
        const std::size_t last = std::min(count, (index + 1) * unitPixels);
        for (std::size_t i = index * unitPixels; i < last; ++i) {
            const glm::uvec2 pixel =
                listed ? product.pixels[i]
                       : glm::uvec2(i % product.width, rows.first + i / product.width);
            unitCost.add(renderer.render(pixel, i, image.frame));
        }
        const std::lock_guard lock(mutex);
        cost.add(unitCost);
    };
    forEachUnit((count + unitPixels - 1) / unitPixels, unit, progress);
    image.statistics.bakeMilliseconds = milliseconds(ready - start);
    image.statistics.frameMilliseconds = milliseconds(Clock::now() - ready);
    image.statistics.passes = {{"reference", image.statistics.frameMilliseconds}};
    image.statistics.lightEvaluations = cost.lightEvaluations;
    image.error = cost.error;
    image.leftOut = cost.leftOut;
    image.statistics.device = "CPU, double precision";
    return image;
}

}  // namespace nightcity
