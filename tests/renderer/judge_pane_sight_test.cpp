// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a ray sees of a pane, against asking points one by one; and the light of what
// is seen, against summing small pieces.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "judge_setup.h"
#include "reference/pane_fluence.h"
#include "reference/pane_sight.h"

namespace nightcity {
namespace {

LitWindow pane() {
    LitWindow window{};
    window.halfU = {-0.6, 0, 0};
    window.halfV = {0, 0, 0.75};
    window.normal = {0, 1, 0};
    window.power = glm::dvec3(50);
    window.reach = std::hypot(0.6, 0.75);
    return window;
}

using Face = std::vector<glm::dvec3>;

// A rectangle about a place, turned at random.
Face rectangle(std::mt19937& random, glm::dvec3 place, double size) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const glm::dvec3 a = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
    const glm::dvec3 b =
        glm::normalize(glm::cross(a, glm::dvec3(unit(random), unit(random), unit(random))));
    const glm::dvec3 u = size * (0.2 + std::abs(unit(random))) * a;
    const glm::dvec3 v = size * (0.2 + std::abs(unit(random))) * b;
    return {place - u - v, place + u - v, place + u + v, place - u + v};
}

// Whether the way between two points crosses a rectangle, by its own coordinates.
bool crosses(const Face& face, glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 u = face[1] - face[0], v = face[3] - face[0], normal = glm::cross(u, v);
    const double part = glm::dot(face[0] - from, normal) / glm::dot(to - from, normal);
    const glm::dvec3 at = from + part * (to - from) - face[0];
    const double a = glm::dot(at, u) / glm::dot(u, u), b = glm::dot(at, v) / glm::dot(v, v);
    return part > 0 && part < 1 && a > 0 && a < 1 && b > 0 && b < 1;
}

bool isInside(std::span<const glm::dvec2> polygon, glm::dvec2 point) {
    int left = 0, right = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double turn = (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
        left += turn > 0;
        right += turn < 0;
    }
    return left == 0 || right == 0;
}

struct Agreement {
    int points = 0, seen = 0, wrong = 0;
};

// Asks points of the pane from places of the ray.
void compare(const std::vector<Face>& faces, const PaneSight& sight, const Ray& ray,
             const RayPart& part, std::mt19937& random, Agreement& result) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const LitWindow window = pane();
    for (int i = 0; i < 12; ++i) {
        const double t = part.begin + (i + 0.5) / 12 * (part.end - part.begin);
        const bool open = std::any_of(sight.open().begin(), sight.open().end(), [&](RayPart p) {
            return t >= p.begin && t <= p.end;
        });
        PanePolygons seen;
        if (open) {
            sight.seenFrom(t, seen);
        }
        for (int k = 0; k < 30; ++k) {
            const glm::dvec2 uv(unit(random), unit(random));
            const bool visible = std::none_of(faces.begin(), faces.end(), [&](const Face& face) {
                return crosses(face, window.at(uv), ray.at(t));
            });
            int found = 0;
            for (std::size_t p = 0; p < seen.size(); ++p) {
                found += isInside(seen[p], uv);
            }
            ++result.points;
            result.seen += visible;
            result.wrong += found != int(visible);  // two pieces would count it twice
        }
    }
}

TEST(JudgePaneSight, PolygonsAreWhatPointsSee) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-1, 1);
    const LitWindow window = pane();
    Agreement result;
    for (int scene = 0; scene < 150; ++scene) {
        std::vector<Face> faces;
        Hiders hiders;
        for (int i = 0; i < 1 + scene % 12; ++i) {  // some cross the pane, some the ray
            faces.push_back(rectangle(
                random, {2 * unit(random), 3 + 3.5 * unit(random), 2 * unit(random)}, 1.5));
            hiders.addHiding(faces.back(), window, Emitter::pane);
        }
        const Ray ray = through({-6, 5 + 4 * unit(random), 3 * unit(random)},
                                {6, 5 + 4 * unit(random), 3 * unit(random)});
        const RayPart part{0, 12};
        const PaneSight sight(window, hiders, std::nullopt, ray, part);
        compare(faces, sight, ray, part, random, result);
    }
    EXPECT_EQ(result.wrong, 0);
    EXPECT_GT(result.seen, result.points / 4);
    EXPECT_LT(result.seen, 4 * result.points / 5);
}

TEST(JudgePaneSight, GroundCutsThePane) {
    const Ray ray = through({-5, 4, 2}, {5, 4, 2});
    const LitWindow window = pane();
    const PaneSight sight(window, {}, 0.25, ray, {0, 10});
    PanePolygons seen;
    sight.seenFrom(3, seen);
    ASSERT_EQ(seen.size(), 1u);
    for (const glm::dvec2 corner : seen[0]) {
        EXPECT_GE(window.at(corner).z, 0.25 - 1e-12);
    }
    EXPECT_TRUE(PaneSight(window, {}, 1.0, ray, {0, 10}).open().empty());
}

// Many small squares at their middles.
double summed(const LitWindow& window, glm::dvec3 eye, const HazeBetween& haze) {
    constexpr int kSide = 400;
    const double area = 4 * glm::length(glm::cross(window.halfU, window.halfV)) / (kSide * kSide);
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const glm::dvec3 place = window.at({(2 * (i % kSide) + 1.0) / kSide - 1,
                                            (2 * (i / kSide) + 1.0) / kSide - 1});
        const double d = glm::length(eye - place);
        sum += std::exp(-haze.depth(eye, place, d)) * glm::dot(window.normal, eye - place) /
               (d * d * d);
    }
    return sum * area;
}

TEST(JudgePaneSight, HazeDimsTheSolidAngleToWhatIsAsked) {
    const LitWindow window = pane();
    PanePolygons whole;
    whole.add(std::array<glm::dvec2, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}});
    const HazeBetween layers({{{{-9, -9, -9}, {9, 9, 0.2}}, 0.3}, {{{-9, -9, 0.2}, {9, 9, 9}}, 0.1}});
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const double relative : {1e-3, 1e-5}) {
        for (int i = 0; i < 12; ++i) {
            const glm::dvec3 eye(4 * unit(random), 0.4 + 3 * std::abs(unit(random)),
                                 2 * unit(random));
            for (const double extinction : {0.02, 1.0}) {
                const HazeBetween haze = HazeBetween::uniform(extinction);
                const Estimate found = dimmedSolidAngle(window, whole, eye, haze, relative);
                EXPECT_NEAR(found.value / summed(window, eye, haze), 1, relative + 2e-6);
                EXPECT_LE(found.error, relative * found.value);
            }
            const Estimate found = dimmedSolidAngle(window, whole, eye, layers, relative);
            EXPECT_NEAR(found.value / summed(window, eye, layers), 1, 1e-2);  // a kink in it
        }
    }
}

}  // namespace
}  // namespace nightcity
