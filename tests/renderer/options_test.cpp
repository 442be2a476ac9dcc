// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "defaults.h"
#include "errors.h"
#include "frame_names.h"
#include "image_metadata.h"
#include "scene_builder.h"
#include "temporary_folder.h"

namespace nightcity {
namespace {

std::optional<Options> parse(std::vector<const char*> arguments, std::string* shown = nullptr) {
    arguments.insert(arguments.begin(), "nightcity-render");
    std::ostringstream out;
    const auto options = parseOptions(int(arguments.size()), arguments.data(), out);
    if (shown != nullptr) {
        *shown = out.str();
    }
    return options;
}

std::string refusal(const std::vector<const char*>& arguments) {
    try {
        parse(arguments);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "(accepted)";
}

#define EXPECT_REFUSED(part, ...)                                      \
    EXPECT_NE(refusal({__VA_ARGS__}).find(part), std::string::npos)    \
        << refusal({__VA_ARGS__})

TEST(Options, Defaults) {
    const Options options = *parse({"city.scene", "-o", "a.exr"});
    EXPECT_EQ(options.scene, "city.scene");
    EXPECT_EQ(options.settings.subdivisions, 25u);
    EXPECT_EQ(options.settings.method, Method::field);
    EXPECT_EQ(options.settings.model, kSingleModel);
    EXPECT_EQ(options.settings.tolerance, 0.01);
    EXPECT_FALSE(options.size || options.camera || options.frames || options.aovs);
    EXPECT_EQ(options.repeat, 1u);
}

TEST(Options, EveryOptionArrives) {
    const Options options = *parse(
        {"city.scene", "-o", "a.####.exr", "--camera", "street", "--size", "64x32", "--frames",
         "1-5x2,9", "--model", "paper", "--method", "march", "--subdivisions", "40",
         "--march-order", "steps", "--light-cap", "40", "--light-storage", "storage",
         "--pixel-samples", "16", "--filter", "gauss", "--media", "off", "--seed", "7", "--aovs",
         "beauty,glow", "--device", "llvm", "--validation", "--stats", "s.json",
         "--skip-existing", "--progress", "lines", "--tile", "2/3",
         "--memory", "2.5G"});
    EXPECT_EQ(options.size, glm::uvec2(64, 32));
    EXPECT_EQ(options.frames, (std::vector<int>{1, 3, 5, 9}));
    EXPECT_EQ(options.settings.marchOrder, MarchOrder::steps);
    EXPECT_EQ(options.settings.lightStorage, LightStorage::storage);
    EXPECT_EQ(options.settings.lightCap, 40u);
    EXPECT_EQ(options.settings.pixelSamples, 16u);
    EXPECT_EQ(options.settings.filter, Filter::gauss);
    EXPECT_FALSE(options.settings.media);
    EXPECT_EQ(options.settings.seed, 7u);
    EXPECT_EQ(options.aovs, (std::vector<std::string>{"beauty", "glow"}));
    EXPECT_EQ(options.device.device, "llvm");
    EXPECT_TRUE(options.device.validation && options.skipExisting);
    EXPECT_EQ(options.progress, ProgressStyle::lines);
    EXPECT_EQ(options.tile->number, 2u);
    EXPECT_EQ(options.tile->count, 3u);
    EXPECT_EQ(options.device.memoryBytes, 5ull << 29);
}

TEST(Options, TheModelChoosesTheMethod) {
    const auto method = [](std::vector<const char*> arguments) {
        arguments.insert(arguments.begin(), {"s", "-o", "a.exr"});
        return parse(arguments)->settings.method;
    };
    EXPECT_EQ(method({"--model", "single"}), Method::field);
    EXPECT_EQ(method({"--emitter", "isotropic", "--visibility", "none"}), Method::field);
    EXPECT_EQ(method({"--surfaces", "lit", "--tolerance", "0.01"}), Method::field);
    EXPECT_EQ(method({"--media", "off", "--write-only"}), Method::field);
    EXPECT_EQ(method({"--model", "paper"}), Method::gauss);
    EXPECT_EQ(method({"--lights", "listed"}), Method::gauss);
    EXPECT_EQ(method({"--reach", "20"}), Method::gauss);
    EXPECT_EQ(method({"--tolerance", "0.001"}), Method::gauss);
    EXPECT_EQ(method({"--model", "full"}), Method::path);
    EXPECT_EQ(method({"--scattering", "multiple"}), Method::field);
    EXPECT_EQ(method({"--scattering", "multiple", "--tolerance", "0.005"}), Method::field);
    EXPECT_EQ(method({"--scattering", "multiple", "--samples", "16"}), Method::path);
    EXPECT_EQ(method({"--scattering", "multiple", "--orders", "2-"}), Method::path);
    EXPECT_EQ(method({"--scattering", "multiple", "--g", "0.5"}), Method::path);
    EXPECT_EQ(method({"--scattering", "multiple", "--aovs", "glow,glowError"}), Method::path);
    EXPECT_EQ(method({"--scattering", "multiple", "--lights", "listed"}), Method::path);
    EXPECT_EQ(method({"--scattering", "multiple", "--reach", "20"}), Method::path);
}

TEST(Options, TheMarchIsOfThePapersModel) {
    for (const std::vector<const char*>& options :
         {std::vector<const char*>{"s", "-o", "a.exr", "--method", "march"},
          {"s", "-o", "a.exr", "--method", "reference", "--subdivisions", "4"}}) {
        EXPECT_EQ(parse(options)->settings.model, Model{});
    }
    EXPECT_EQ(parse({"s", "-o", "a.exr", "--method", "reference"})->settings.model, kSingleModel);
}

TEST(Options, VersionAndHelpAreAnswered) {
    std::string shown;
    EXPECT_FALSE(parse({"--version"}, &shown));
    EXPECT_EQ(shown, "nightcity-render " NIGHTCITY_VERSION "\n");
    EXPECT_FALSE(parse({"--help"}, &shown));
    EXPECT_NE(shown.find("--march-order"), std::string::npos);
}

TEST(Options, UnknownChoicesNameTheKnownOnes) {
    EXPECT_REFUSED("there is march", "s", "-o", "a.exr", "--method", "rays");
    EXPECT_REFUSED("there is single", "s", "-o", "a.exr", "--scattering", "twice");
    EXPECT_REFUSED("there is paper", "s", "-o", "a.exr", "--model", "best");
}

TEST(Options, UnknownOptionsNameTheNearestOne) {
    EXPECT_REFUSED("did you mean --tolerance?", "city.scene", "-o", "a.exr", "--tolerence", "0.1");
    EXPECT_REFUSED("did you mean --pixel-samples?", "city.scene", "--pixelsamples=4");
    EXPECT_EQ(refusal({"city.scene", "--xyzzy", "4"}).find("mean"), std::string::npos);
}

TEST(Options, EveryMethodRefusesWhatItDoesNotKnow) {
    for (const char* method : {"march", "gauss"}) {
        EXPECT_REFUSED("--method field and path", "s", "-o", "a.exr", "--method", method,
                       "--scattering", "multiple");
    }
    EXPECT_REFUSED("--method path", "s", "-o", "a.exr", "--samples", "8");
    for (const char* method : {"path", "gauss", "reference"}) {
        EXPECT_REFUSED("--method field", "s", "-o", "a.exr", "--method", method, "--bricks", "100");
    }
    EXPECT_REFUSED("--method path", "s", "-o", "a.exr", "--orders", "2-");
    EXPECT_REFUSED("--method path", "s", "-o", "a.exr", "--g", "0.5");
    EXPECT_REFUSED("--method path", "s", "-o", "a.exr", "--aovs", "glowError");
    EXPECT_REFUSED("--method field", "s", "-o", "a.exr", "--model", "paper", "--aovs", "error");
    EXPECT_REFUSED("--method field", "s", "-o", "a.exr", "--method", "path", "--aovs", "cost");
    EXPECT_REFUSED("gauss or march", "s", "-o", "a.exr", "--method", "field", "--lights", "listed");
    EXPECT_REFUSED("--method march", "s", "-o", "a.exr", "--subdivisions", "5");
    EXPECT_REFUSED("--method march", "s", "-o", "a.exr", "--model", "paper", "--march-order", "steps");
    for (const char* lights : {"all", "listed"}) {
        EXPECT_REFUSED("--method gauss", "s", "-o", "a.exr", "--method", "march", "--visibility",
                       "full", "--lights", lights);
    }
    for (const char* option : {"--subdivisions", "--light-cap"}) {
        EXPECT_REFUSED(option, "s", "-o", "a.exr", "--method", "path", option, "5");
    }
    EXPECT_REFUSED("--samples 1", "s", "-o", "a.exr", "--method", "path", "--samples", "1");
    EXPECT_REFUSED("--g", "s", "-o", "a.exr", "--method", "path", "--g", "1");
    EXPECT_REFUSED("--scattering multiple", "s", "-o", "a.exr", "--method", "path", "--orders", "2-");
}

TEST(Options, TheFieldTakesANumberOfBricks) {
    EXPECT_EQ(parse({"s", "-o", "a.exr"})->settings.bricks, std::nullopt);
    EXPECT_EQ(parse({"s", "-o", "a.exr", "--bricks", "64"})->settings.bricks, 64u);
}

TEST(Options, BadValuesAreRefused) {
    for (const char* size : {"0x10", "10", "10x", "x10", "-1x10", "99999x10", "65536x65536", "1e3x9"}) {
        EXPECT_REFUSED("--size", "s", "-o", "a.exr", "--size", size);
    }
    for (const char* frames : {"", ",", "1,", "5-1", "1-5x0", "a", "1-2-3", "99999999999", "1-2000000000"}) {
        EXPECT_REFUSED("--frames", "s", "-o", "a.#.exr", "--frames", frames);
    }
    EXPECT_REFUSED("--subdivisions", "s", "-o", "a.exr", "--subdivisions", "0");
    EXPECT_REFUSED("--bricks", "s", "-o", "a.exr", "--bricks", "63");
    EXPECT_REFUSED("--bricks", "s", "-o", "a.exr", "--bricks", "1000001");
    EXPECT_REFUSED("--subdivisions", "s", "-o", "a.exr", "--subdivisions", "-3");
    EXPECT_REFUSED("--pixel-samples", "s", "-o", "a.exr", "--pixel-samples", "many");
    EXPECT_REFUSED("--media", "s", "-o", "a.exr", "--media", "maybe");
    EXPECT_REFUSED("--exposure", "s", "-o", "a.png", "--exposure", "nan");
    EXPECT_REFUSED("albedo", "s", "-o", "a.exr", "--aovs", "albedo");
    EXPECT_REFUSED(".exr, .png, .jpg or .csv", "s", "-o", "a.tif");
    for (const char* memory : {"", "G", "-1G", "0", "4GB", "4g", "nan", "1e30", "4G "}) {
        EXPECT_REFUSED("--memory", "s", "-o", "a.exr", "--memory", memory);
    }
    EXPECT_REFUSED("--memory is for", "s", "-o", "a.exr", "--method", "reference", "--memory", "4G");
    EXPECT_REFUSED("--tile is for .exr", "s", "-o", "a.png", "--tile", "1/2");
    EXPECT_REFUSED("--list-missing", "s", "-o", "a.csv", "--pixels", "9", "--list-missing");
    EXPECT_REFUSED("--wobble", "s", "-o", "a.exr", "--wobble");
}

TEST(Options, CombinationsAreChecked) {
    EXPECT_REFUSED("no scene", "-o", "a.exr");
    EXPECT_REFUSED("-o FILE is missing", "s");
    EXPECT_REFUSED("no folder", "s", "-o", "none/a.exr");
    EXPECT_REFUSED("no folder", "s", "-o", "a.exr", "--stats", "none/s.json");
    EXPECT_REFUSED("a.####.exr", "s", "-o", "a.exr", "--frames", "1-2");
    EXPECT_REFUSED("--repeat", "s", "-o", "a.#.exr", "--frames", "1-2", "--repeat", "3");
    EXPECT_REFUSED("--pixels", "s", "-o", "a.csv");
    EXPECT_REFUSED(".csv", "s", "-o", "a.exr", "--pixels", "10");
    EXPECT_REFUSED("at least 1", "s", "-o", "a.csv", "--pixels", "0");
    EXPECT_REFUSED("--exposure", "s", "-o", "a.exr", "--exposure", "1");
    EXPECT_REFUSED("--aovs", "s", "-o", "a.png", "--aovs", "glow");
    EXPECT_REFUSED("--march-order", "s", "-o", "a.exr", "--method", "reference", "--march-order", "steps");
    EXPECT_REFUSED("--skip-existing", "s", "-o", "a.csv", "--pixels", "9", "--skip-existing");
    EXPECT_TRUE(parse({"--list-devices"})->listDevices);
}

TEST(FrameNames, FillThePlace) {
    EXPECT_EQ(frameFile("out/a.####.exr", 7), "out/a.0007.exr");
    EXPECT_EQ(frameFile("a.%04d.exr", 12345), "a.12345.exr");
    EXPECT_EQ(frameFile("a%d.exr", 3), "a3.exr");
    EXPECT_EQ(frameFile("a#.exr", -3), "a-3.exr");
    EXPECT_EQ(frameFile("50%.exr", 3), "50%.exr");
    EXPECT_FALSE(hasFramePlace("a#b/a.exr"));
    EXPECT_EQ(parseFrames("3,1-2,2"), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(parseFrames("-3--1"), (std::vector<int>{-3, -2, -1}));
}

TEST(PixelList, LinesAreReadAndFaultsNamed) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "p.csv";
    const auto read = [&](const std::string& text) {
        std::ofstream(file) << text;
        return readPixels(file, {100, 50});
    };
    EXPECT_EQ(read("x,y\n1,2\n\n 99 , 49 \r\n3,4,0.5\n"),
              (std::vector<glm::uvec2>{{1, 2}, {99, 49}, {3, 4}}));
    for (const char* bad : {"", "x,y\n", "1\n", "1;2\n", "-1,2\n", "1,2x\n", "99999999999,2\n", "100,2\n", "2,50\n"}) {
        EXPECT_THROW(read(bad), UsageError) << bad;
    }
    EXPECT_THROW(readPixels(folder.path(), {9, 9}), UsageError);
    EXPECT_THROW(readPixels(folder.path() / "none", {9, 9}), UsageError);
}

// A point on the ray of an image position lands at that position by worldToNDC.
TEST(ImageMetadata, WorldToNdcInvertsTheCameraRay) {
    SceneBuilder city = paperCity(1);
    city.cameras[0].frames[0].shiftX = 0.3f;
    city.cameras[0].frames[0].shiftY = -0.2f;
    const FlatScene scene = city.load();
    RenderProduct product;
    product.camera = "overview75";
    product.width = 200;
    product.height = 100;
    product.cameraOffset = {1, 2, 3};
    const ImageMetadata metadata = describeImage(scene, product, {}, {}, ImageFormat::exr);
    const CameraFrame& camera = scene.cameras[0].frames[0];
    const float x = 150, y = 20;
    const vec3 direction =
        camera.forward +
        camera.right * camera.tanHalfFov * ((2 * x - 200) / 100 + camera.shiftX) +
        camera.up * camera.tanHalfFov * ((100 - 2 * y) / 100 + camera.shiftY);
    const vec3 point = camera.position + product.cameraOffset + 40.0f * direction;
    glm::dvec4 ndc(0), view(0);
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const double p = j < 3 ? double(point[j]) : 1;
            ndc[i] += p * double(metadata.worldToNdc[std::size_t(4 * j + i)]);
            view[i] += p * double(metadata.worldToCamera[std::size_t(4 * j + i)]);
        }
    }
    EXPECT_NEAR(ndc.x / ndc.w, 0.75, 1e-4);
    EXPECT_NEAR(ndc.y / ndc.w, 0.2, 1e-4);
    EXPECT_NEAR(ndc.z / ndc.w, 1 - 1 / 40.0, 1e-4);
    EXPECT_NEAR(view.z, -40, 1e-3);
}

TEST(ImageMetadata, HashFollowsEverySetting) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product;
    product.camera = "street";
    const auto hash = [&](const RenderSettings& settings) {
        return describeImage(scene, product, settings, {}, ImageFormat::exr).entries.back().second;
    };
    RenderSettings changed;
    const std::string before = hash(changed);
    EXPECT_EQ(before, hash(changed));
    changed.subdivisions = 26;
    EXPECT_NE(before, hash(changed));
    product.frame = 2;
    EXPECT_NE(before, hash({}));
}

}  // namespace
}  // namespace nightcity
