// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where in a pixel its samples lie: one table for every pixel, made once on the
// host in double precision, so that every method and device traces the same rays.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "settings.h"

namespace nightcity {

// settings.pixelSamples offsets from the pixel's centre, in pixels, x to the right
// and y down: sample i of pixel (x, y) is image position (x + 0.5, y + 0.5) + offset i.
// One sample is the centre. Otherwise the points of a low-discrepancy sequence,
// shifted by the seed and warped by the filter, all of weight 1 / pixelSamples:
// box lies in [-0.5, 0.5) each way, gauss within 1.5 pixels of the centre.
std::vector<glm::vec2> samplePositions(const RenderSettings& settings);

// Index of the offset nearest the centre, the first of equals: the sample that
// depth, normal and ids are taken from. `positions` must not be empty.
std::size_t centreSample(std::span<const glm::vec2> positions);

}  // namespace nightcity
