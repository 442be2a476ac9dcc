// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/image_file.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <limits>
#include <thread>

#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>

#include "errors.h"
#include "output/channels.h"
#include "output/tone_map.h"
#include "temporary_folder.h"

namespace nightcity {
namespace {

Frame gradient(std::uint32_t width, std::uint32_t height) {
    Frame frame;
    frame.resize(width, height);
    for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
        const float v = float(i) / float(frame.beauty.size());
        frame.glow[i] = {v, v / 2, v / 4};
        frame.surface[i] = {0.01f, 0.02f, 0.03f};
        frame.beauty[i] = glm::vec4(frame.glow[i] + frame.surface[i], 1 - v);
        frame.transmittance[i] = v;
        frame.depth[i] = 100 * v;
        frame.normal[i] = {0, 0, 1};
        frame.mediaId[i] = float(i);
        frame.materialId[i] = 2;
    }
    return frame;
}

ImageMetadata metadata() {
    ImageMetadata metadata;
    metadata.entries = {{"version", "1.2.3"}, {"settingsHash", "abc"}};
    metadata.worldToCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    return metadata;
}

std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t filesIn(const std::filesystem::path& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) {
        ++count;
    }
    return count;
}

TEST(ImageFile, ExrHoldsEveryChannelBitForBit) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.exr";
    const Frame frame = gradient(17, 9);
    writeImage(file, frame, metadata(), {});
    const auto in = OIIO::ImageInput::open(file.string());
    ASSERT_TRUE(in);
    const OIIO::ImageSpec spec = in->spec();
    std::vector<float> values(17 * 9 * std::size_t(spec.nchannels));
    ASSERT_TRUE(in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()));
    const std::vector<Channel> channels = selectChannels({});
    ASSERT_EQ(std::size_t(spec.nchannels), channels.size());
    for (const Channel& channel : channels) {
        const int index = spec.channelindex(channel.name.data());
        ASSERT_GE(index, 0) << channel.name;
        for (std::size_t i = 0; i < 17 * 9; ++i) {
            ASSERT_EQ(values[i * channels.size() + std::size_t(index)], channel.value(frame, i))
                << channel.name;
        }
    }
    EXPECT_EQ(spec.get_string_attribute("nightcity:version"), "1.2.3");
    const auto* matrix = spec.find_attribute("worldToCamera", OIIO::TypeMatrix);
    ASSERT_NE(matrix, nullptr);
    EXPECT_EQ(static_cast<const float*>(matrix->data())[13], 6);
    EXPECT_NE(spec.find_attribute("chromaticities"), nullptr);
}

TEST(ImageFile, AovsLimitTheChannels) {
    const TemporaryFolder folder;
    ImageOptions options;
    options.aovs = {"depth", "beauty"};
    writeImage(folder.path() / "a.exr", gradient(4, 4), metadata(), options);
    const auto in = OIIO::ImageInput::open((folder.path() / "a.exr").string());
    EXPECT_EQ(in->spec().nchannels, 5);
    EXPECT_THROW(selectChannels(std::vector<std::string>{"albedo"}), UsageError);
}

TEST(ImageFile, SameInputSameBytesAtAnotherTime) {
    const TemporaryFolder folder;
    for (const char* extension : {".exr", ".png", ".jpg", ".csv"}) {
        const auto first = folder.path() / (std::string("first") + extension);
        writeImage(first, gradient(40, 30), metadata(), {});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // clocks of files tick seconds
    for (const char* extension : {".exr", ".png", ".jpg", ".csv"}) {
        const auto second = folder.path() / (std::string("second") + extension);
        writeImage(second, gradient(40, 30), metadata(), {});
        EXPECT_EQ(bytesOf(folder.path() / (std::string("first") + extension)), bytesOf(second))
            << extension;
    }
    EXPECT_EQ(filesIn(folder.path()), 8u) << "something else was left behind";
}

TEST(ImageFile, WholeImagesAreToldFromOthers) {
    const TemporaryFolder folder;
    for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
        const auto file = folder.path() / name;
        EXPECT_FALSE(isWholeImage(file, "settingsHash", "abc", 200, 100));
        writeImage(file, gradient(200, 100), metadata(), {});
        EXPECT_TRUE(isWholeImage(file, "settingsHash", "abc", 200, 100)) << name;
        EXPECT_FALSE(isWholeImage(file, "settingsHash", "ab", 200, 100)) << name;
        EXPECT_FALSE(isWholeImage(file, "settingsHash", "abc", 100, 200)) << name;
        std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
        EXPECT_FALSE(isWholeImage(file, "settingsHash", "abc", 200, 100)) << name;
    }
}

TEST(ImageFile, TilesSayWhereTheyLie) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.exr";
    ImageOptions options;
    options.rows = {30, 100};
    writeImage(file, gradient(20, 10), metadata(), options);
    const OIIO::ImageSpec spec = OIIO::ImageInput::open(file.string())->spec();
    EXPECT_EQ(spec.y, 30);
    EXPECT_EQ(spec.height, 10);
    EXPECT_EQ(spec.full_y, 0);
    EXPECT_EQ(spec.full_height, 100);
    EXPECT_EQ(spec.full_width, 20);
    EXPECT_TRUE(isWholeImage(file, "settingsHash", "abc", 20, 10, options.rows));
    EXPECT_FALSE(isWholeImage(file, "settingsHash", "abc", 20, 10, {20, 100}));
    EXPECT_FALSE(isWholeImage(file, "settingsHash", "abc", 20, 10, {30, 90}));
    EXPECT_FALSE(isWholeImage(file, "settingsHash", "abc", 20, 10));
}

// A writer that was killed leaves its file without a lock, a living one holds it.
TEST(ImageFile, WhatKilledWritersLeftIsRemoved) {
    const TemporaryFolder folder;
    const auto left = folder.path() / ".a.csv.999999999.part";
    const auto living = folder.path() / ".a.csv.999999998.part";
    const auto other = folder.path() / ".ab.csv.999999999.part";
    for (const auto& file : {left, living, other}) {
        std::ofstream(file) << "half";
    }
    const int lock = ::open(living.c_str(), O_RDONLY);
    ASSERT_EQ(::flock(lock, LOCK_EX), 0);
    writeImage(folder.path() / "a.csv", gradient(2, 2), metadata(), {});
    ::close(lock);
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_TRUE(std::filesystem::exists(living));
    EXPECT_TRUE(std::filesystem::exists(other));
    EXPECT_EQ(filesIn(folder.path()), 3u);
}

TEST(ImageFile, CsvHasOneLineAPixelWithNineDigits) {
    const TemporaryFolder folder;
    Frame frame = gradient(2, 1);
    frame.glow[1].x = 0.123456789f;
    ImageOptions options;
    options.aovs = {"glow"};
    options.pixels = {{5, 6}, {700, 8}};
    writeImage(folder.path() / "a.csv", frame, metadata(), options);
    EXPECT_EQ(bytesOf(folder.path() / "a.csv"),
              "x,y,glow.R,glow.G,glow.B\n5,6,0,0,0\n700,8,0.123456791,0.25,0.125\n");
}

TEST(ImageFile, NotANumberIsNamedAndNothingWritten) {
    const TemporaryFolder folder;
    Frame frame = gradient(10, 10);
    frame.glow[37].y = std::numeric_limits<float>::quiet_NaN();
    frame.depth[40] = std::numeric_limits<float>::infinity();
    try {
        writeImage(folder.path() / "a.exr", frame, metadata(), {});
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("2 values"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("x 7, y 3, channel glow.G"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(filesIn(folder.path()), 0u);
}

TEST(ImageFile, MissingFolderAndUnknownExtension) {
    const TemporaryFolder folder;
    for (const char* name : {"a.exr", "a.png", "a.jpg", "a.csv"}) {
        const auto file = folder.path() / "none" / name;
        try {
            writeImage(file, gradient(4, 4), metadata(), {});
            FAIL() << name;
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(file.string() + ": cannot be written"),
                      std::string::npos)
                << error.what();
        }
    }
    EXPECT_THROW(imageFormat("a.tiff"), UsageError);
    EXPECT_EQ(imageFormat("A.EXR"), ImageFormat::exr);
}

// A limit on the size of files stands for a disk that is full.
TEST(ImageFile, FullDiskLeavesNothing) {
    const TemporaryFolder folder;
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 2000;
    ::setrlimit(RLIMIT_FSIZE, &small);
    int refused = 0;
    for (const char* name : {"a.exr", "a.png", "a.jpg", "a.csv"}) {
        try {
            writeImage(folder.path() / name, gradient(300, 200), metadata(), {});
        } catch (const std::runtime_error&) {
            ++refused;
        }
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(refused, 4);
    EXPECT_EQ(filesIn(folder.path()), 0u);
}

TEST(ToneMap, BlackWhiteAndOrder) {
    EXPECT_EQ(toneMap(glm::vec3(0), 2), glm::vec3(0));
    const glm::vec3 window = toneMap(glm::vec3(9, 7, 5), 2);
    EXPECT_GT(window.x, 0.97f);
    EXPECT_GT(window.z, 0.9f);
    float last = -1;
    for (float v = 0; v < 100; v = v * 1.1f + 0.001f) {
        const float shown = toneMap(glm::vec3(v), 0).x;
        EXPECT_GE(shown, last);
        EXPECT_LE(shown, 1);
        last = shown;
    }
    // One stop of exposure is twice the radiance.
    EXPECT_EQ(toneMap(glm::vec3(0.2f, 0.1f, 0.05f), 1), toneMap(glm::vec3(0.4f, 0.2f, 0.1f), 0));
    // Khronos' own figures: below the shoulder a grey of 0.5 maps to 0.46 linear.
    EXPECT_NEAR(toneMap(glm::vec3(0.5f), 0).x, 1.055 * std::pow(0.46, 1 / 2.4) - 0.055, 1e-6);
}

}  // namespace
}  // namespace nightcity
