// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace nightcity {
namespace {

constexpr double kSame = 2e-3;  // m: borders so near to a plane lie on it
constexpr double kLeastShare = 0.8;
constexpr std::size_t kMostGaps = 32;

struct Border {
    double place;  // m
    double count;  // of faces of media
};

using Borders = std::vector<Border>;  // ascending

Borders bordersAlong(std::span<const MediaBox> media, int axis) {
    std::vector<double> places;
    for (const MediaBox& box : media) {
        if (box.extinction > 0) {
            places.push_back(box.lo[axis]);
            places.push_back(box.hi[axis]);
        }
    }
    std::sort(places.begin(), places.end());
    Borders borders;
    for (const double place : places) {
        if (!borders.empty() && place - borders.back().place < kSame) {
            ++borders.back().count;
        } else {
            borders.push_back({place, 1});
        }
    }
    return borders;
}

// The most frequent distances between neighbours, at least `least`.
std::vector<double> commonGaps(const std::array<Borders, 3>& axes, double least) {
    std::map<long, std::pair<double, double>> found;  // in kSame: how often, and the largest
    for (const Borders& borders : axes) {
        for (std::size_t i = 1; i < borders.size(); ++i) {
            const double gap = borders[i].place - borders[i - 1].place;
            if (gap >= least) {
                auto& [count, largest] = found[std::lround(gap / kSame)];
                count += std::min(borders[i - 1].count, borders[i].count);
                largest = std::max(largest, gap);
            }
        }
    }
    std::vector<std::pair<double, double>> gaps;
    for (const auto& [key, gap] : found) {
        gaps.push_back(gap);
    }
    const std::size_t kept = std::min(gaps.size(), kMostGaps);
    std::partial_sort(gaps.begin(), gaps.begin() + std::ptrdiff_t(kept), gaps.end(),
                      [](const auto& a, const auto& b) { return a > b; });
    std::vector<double> common;
    for (std::size_t i = 0; i < kept; ++i) {
        common.push_back(gaps[i].second);
    }
    return common;
}

// How far above a multiple of the spacing from the first border the most of them lie, and how
// many these are.
struct Offset {
    double place = 0;
    double count = 0;
};

Offset bestOffset(const Borders& borders, double spacing) {
    std::vector<Offset> rest;
    for (const Border& border : borders) {
        const double from = border.place - borders.front().place;
        const double above = from - spacing * std::floor(from / spacing + kSame / spacing);
        rest.push_back({above, border.count});
    }
    std::sort(rest.begin(), rest.end(),
              [](const Offset& a, const Offset& b) { return a.place < b.place; });
    Offset best;
    double count = 0;
    for (std::size_t first = 0, end = 0; first < rest.size(); ++first) {
        for (; end < rest.size() && rest[end].place - rest[first].place < kSame; ++end) {
            count += rest[end].count;
        }
        if (count > best.count) {
            best = {rest[first].place, count};
        }
        count -= rest[first].count;
    }
    return best;
}

double countOnPlanes(const std::array<Borders, 3>& axes, double spacing) {
    double count = 0;
    for (const Borders& borders : axes) {
        count += bestOffset(borders, spacing).count;
    }
    return count;
}

}  // namespace

LatticeAlignment alignLattice(std::span<const MediaBox> media, float wanted, Emitter emitter) {
    const std::array<Borders, 3> axes{bordersAlong(media, 0), bordersAlong(media, 1),
                                      bordersAlong(media, 2)};
    LatticeAlignment result{wanted, vec3(0)};
    if (axes[0].empty()) {
        return result;
    }
    double spacing = wanted;
    double most = countOnPlanes(axes, spacing);
    for (const double gap : commonGaps(axes, kLeastShare * double(wanted))) {
        for (double parts = std::ceil(gap / double(wanted) - 1e-6);
             gap / parts >= kLeastShare * double(wanted); ++parts) {
            const double count = countOnPlanes(axes, gap / parts);
            if (count > most || (count == most && gap / parts > spacing)) {
                most = count;
                spacing = gap / parts;
            }
        }
    }
    result.spacing = float(spacing);
    for (int axis = 0; axis < 3; ++axis) {
        const double above = bestOffset(axes[axis], spacing).place;
        const double below = (above > kSame ? spacing - above : 0) +
                             (emitter == Emitter::isotropic ? 0.5 * spacing : 0);
        result.origin[axis] = float(axes[axis].front().place - below);
    }
    return result;
}

}  // namespace nightcity
