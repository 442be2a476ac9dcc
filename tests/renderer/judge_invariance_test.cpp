// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What must not change the judge's verdict, and what it must notice.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "judge_setup.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

const Emitter kEmitters[] = {Emitter::isotropic, Emitter::lambertian, Emitter::pane};

// One street between two blocks, in coordinates that are multiples of 1/64 m, so that
// float32 holds them also ten kilometres away.
SceneBuilder street(glm::dvec3 shift = glm::dvec3(0), float power = 50) {
    SceneBuilder city;
    const auto at = [&](double x, double y, double z) { return vec3(glm::dvec3(x, y, z) + shift); };
    const uint wall = city.addMaterial(vec3(0.5f));
    city.addBoxBuilding(at(-10, -20, 0), at(-5, -2, 20), wall);
    city.addWindow(at(-4.984375, -8, 5), {0, 0.5f, 0}, {0, 0, 0.75f}, power);
    city.addWindow(at(-4.984375, -14, 9), {0, 0.5f, 0}, {0, 0, 0.75f}, power);
    city.addBoxBuilding(at(-10, 2, 0), at(-5, 20, 14), wall);
    city.addWindow(at(-4.984375, 6, 3), {0, 0.5f, 0}, {0, 0, 0.75f}, power);
    city.addBoxBuilding(at(5, -12, 0), at(10, 12, 16), wall);
    city.addWindow(at(4.984375, -3, 7), {0, -0.5f, 0}, {0, 0, 0.75f}, power);
    city.addWindow(at(4.984375, 9, 12), {0, -0.5f, 0}, {0, 0, 0.75f}, power);
    city.addWindow(at(7, 12.015625, 12), {-0.5f, 0, 0}, {0, 0, 0.75f}, power);
    city.addMediaBox(at(-32, -32, 0), at(32, 32, 24), 0.03125f, 0.875f);
    return city;
}

const std::vector<Ray>& rays() {
    static const std::vector<Ray> kRays{through({0, -60, 20}, {1, 30, 3}), through({2, -18, 2}, {1, 25, 14}),
                                        through({-30, -1, 9}, {30, 1, 8}), through({40, 40, 30}, {0, 0, 4})};
    return kRays;
}

// Splits the only box of haze into a grid.
SceneBuilder cutHaze(SceneBuilder city, std::vector<float> x, std::vector<float> y, std::vector<float> z) {
    const MediaBox whole = city.mediaBoxes[0];
    city.mediaBoxes.clear();
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        for (std::size_t k = 0; k + 1 < y.size(); ++k) {
            for (std::size_t m = 0; m + 1 < z.size(); ++m) {
                city.addMediaBox({x[i], y[k], z[m]}, {x[i + 1], y[k + 1], z[m + 1]},
                                 whole.extinction, whole.albedo);
            }
        }
    }
    return city;
}

TEST(JudgeInvariance, HazeInManyBoxesIsOneHaze) {
    const FlatScene whole = street().load();
    const FlatScene cut = cutHaze(street(), {-32, -9, -5, 0, 5, 32}, {-32, -2, 2, 7, 32}, {0, 5, 14, 24}).load();
    for (const Emitter emitter : kEmitters) {
        for (const Visibility visibility : {Visibility::none, Visibility::full}) {
            const Accuracy accuracy =
                emitter == Emitter::pane ? Accuracy{1e-6, 1e-9} : Accuracy{1e-11, 1e-12};
            for (const Ray& ray : rays()) {
                const double one = glow(whole, exactModel(emitter, visibility), ray, accuracy);
                const double many = glow(cut, exactModel(emitter, visibility), ray, accuracy);
                EXPECT_NEAR(many / one, 1, std::max(1e-9, accuracy.relative)) << int(emitter);
            }
        }
    }
}

TEST(JudgeInvariance, ThousandSlicesSumToTheWhole) {
    const FlatScene scene = street().load();
    for (const Emitter emitter : {Emitter::isotropic, Emitter::lambertian}) {
        const LightScene lights(scene, 1, exactModel(emitter));
        const SingleScattering scattering(lights, kFine);
        const Ray ray = rays()[0];
        const std::vector<Segment> segments = MediaSegments(scene).along(ray, 1e9);
        ASSERT_EQ(segments.size(), 1u);
        const Segment whole = segments[0];
        double sum = 0;
        for (int i = 0; i < 1000; ++i) {
            const double step = (whole.end - whole.begin) / 1000;
            const Segment slice{whole.box, whole.begin + i * step, whole.begin + (i + 1) * step};
            sum += std::exp(-0.03125 * i * step) *
                   scattering.along(ray, std::span(&slice, 1)).value.x;
        }
        EXPECT_NEAR(sum / scattering.along(ray, segments).value.x, 1, 1e-10);
    }
}

TEST(JudgeInvariance, OrderOfTheWindowsDoesNotMatter) {
    SceneBuilder shuffled = street();
    for (Window& window : shuffled.windows) {
        window.building = kNone;
    }
    for (Building& building : shuffled.buildings) {
        building.windowCount = 0;
    }
    std::shuffle(shuffled.windows.begin(), shuffled.windows.end(), std::mt19937(2));
    for (const Ray& ray : rays()) {
        const double one = glow(street().load(), exactModel(Emitter::lambertian), ray);
        EXPECT_NEAR(glow(shuffled.load(), exactModel(Emitter::lambertian), ray) / one, 1, 1e-13);
    }
}

TEST(JudgeInvariance, CityMayLieTenKilometresAway) {
    const glm::dvec3 shift(10240, -7168, 512);
    const FlatScene here = street().load(), there = street(shift).load();
    for (const Emitter emitter : kEmitters) {
        const Accuracy accuracy = emitter == Emitter::pane ? Accuracy{1e-6, 1e-9} : kFine;
        for (const Ray& ray : rays()) {
            const double one = glow(here, exactModel(emitter), ray, accuracy);
            const double other = glow(there, exactModel(emitter), {ray.origin + shift, ray.direction}, accuracy);
            EXPECT_NEAR(other / one, 1, std::max(1e-9, accuracy.relative));
        }
    }
}

TEST(JudgeInvariance, UnitOfPowerIsAFactor) {
    const FlatScene bright = street().load(), dark = street({}, 50.0f / 1024).load();
    for (const Emitter emitter : kEmitters) {
        for (const Ray& ray : rays()) {
            const double one = glow(bright, exactModel(emitter), ray, {1e-4, 1e-6});
            EXPECT_NEAR(1024 * glow(dark, exactModel(emitter), ray, {1e-4, 1e-6}) / one, 1, 1e-13);
        }
    }
}

TEST(JudgeInvariance, ErrorStaysWithinWhatIsAskedAndStated) {
    const FlatScene scene = paperCity(2).load();
    for (const Emitter emitter : kEmitters) {
        const LightScene lights(scene, 1, exactModel(emitter));
        const MediaSegments media(scene);
        const OpaqueSurfaces surfaces(scene, 1);
        const SingleScattering fine(lights, {1e-5, 1e-8}), coarse(lights, {1e-3, 1e-4});
        std::mt19937 random(4);
        std::uniform_real_distribution<double> unit(-1, 1);
        for (int i = 0; i < 24; ++i) {
            const glm::dvec3 eye = i % 2 ? glm::dvec3(60, -80, 40) : glm::dvec3(1.5, -24, 2);
            const Ray ray = through(eye, {20 * unit(random), 20 * unit(random), 8 + 8 * unit(random)});
            const auto segments = media.along(ray, surfaces.nearest(ray).distance);
            const WindowSum truth = fine.along(ray, segments), quick = coarse.along(ray, segments);
            const double mean = (truth.value.x + truth.value.y + truth.value.z) / 3;
            const double error = std::abs((quick.value.x + quick.value.y + quick.value.z) / 3 - mean);
            EXPECT_LE(error, quick.error + quick.leftOut + 1e-5 * mean) << int(emitter) << " " << i;
            EXPECT_LE(quick.error, 1e-3 * mean);
            EXPECT_LE(quick.leftOut, 1e-4 * mean);
            EXPECT_LE(quick.windows, truth.windows);
        }
    }
}

// Design section 5: errors relative to the reference, or to 1 % of the median of the
// frame's nonzero glow where that is more.
double quantileError(const Frame& value, const Frame& reference, double quantile) {
    std::vector<float> nonzero;
    for (const vec3& glow : reference.glow) {
        if (glow.y > 0) {
            nonzero.push_back(glow.y);
        }
    }
    std::nth_element(nonzero.begin(), nonzero.begin() + std::ptrdiff_t(nonzero.size() / 2), nonzero.end());
    const double floor = 0.01 * double(nonzero[nonzero.size() / 2]);
    std::vector<double> errors;
    for (std::size_t i = 0; i < reference.glow.size(); ++i) {
        errors.push_back(std::abs(double(value.glow[i].y) - double(reference.glow[i].y)) /
                         std::max(double(reference.glow[i].y), floor));
    }
    std::sort(errors.begin(), errors.end());
    return errors[std::size_t(quantile * double(errors.size() - 1))];
}

RenderProduct streetView(uint width, uint height) {
    RenderProduct product;
    product.camera = "street";
    product.width = width;
    product.height = height;
    return product;
}

class JudgeMutants : public testing::TestWithParam<float> {
protected:
    Frame render(const SceneBuilder& city, Visibility visibility = Visibility::full,
                 double tolerance = 0.001) const {
        SceneBuilder scaled = city;
        for (Window& window : scaled.windows) {
            window.power *= GetParam();
        }
        RenderSettings settings = exactModel(Emitter::lambertian, visibility);
        settings.method = Method::reference;
        settings.tolerance = tolerance;
        const FlatScene scene = scaled.load();
        RenderProduct product = streetView(192, 106);
        product.pixels = selectPixels(scene, product, 200, 11);
        return renderReference(scene, product, settings, {}).frame;
    }
};

// The verdict at a tolerance of 0.001, alike at a thousandth of the light.
TEST_P(JudgeMutants, AreNoticed) {
    const SceneBuilder city = paperCity(2);
    const Frame truth = render(city);
    EXPECT_LT(quantileError(render(city, Visibility::full, 0.01), truth, 1), 1e-3);

    SceneBuilder fewer = city;  // 5 % of the windows are dark
    for (std::size_t i = 7; i < fewer.windows.size(); i += 20) {
        fewer.windows[i].flags = 0;
    }
    EXPECT_GT(quantileError(render(fewer), truth, 0.95), 1e-2);
    EXPECT_GT(quantileError(render(city, Visibility::none), truth, 0.5), 1e-1);

    SceneBuilder gap = city;  // one box of haze, a street crossing, is missing
    gap.mediaBoxes.erase(gap.mediaBoxes.begin() + std::ptrdiff_t(gap.mediaBoxes.size() / 2));
    EXPECT_GT(quantileError(render(gap), truth, 0.95), 1e-2);

    SceneBuilder stronger = city;
    for (Window& window : stronger.windows) {
        window.power *= 1.01f;
    }
    EXPECT_NEAR(quantileError(render(stronger), truth, 0.5), 0.01, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Powers, JudgeMutants, testing::Values(1.0f, 1e-3f));

TEST(JudgeFrame, SameBytesTwiceAndListedPixelsAreThoseOfTheFrame) {
    const FlatScene scene = paperCity(1).load();
    RenderSettings settings = exactModel(Emitter::lambertian);
    settings.method = Method::reference;
    settings.tolerance = 0.01;
    settings.model.surfaces = Surfaces::lit;
    RenderProduct product = streetView(32, 18);
    const Frame whole = renderReference(scene, product, settings, {}).frame;
    EXPECT_EQ(whole.beauty, renderReference(scene, product, settings, {}).frame.beauty);
    product.pixels = {{31, 17}, {16, 12}};
    const Frame listed = renderReference(scene, product, settings, {}).frame;
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(listed.beauty[i], whole.beauty[product.pixels[i].y * 32 + product.pixels[i].x]);
    }
}

// Under the paper's model the exact integral is what the march converges to.
TEST(JudgeFrame, PapersModelIsTheLimitOfTheMarch) {
    const FlatScene scene = paperCity(2).load();
    RenderSettings settings;
    settings.method = Method::reference;
    settings.subdivisions = 2000;
    RenderProduct product = streetView(64, 36);
    product.pixels = selectPixels(scene, product, 100, 3);
    const Frame marched = renderReference(scene, product, settings, {}).frame;
    settings.lightCap = 20;
    const Frame cappedMarch = renderReference(scene, product, settings, {}).frame;
    settings.tolerance = 1e-4;
    const Frame capped = renderReference(scene, product, settings, {}).frame;
    settings.lightCap.reset();
    const Frame exact = renderReference(scene, product, settings, {}).frame;
    EXPECT_LT(quantileError(marched, exact, 0.5), 2e-6);
    EXPECT_LT(quantileError(marched, exact, 0.95), 1e-4);
    EXPECT_LT(quantileError(cappedMarch, capped, 0.95), 1e-4);
    EXPECT_GT(quantileError(capped, exact, 0.95), 0.1);
}

}  // namespace
}  // namespace nightcity
