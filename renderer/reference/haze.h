// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Optical depth between a source and the places of a stretch: the integral of
// extinction over the straight way, through every media box on it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/box_tree.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct HazeBox {
    Bounds bounds;
    double extinction;  // 1/m, above 0
};

// From one source to anywhere on one stretch that it sees.
class SourceDepth {
public:
    // One extinction all the way.
    static SourceDepth uniform(double extinction);
    SourceDepth(glm::dvec3 source, std::vector<HazeBox> boxes, std::vector<double> kinks)
        : source_(source), boxes_(std::move(boxes)), kinks_(std::move(kinks)) {}

    // `distance` is that from the source to the place, m.
    double at(glm::dvec3 place, double distance) const;
    // Fractions of the stretch, rising, inside (0, 1), where the depth may have a kink.
    const std::vector<double>& kinks() const { return kinks_; }
    bool isUniform() const { return uniform_.has_value(); }

private:
    std::optional<double> uniform_;
    glm::dvec3 source_{0};
    std::vector<HazeBox> boxes_;
    std::vector<double> kinks_;
};

// Between anywhere on one pane and anywhere on one stretch.
class HazeBetween {
public:
    // One extinction all the way.
    static HazeBetween uniform(double extinction);
    explicit HazeBetween(std::vector<HazeBox> boxes);

    // `distance` is that between the two, m; 1 gives the mean extinction.
    double depth(glm::dvec3 from, glm::dvec3 to, double distance) const;
    bool isUniform() const { return uniform_; }
    double largestExtinction() const { return largest_; }

private:
    bool uniform_ = false;
    double largest_ = 0;  // 1/m
    std::vector<HazeBox> boxes_;
};

class Haze {
public:
    explicit Haze(std::span<const MediaBox> media);

    // Where one extinction fills the whole triangle between source and stretch the
    // depth is that times the distance; otherwise it has kinks, where the way
    // crosses an edge of a box.
    SourceDepth between(glm::dvec3 source, glm::dvec3 begin, glm::dvec3 end) const;
    // From a source as HullRegion has it.
    HazeBetween between(std::span<const glm::dvec3> source, glm::dvec3 begin,
                        glm::dvec3 end) const;
    // Between two points.
    double depth(glm::dvec3 from, glm::dvec3 to) const;

private:
    std::vector<HazeBox> boxes_;
    BoxTree tree_;
};

}  // namespace nightcity
