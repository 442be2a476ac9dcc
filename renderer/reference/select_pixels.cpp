// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <random>
#include <unordered_map>

#include "reference/media_segments.h"
#include "reference/reference_renderer.h"
#include "reference/opaque_surfaces.h"

namespace nightcity {

namespace {

// Draws 0 to count - 1 without repeats: Fisher and Yates' shuffle, of which only
// the entries that moved are kept.
class RandomOrder {
public:
    RandomOrder(std::uint64_t count, std::uint64_t seed) : count_(count), random_(seed) {}

    bool empty() const { return drawn_ == count_; }

    std::uint64_t next() {
        // The bias of the remainder is below count / 2^64.
        const std::uint64_t place = drawn_ + random_() % (count_ - drawn_);
        const std::uint64_t value = at(place);
        moved_[place] = at(drawn_);
        moved_.erase(drawn_++);
        return value;
    }

private:
    std::uint64_t at(std::uint64_t place) const {
        const auto found = moved_.find(place);
        return found == moved_.end() ? place : found->second;
    }

    std::uint64_t count_;
    std::uint64_t drawn_ = 0;
    std::mt19937_64 random_;
    std::unordered_map<std::uint64_t, std::uint64_t> moved_;
};

}  // namespace

std::vector<glm::uvec2> selectPixels(const FlatScene& scene, const RenderProduct& product,
                                     std::size_t count, std::uint64_t seed) {
    const CameraFrame& camera = scene.camera(product.camera).at(product.frame);
    const OpaqueSurfaces surfaces(scene, product.frame);
    const MediaSegments media(scene);
    RandomOrder order(std::uint64_t{product.width} * product.height, seed);
    std::vector<glm::uvec2> pixels;
    while (!order.empty() && pixels.size() < count) {
        const std::uint64_t index = order.next();
        const glm::uvec2 pixel(index % product.width, index / product.width);
        const Ray ray = cameraRay(camera, product.cameraOffset, glm::dvec2(pixel) + 0.5,
                                  {product.width, product.height});
        if (!media.along(ray, surfaces.nearest(ray).distance).empty()) {
            pixels.push_back(pixel);
        }
    }
    std::sort(pixels.begin(), pixels.end(), [](glm::uvec2 a, glm::uvec2 b) {
        return a.y != b.y ? a.y < b.y : a.x < b.x;
    });
    return pixels;
}

}  // namespace nightcity
