// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The baked far field against the judge, at points: what a node cell makes of the fluence,
// walls, media, states of the windows.
#include <algorithm>
#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "errors.h"
#include "far_field_device.h"
#include "passes/far_media.h"
#include "scene_builder.h"

namespace nightcity {
namespace {

// Of the test program: a device takes long to open.
FarFieldOnDevice& device() {
    static FarFieldOnDevice onDevice(true);
    return onDevice;
}

FarFieldSettings spaced(float spacing) {
    FarFieldSettings settings;
    settings.spacing = spacing;
    settings.nearRadius = 4 * spacing;
    return settings;
}

// From 0.7 m on beside a corner of the paper's smallest city.
FarFieldSettings ofScales() {
    FarFieldSettings settings = spaced(0.7f);
    settings.nearRadius = 4;
    settings.eyes = {{-14, -14, 2}};
    settings.mostBricks = 100;
    return settings;
}

// Of the far part, over all of the fluence or 1 % of its median.
struct Errors {
    double p50 = 0, p95 = 0, bias = 0;
    double exceeded = 0;  // share of places where the error is larger than its estimate
    double caution = 0;   // median of the estimate over that of the error
};

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.at(std::size_t(share * double(values.size() - 1)));
}

Errors errorsAt(const FlatScene& scene, const FarFieldSettings& settings,
                const std::vector<glm::vec3>& places) {
    const std::vector<glm::vec4> found = device().fluenceAndError(places);
    const std::vector<glm::dvec3> far = judgedBakedFluence(
        scene, settings, device().field().layout(), places, 1e-3);
    const std::vector<glm::dvec3> all = judgedFluence(scene, settings, places, 1e-3);
    std::vector<double> total, errors;
    for (const glm::dvec3& value : all) {
        total.push_back(value.y);
    }
    const double floor = 0.01 * quantile(total, 0.5);
    Errors result;
    std::vector<double> absolute, estimates;
    double sum = 0, truth = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double error = double(found[i].y) - far[i].y;
        errors.push_back(std::abs(error) / std::max(floor, all[i].y));
        absolute.push_back(std::abs(error));
        estimates.push_back(double(found[i].w));
        result.exceeded += absolute[i] > estimates[i] ? 1.0 / double(places.size()) : 0;
        sum += error;
        truth += all[i].y;
    }
    result.p50 = quantile(errors, 0.5);
    result.p95 = quantile(errors, 0.95);
    result.bias = sum / truth;
    result.caution = quantile(estimates, 0.5) / quantile(absolute, 0.5);
    return result;
}

Errors bakeAndCompare(const FlatScene& scene, const FarFieldSettings& settings,
                      std::size_t places = 200) {
    device().sync(scene, settings);
    return errorsAt(scene, settings, placesInTheAir(scene, places, 3));
}

// The same, at nodes in the air and on walls: no interpolation is in the way.
Errors bakeAndCompareNodes(const FlatScene& scene, FarFieldSettings settings) {
    settings.keepMean = false;
    std::vector<glm::vec3> places = placesInTheAir(scene, 200, 3);
    const LatticeAlignment nodes = alignLattice(scene.mediaBoxes, settings.spacing, settings.emitter);
    for (glm::vec3& place : places) {
        const glm::vec3 node = glm::round((place - nodes.origin) / nodes.spacing);
        // A hair's breadth towards the place: that side of a wall is meant.
        const glm::vec3 at = nodes.origin + node * nodes.spacing;
        place = at + 1e-4f * glm::sign(place - at);
    }
    device().sync(scene, settings);
    return errorsAt(scene, settings, places);
}

struct Case {
    Emitter emitter;
    double p95;  // of what interpolation leaves: point sources have hard shadow edges
    double exceeded;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << (c.emitter == Emitter::isotropic    ? "isotropic"
             : c.emitter == Emitter::lambertian ? "lambertian"
                                                : "pane");
}

class FarFieldEmitters : public testing::TestWithParam<Case> {
protected:
    FarFieldEmitters() { settings_.emitter = GetParam().emitter; }

    FlatScene scene_ = paperCity(1).load();
    FarFieldSettings settings_ = spaced(0.5f);
};

// For point emitters nothing is left but rounding.
TEST_P(FarFieldEmitters, AreExactAtTheNodes) {
    const Errors errors = bakeAndCompareNodes(scene_, settings_);
    const bool pane = GetParam().emitter == Emitter::pane;
    EXPECT_LT(errors.p50, pane ? 5e-4 : 3e-4);
    EXPECT_LT(errors.p95, pane ? 5e-3 : 6e-4);
    EXPECT_LT(std::abs(errors.bias), pane ? 1e-3 : 3e-4);
}

TEST_P(FarFieldEmitters, AgreeWithTheJudge) {
    const Errors errors = bakeAndCompare(scene_, settings_);
    EXPECT_LT(errors.p50, 0.003);
    EXPECT_LT(errors.p95, GetParam().p95);
    EXPECT_LT(std::abs(errors.bias), 0.005);
    EXPECT_LT(errors.exceeded, GetParam().exceeded);
    EXPECT_LT(errors.caution, 12);  // this city is smooth; 6 in the paper's of 4 x 4
}

INSTANTIATE_TEST_SUITE_P(Models, FarFieldEmitters,
                         testing::Values(Case{Emitter::pane, 0.02, 0.02},
                                         Case{Emitter::lambertian, 0.05, 0.02},
                                         Case{Emitter::isotropic, 0.06, 0.02}));

// Away from the plane of the panes, where their light has a kink.
TEST(FarField, HalfTheSpacingIsAQuarterOfTheErrorInTheOpen) {
    SceneBuilder city;
    city.addMaterial(vec3(0.5f));
    for (int i = 0; i < 5; ++i) {
        city.addWindow({4 * float(i) - 8, 0, 10}, {-0.6f, 0, 0}, {0, 0, 0.75f}, 50, vec3(1), false);
    }
    city.addMediaBox({-20, 3, 0}, {20, 40, 30}, 0.02f, 0.9f, {0, 1, 2, 3, 4});
    city.addCamera("camera", {0, -90, 30}, {0, 0, 0}, 40);
    const FlatScene scene = city.load();
    FarFieldSettings coarse = spaced(2), fine = spaced(1);
    coarse.nearRadius = fine.nearRadius = 8;
    const Errors before = bakeAndCompare(scene, coarse), after = bakeAndCompare(scene, fine);
    EXPECT_LT(after.p50, 0.35 * before.p50);
    EXPECT_LT(after.p95, 0.35 * before.p95);
}

// Four walls of 4 m about a yard of 12 x 12 m, windows on their outsides only.
SceneBuilder courtyard() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.ground = GroundPlane{0, wall};
    city.addBoxBuilding({-10, -10, 0}, {10, -6, 30}, wall);
    city.addWindow({0, -10.01f, 8}, {0.6f, 0, 0}, {0, 0, 0.75f});
    city.addBoxBuilding({-10, 6, 0}, {10, 10, 30}, wall);
    city.addWindow({0, 10.01f, 8}, {-0.6f, 0, 0}, {0, 0, 0.75f});
    city.addBoxBuilding({-10, -6, 0}, {-6, 6, 30}, wall);
    city.addWindow({-10.01f, 0, 8}, {0, -0.6f, 0}, {0, 0, 0.75f});
    city.addBoxBuilding({6, -6, 0}, {10, 6, 30}, wall);
    city.addWindow({10.01f, 0, 8}, {0, 0.6f, 0}, {0, 0, 0.75f});
    city.addMediaBox({-30, -30, 0}, {30, -10, 30}, 0.02f, 0.9f, {0});
    city.addMediaBox({-30, 10, 0}, {30, 30, 30}, 0.02f, 0.9f, {1});
    city.addMediaBox({-6, -6, 0}, {6, 6, 30}, 0.02f, 0.9f);
    city.addCamera("camera", {0, -90, 30}, {0, 0, 0}, 40);
    return city;
}

TEST(FarField, IsZeroInACourtyardClosedByWalls) {
    const FlatScene scene = courtyard().load();
    device().sync(scene, spaced(0.7f));
    std::vector<glm::vec3> inside, outside;
    for (int i = 0; i < 200; ++i) {
        const float x = -5.999f + 11.998f * float(i % 15) / 14;
        const float y = -5.999f + 11.998f * float(i / 15) / 14;
        inside.emplace_back(x, y, 0.01f + 29.9f * float(i) / 199);
        outside.emplace_back(2 * x, -10.02f - float(i % 7), 8);
    }
    for (const glm::vec3& value : device().fluence(inside)) {
        EXPECT_EQ(value, glm::vec3(0));
    }
    for (const glm::vec3& value : device().fluence(outside)) {
        EXPECT_GT(value.y, 0);
    }
}

class FarFieldStates : public testing::Test {
protected:
    // With clusters of windows.
    FarFieldStates() : scene_(paperCity(1).load()) { settings_.spread = 0.5f; }

    std::vector<glm::uvec2> bakedAfresh(const std::vector<std::uint8_t>& on) {
        device().sync(scene_, settings_);  // of all windows
        FarFieldSettings other = settings_;
        other.spacing = 3;  // forgets
        device().sync(scene_, other);
        device().sync(scene_, settings_, on);
        return device().nodes();
    }

    FlatScene scene_;
    FarFieldSettings settings_ = spaced(1);
};

TEST_F(FarFieldStates, AToggledStateEqualsAFreshBakeToTheBit) {
    std::vector<std::uint8_t> some(scene_.windows.size(), 0), none = some, most = some;
    for (std::size_t i = 0; i < some.size(); ++i) {
        some[i] = i % 3 == 0;
        most[i] = i % 7 != 0;
    }
    const auto freshSome = bakedAfresh(some), freshMost = bakedAfresh(most);
    EXPECT_NE(freshSome, freshMost);
    device().setWindows(scene_, some);
    EXPECT_EQ(device().nodes(), freshSome);
    device().setWindows(scene_, none);
    for (const glm::uvec2& node : device().nodes()) {
        ASSERT_EQ(node, glm::uvec2(0));
    }
    device().setWindows(scene_, most);
    EXPECT_EQ(device().nodes(), freshMost);
}

// Two windows of equal power, one on and one off, change places: the sums of the tree above
// them stay the same.
TEST_F(FarFieldStates, ABakeThatIsEndedLeavesNothingBehind) {
    std::vector<std::uint8_t> some(scene_.windows.size(), 1);
    some[5] = 0;
    const auto fresh = bakedAfresh(some);
    struct Ended {};
    some[40] = 0;
    const auto end = [](double) { throw Ended{}; };
    EXPECT_THROW(device().setWindows(scene_, some, end), Ended);
    some[40] = 1;
    double done = 0;
    device().setWindows(scene_, some, [&](double share) {
        EXPECT_GT(share, done);
        done = share;
    });
    EXPECT_EQ(done, 1);
    EXPECT_EQ(device().nodes(), fresh);
}

TEST_F(FarFieldStates, TheSameWithBricksOfSeveralScales) {
    settings_ = ofScales();
    std::vector<std::uint8_t> some(scene_.windows.size(), 1), most = some;
    for (std::size_t i = 0; i < some.size(); ++i) {
        some[i] = i % 3 == 0;
        most[i] = i % 50 != 0;
    }
    const auto fresh = bakedAfresh(most);
    device().setWindows(scene_, some);
    EXPECT_NE(device().nodes(), fresh);
    device().setWindows(scene_, most);
    EXPECT_EQ(device().nodes(), fresh);
}

TEST_F(FarFieldStates, ASwapOfTwoWindowsIsSeen) {
    std::vector<std::uint8_t> one(scene_.windows.size(), 0), other = one;
    one[0] = other[3] = 1;
    const auto fresh = bakedAfresh(other);
    device().setWindows(scene_, one);
    device().setWindows(scene_, other);
    EXPECT_EQ(device().nodes(), fresh);
}

TEST_F(FarFieldStates, TheOrderOfTheWindowsDoesNotMatter) {
    SceneBuilder city = paperCity(1);
    std::reverse(city.windows.begin(), city.windows.end());
    for (MediaBox& box : city.mediaBoxes) {
        box.firstLight = box.lightCount = 0;
    }
    city.lightList.clear();
    device().sync(scene_, settings_);
    const auto nodes = device().nodes();
    device().sync(city.load(), settings_);
    EXPECT_EQ(device().nodes(), nodes);
}

// Sums over places of what single windows and clusters of them bring.
void expectClustersToKeepTheLight(Emitter emitter) {
    const FlatScene scene = paperCity(2).load();
    const std::vector<glm::vec3> places = placesInTheAir(scene, 2000, 6);
    FarFieldSettings settings = spaced(1);
    settings.emitter = emitter;
    const auto sumOf = [&](float spread) {
        settings.spread = spread;
        device().sync(scene, settings);
        glm::dvec3 sum(0);
        for (const glm::vec3& value : device().fluence(places)) {
            sum += glm::dvec3(value);
        }
        return sum;
    };
    const glm::dvec3 each = sumOf(0), clusters = sumOf(0.3f);
    EXPECT_NE(each, clusters);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(clusters[channel] / each[channel], 1, 0.01);
    }
}

TEST(FarField, ClustersKeepTheLight) {
    expectClustersToKeepTheLight(Emitter::pane);
}

TEST(FarField, ClustersOfIsotropicWindowsKeepTheLight) {
    expectClustersToKeepTheLight(Emitter::isotropic);
}

TEST(FarField, IntegratesThroughDifferentMedia) {
    SceneBuilder city = paperCity(1);
    for (std::size_t i = 0; i < city.mediaBoxes.size(); i += 2) {
        city.mediaBoxes[i].extinction = 0.05f;
    }
    const Errors errors = bakeAndCompareNodes(city.load(), spaced(0.5f));
    EXPECT_LT(errors.p50, 5e-4);
    EXPECT_LT(errors.p95, 5e-3);
}

// A roof of triangles that no axis knows, a wall that is turned.
SceneBuilder meshTown() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.ground = GroundPlane{0, wall};
    const vec3 base[4] = {{-6, -3, 0}, {4, -6, 0}, {7, 4, 0}, {-3, 7, 0}};
    for (const float z : {0.0f, 9.0f}) {
        for (const vec3 corner : base) {
            city.positions.push_back(corner + vec3(0, 0, z));
        }
    }
    city.positions.push_back({0.5f, 0.5f, 14});
    for (uint i = 0; i < 4; ++i) {
        const uint next = (i + 1) % 4;
        city.triangles.push_back({{i, next, next + 4}, wall});
        city.triangles.push_back({{i, next + 4, i + 4}, wall});
        city.triangles.push_back({{i + 4, next + 4, 8}, wall});
    }
    city.triangles.push_back({{0, 3, 2}, wall});
    city.triangles.push_back({{0, 2, 1}, wall});
    city.buildings.push_back({0, 14, 0, 0, 1});
    const vec3 along = glm::normalize(base[1] - base[0]), out(along.y, -along.x, 0);
    city.addWindow(0.5f * (base[0] + base[1]) + 0.01f * out + vec3(0, 0, 5), 0.6f * along,
                   {0, 0, 0.75f});
    city.addBoxBuilding({-8, -20, 0}, {8, -14, 12}, wall);
    city.addWindow({0, -13.99f, 6}, {-0.6f, 0, 0}, {0, 0, 0.75f});
    city.addMediaBox({-20, -25, 0}, {20, 15, 20}, 0.02f, 0.9f, {0, 1});
    city.addCamera("camera", {0, -90, 30}, {0, 0, 0}, 40);
    return city;
}

TEST(FarField, KnowsMeshBuildings) {
    FarFieldSettings settings = spaced(0.5f);
    settings.emitter = Emitter::lambertian;
    const Errors errors = bakeAndCompareNodes(meshTown().load(), settings);
    EXPECT_LT(errors.p50, 3e-4);
    EXPECT_LT(errors.p95, 6e-4);
}

// Five windows 60 m from a street's haze, with more posts before them than an entry lists faces of,
// and a long low wall: haze near the ground is dark, above it sees the light past the posts.
SceneBuilder behindPosts() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.ground = GroundPlane{0, wall};
    for (int i = 0; i < 5; ++i) {
        city.addWindow({3 * float(i) - 6, -60, 6}, {-0.6f, 0, 0}, {0, 0, 0.75f}, 50, vec3(1), false);
    }
    for (int i = 0; i < 40; ++i) {
        const float x = 0.5f * float(i) - 10;
        const float y = i % 2 == 0 ? -12.0f : -30.0f;
        city.addBoxBuilding({x, y, 0}, {x + 0.25f, y + 0.25f, 9}, wall);
    }
    city.addBoxBuilding({-30, -5, 0}, {30, -4, 2}, wall);
    city.addMediaBox({-4, 0, 0}, {4, 8, 8}, 0.02f, 0.9f, {0, 1, 2, 3, 4});
    city.addCamera("camera", {0, -90, 30}, {0, 0, 0}, 40);
    return city;
}

// Sight is that from a mesh there, asked in two rounds: neither the second nor what it leaves out may
// be missing, and places asked first must not all look at one part of a window.
TEST(FarField, ManyFacesHideNoMoreThanTheyDo) {
    FarFieldSettings settings = spaced(0.5f);
    settings.spread = 0;
    const Errors errors = bakeAndCompare(behindPosts().load(), settings);
    EXPECT_LT(errors.p50, 0.18);  // shadows are narrower than a brick's nodes are apart
    EXPECT_LT(std::abs(errors.bias), 0.1);
}

TEST(FarField, IsTheSameTenKilometresAway) {
    SceneBuilder near = meshTown(), away = near;
    const vec3 offset(10240, -10240, 0);
    const auto move = [&](vec3& place) { place += offset; };
    std::for_each(away.positions.begin(), away.positions.end(), move);
    for (Window& window : away.windows) {
        move(window.centre);
    }
    for (MediaBox& box : away.mediaBoxes) {
        move(box.lo);
        move(box.hi);
    }
    const FlatScene here = near.load();
    std::vector<glm::vec3> places = placesInTheAir(here, 200, 4);
    device().sync(here, spaced(1));
    const std::vector<glm::vec3> expected = device().fluence(places);
    device().sync(away.load(), spaced(1));
    std::for_each(places.begin(), places.end(), move);
    const std::vector<glm::vec3> found = device().fluence(places);
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        difference += std::abs(double(found[i].y) - double(expected[i].y));
        sum += double(expected[i].y);
    }
    EXPECT_LT(difference, 1e-3 * sum);
}

TEST(FarField, BricksOfSeveralScalesAgreeWithTheJudge) {
    const FlatScene scene = paperCity(1).load();
    const Errors errors = bakeAndCompare(scene, ofScales());
    const std::uint64_t bricks = device().field().brickCount();
    EXPECT_LE(bricks, 100u);
    EXPECT_LT(errors.p50, 0.03);
    EXPECT_LT(errors.p95, 0.25);
    EXPECT_LT(std::abs(errors.bias), 0.03);
}

// Where nodes are too far apart for near parts, they hold them blurred (near_window_test.cpp has what
// the blur keeps): in the mean interpolation and sight lose nothing.
TEST(FarField, BricksFarAwayHoldAllOfTheLightInTheMean) {
    const FlatScene scene = paperCity(1).load();
    FarFieldSettings settings = ofScales();
    settings.nearRadius = 0.9f;
    settings.mostBricks = 20;
    device().sync(scene, settings);
    std::vector<glm::vec3> far;
    for (const glm::vec3 place : placesInTheAir(scene, 2000, 7)) {
        if (isBlurredAt(device().field().layout(), settings, place)) {
            far.push_back(place);
        }
    }
    ASSERT_GT(far.size(), 1000u);
    const std::vector<glm::vec3> found = device().fluence(far);
    const std::vector<glm::dvec3> all =
        judgedBakedFluence(scene, settings, device().field().layout(), far, 1e-3);
    double sum = 0, truth = 0;
    for (std::size_t i = 0; i < far.size(); ++i) {
        sum += double(found[i].y);
        truth += all[i].y;
    }
    EXPECT_NEAR(sum / truth, 1, 0.03);
}

TEST(FarField, RefusesWhatDoesNotFitItsMemory) {
    FarFieldSettings settings = spaced(0.05f);
    settings.memoryBytes = 100'000'000;
    try {
        device().sync(paperCity(1).load(), settings);
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("far field takes"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("100 MB"), std::string::npos);
    }
}

TEST(FarField, IsDarkWithoutWindowsAndAbsentWithoutMedia) {
    SceneBuilder dark = paperCity(1);
    for (Window& window : dark.windows) {
        window.power = 0;
    }
    device().sync(dark.load(), spaced(2));
    const std::vector<glm::vec3> places{{0, -12, 5}, {12, 3, 20}};
    for (const glm::vec3& value : device().fluence(places)) {
        EXPECT_EQ(value, glm::vec3(0));
    }
    SceneBuilder clear = paperCity(1);
    clear.mediaBoxes.clear();
    clear.lightList.clear();
    device().sync(clear.load(), spaced(2));
    for (const glm::vec3& value : device().fluence(places)) {
        EXPECT_EQ(value, glm::vec3(-1));
    }
}

std::vector<MediaBox> boxesBetween(const std::vector<float>& borders) {
    std::vector<MediaBox> boxes;
    for (std::size_t i = 1; i < borders.size(); ++i) {
        MediaBox box{};
        box.lo = {borders[i - 1], borders[0], 0};
        box.hi = {borders[i], borders.back(), 30};
        box.extinction = 0.01f;
        boxes.push_back(box);
    }
    return boxes;
}

double offPlanes(const LatticeAlignment& nodes, int axis, float place) {
    const double steps = (double(place) - double(nodes.origin[axis])) / double(nodes.spacing);
    return std::abs(steps - std::round(steps)) * double(nodes.spacing);
}

TEST(LatticeAlignment, PutsTheWallsOfAStreetGridOnNodePlanes) {
    const std::vector<float> borders{-45, -35, -25, -15, -5, 5, 15};
    const LatticeAlignment nodes = alignLattice(boxesBetween(borders), 0.72f, Emitter::pane);
    EXPECT_FLOAT_EQ(nodes.spacing, 10.0f / 14);
    for (const float border : borders) {
        EXPECT_LT(offPlanes(nodes, 0, border), 1e-4);
    }
    EXPECT_LT(offPlanes(nodes, 2, 30), 1e-4);
    EXPECT_LE(nodes.origin.x, -45);
    EXPECT_GT(nodes.origin.x, -45 - nodes.spacing);
    const LatticeAlignment between = alignLattice(boxesBetween(borders), 0.72f, Emitter::isotropic);
    EXPECT_NEAR(offPlanes(between, 0, -25), 0.5 * double(between.spacing), 1e-4);
}

TEST(LatticeAlignment, ServesMostBordersWhereNotAllCan) {
    std::vector<float> borders{0.137f};
    for (int i = 0; i < 20; ++i) {
        borders.push_back(10 + 6 * float(i));
    }
    const LatticeAlignment nodes = alignLattice(boxesBetween(borders), 1, Emitter::lambertian);
    EXPECT_FLOAT_EQ(nodes.spacing, 1);
    EXPECT_LT(offPlanes(nodes, 0, 10), 1e-4);
    EXPECT_LE(nodes.origin.x, 0.137f);
}

TEST(LatticeAlignment, TakesNoHeedOfClearBoxes) {
    std::vector<MediaBox> boxes = boxesBetween({0, 10});
    MediaBox clear = boxes[0];
    clear.lo.x = -3.3f;
    clear.extinction = 0;
    boxes.push_back(clear);
    EXPECT_EQ(alignLattice(boxes, 1, Emitter::pane).origin.x, 0);
    EXPECT_EQ(alignLattice({}, 0.7f, Emitter::pane).spacing, 0.7f);
}

TEST(FarMedia, ThePapersBoxesAreOne) {
    const std::vector<FarMedium> media = mergeMedia(paperCity(2).load());
    ASSERT_EQ(media.size(), 1u);
    EXPECT_EQ(media[0].lo, vec3(-25, -25, 0));
    EXPECT_EQ(media[0].hi, vec3(25, 25, 30));
}

TEST(FarMedia, DifferentMediaStayApart) {
    SceneBuilder city = paperCity(1);
    city.mediaBoxes[4].extinction = 0.05f;
    double volume = 0;
    for (const FarMedium& medium : mergeMedia(city.load())) {
        const vec3 size = medium.hi - medium.lo;
        volume += double(size.x) * double(size.y) * double(size.z);
        EXPECT_EQ(medium.extinction == 0.05f, medium.lo == city.mediaBoxes[4].lo &&
                                                  medium.hi == city.mediaBoxes[4].hi);
    }
    EXPECT_NEAR(volume, 8 * 3000, 1e-6);
}

}  // namespace
}  // namespace nightcity
