// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_cut.h"

#include <cmath>

#include "transport/near_far_split.h"

namespace nightcity {
namespace {

// The device's distances are floats: lights are opened from this little farther away. Share, m.
constexpr double kSlack = 1e-3;

double distance(glm::dvec3 point, const Bounds& bounds) {
    return glm::length(glm::max(glm::max(bounds.lo - point, point - bounds.hi), glm::dvec3(0)));
}

}  // namespace

FarCut::FarCut(const FarLayout& layout, const FarJoining& joining)
    : joining_(joining), cellSide_(layout.cellSide) {
    std::vector<std::vector<Bounds>> bounds(kBrickScales);
    for (const FarBrick& brick : layout.bricks) {
        const glm::dvec3 lo = glm::dvec3(layout.origin) + cellSide_ * glm::dvec3(brick.cell);
        bounds[brick.scale].push_back({lo, lo + cellSide_ * double(1u << brick.scale)});
    }
    for (std::vector<Bounds>& ofScale : bounds) {
        bricks_.emplace_back(std::move(ofScale));
    }
}

// m, as far_bake.glsl has it.
double FarCut::splitRadius(unsigned scale) const {
    const float spacing = float(cellSide_) / float(kBrickSteps);
    return nightcity::splitRadius(joining_.nearRadius, spacing * float(1u << scale),
                                  scale >= blurredScale(joining_.nearRadius, spacing));
}

// m: bricks of the scale take a light of that reach as one from this far away on; below 0: all do.
double FarCut::closedFrom(double reach, unsigned scale) const {
    const double half = 0.5 * cellSide_ * double(1u << scale);
    const double radius = splitRadius(scale);
    const double spread = joining_.spread;
    if (scale >= kJoinedScale && spread > 0 && reach * double(kJoinedReach) <= half) {
        return -1;
    }
    const auto isClosed = [&](double gap) {
        const double growth =
            std::max(1.0, gap / (double(kFullSpread) * joining_.nearRadius)) * double(1u << 2 * scale);
        const double here = std::min(spread * growth, std::max(spread, double(kLargestSpread)));
        const bool isFar = reach <= here * gap && gap >= radius + reach;
        return isFar && (scale > 0 || std::sqrt(3.0) * half <= here * gap);
    };
    double far = 1;
    while (!isClosed(far)) {
        far *= 2;
        if (far > 1e9) {
            return INFINITY;
        }
    }
    double near = 0;
    while (far - near > kSlack * far) {
        const double middle = 0.5 * (near + far);
        (isClosed(middle) ? far : near) = middle;
    }
    return far;
}

bool FarCut::mayOpen(const FarLight& light) const {
    if (joining_.spread <= 0 ||
        (light.coneCos < kClusterCos + float(kSlack) && joining_.emitter != Emitter::isotropic)) {
        return true;
    }
    const glm::dvec3 centre(light.centre);
    const double reach = glm::length(glm::dvec3(light.reach)) * (1 + kSlack);
    for (unsigned scale = 0; scale < kBrickScales; ++scale) {
        const double from = closedFrom(reach, scale) * (1 + kSlack) + kSlack;
        bool found = false;
        bricks_[scale].visitWhere(
            [&](const Bounds& bounds) { return !found && distance(centre, bounds) <= from; },
            [&](std::uint32_t) { found = true; });
        if (found) {
            return true;
        }
    }
    return false;
}

}  // namespace nightcity
