// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_file.h"

#include <fstream>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "errors.h"
#include "scene_builder.h"
#include "temporary_folder.h"

namespace nightcity {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Loads and expects a SceneError whose message holds every one of `parts`.
void expectFault(const SceneBuilder& city, const std::vector<std::string>& parts) {
    try {
        city.load();
        FAIL() << "the loader took the scene; expected an error with " << parts.front();
    } catch (const SceneError& error) {
        for (const std::string& part : parts) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
                << "'" << part << "' is missing in: " << error.what();
        }
    }
}

TEST(SceneFile, PaperCitiesHaveThePapersCounts) {
    const std::map<uint, std::array<std::size_t, 4>> counts{
        {1, {1, 80, 8, 268}}, {2, {4, 320, 21, 940}}, {3, {9, 720, 40, 2028}}, {4, {16, 1280, 65, 3532}}};
    for (const auto& [n, expected] : counts) {
        const FlatScene scene = paperCity(n).load();
        EXPECT_EQ(scene.buildings.size(), expected[0]);
        EXPECT_EQ(scene.windows.size(), expected[1]);
        EXPECT_EQ(scene.mediaBoxes.size(), expected[2]);
        EXPECT_EQ(scene.triangles.size() + 12 * scene.mediaBoxes.size() + 2 * scene.windows.size(),
                  expected[3]);
    }
}

TEST(SceneFile, PaperListsHoldTenTwentyOrFortyLights) {
    std::map<uint, int> boxes;
    const FlatScene scene = paperCity(4).load();
    for (const MediaBox& box : scene.mediaBoxes) {
        ++boxes[box.lightCount];
    }
    EXPECT_EQ(boxes, (std::map<uint, int>{{10, 4}, {20, 28}, {40, 33}}));
}

TEST(SceneFile, ReadsWhatWasWritten) {
    SceneBuilder city = paperCity(1);
    city.windowEvents = {{2, 3, 0}, {4, 3, 1}};
    const FlatScene scene = city.load();
    EXPECT_EQ(scene.windows[7].centre, city.windows[7].centre);
    EXPECT_EQ(scene.mediaBoxes[2].hi, city.mediaBoxes[2].hi);
    EXPECT_EQ(scene.camera("street").at(99).forward, city.cameras[1].frames[0].forward);
    EXPECT_EQ(scene.hash.size(), 32u);
    EXPECT_EQ(scene.hash, city.load().hash);
    EXPECT_EQ(scene.windowsOn(1)[3], 1);
    EXPECT_EQ(scene.windowsOn(2)[3], 0);
    EXPECT_EQ(scene.windowsOn(4)[3], 1);
    try {
        scene.camera("roof");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "no camera is called 'roof'; this scene has overview75, street, far25");
    }
}

TEST(SceneFile, EmptySceneLoads) {
    const FlatScene scene = SceneBuilder().load();
    EXPECT_TRUE(scene.windows.empty());
    EXPECT_THROW(scene.camera("any"), UsageError);
}

struct Spoiled {
    const char* name;
    std::function<void(SceneBuilder&)> spoil;
    std::vector<std::string> message;
};

class SceneFileFault : public testing::TestWithParam<Spoiled> {};

TEST_P(SceneFileFault, IsNamed) {
    SceneBuilder city = paperCity(1);
    GetParam().spoil(city);
    expectFault(city, GetParam().message);
}

Spoiled inManifest(const char* name, const char* pointer, nlohmann::json value,
                   std::vector<std::string> message) {
    return {name,
            [=](SceneBuilder& city) {
                city.editManifest = [=](nlohmann::json& manifest) {
                    manifest[nlohmann::json::json_pointer(pointer)] = value;
                };
            },
            std::move(message)};
}

INSTANTIATE_TEST_SUITE_P(
    Manifest, SceneFileFault,
    testing::Values(
        inManifest("version", "/version", 2, {"scene.json: version is 2", "reads 1"}),
        inManifest("format", "/format", "city", {"scene.json: format is \"city\""}),
        inManifest("byteOrder", "/byte_order", "big", {"byte_order is \"big\""}),
        inManifest("stride", "/arrays/window/stride", 60, {"arrays.window.stride is 60", "64"}),
        inManifest("fields", "/arrays/media_box/fields/1/3", 13, {"arrays.media_box.fields"}),
        inManifest("alignment", "/arrays/window/offset", 68, {"arrays.window.offset is 68", "64"}),
        inManifest("bounds", "/arrays/light_list/count", 1000000, {"light_list.count is 1000000"}),
        inManifest("overflow", "/arrays/window/offset", 0xffffffffffffffc0u, {"arrays.window"}),
        inManifest("manyRecords", "/arrays/window/count", 0xffffffffu, {"window.count is 4294967295"}),
        inManifest("negativeCount", "/arrays/window/count", -1, {"arrays.window.count is -1"}),
        inManifest("sharedBytes", "/arrays/position/offset", 128, {"lies inside the array"}),
        inManifest("missingArray", "/arrays", nlohmann::json::object(), {"arrays.position is missing"}),
        inManifest("hash", "/binary/hash", std::string(32, '0'), {"scene.bin: the hash is"}),
        inManifest("length", "/binary/bytes", 10000000, {"scene.bin", "bytes long", "10000000"}),
        inManifest("otherFile", "/binary/file", "../other.bin", {"binary.file is \"../other.bin\""}),
        inManifest("cameraRange", "/cameras/0/first", 99, {"cameras[0].count"}),
        inManifest("cameraName", "/cameras/1/name", "overview75", {"cameras[1].name", "of its own"}),
        inManifest("ground", "/ground/material", 2, {"ground.material is 2", "2 materials"}),
        inManifest("groundHeight", "/ground/height", 1e300, {"ground.height"}),
        inManifest("frames", "/frames/last", 0, {"frames.last is 0"}),
        inManifest("framesType", "/frames/last", "ten", {"frames.last is \"ten\""}),
        inManifest("perSecond", "/frames/per_second", 0.0, {"frames.per_second is 0"}),
        inManifest("renderCamera", "/render/camera", "roof", {"render.camera is \"roof\""}),
        inManifest("origin", "/origin", {1, 2}, {"origin[2] is missing"})),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Records, SceneFileFault,
    testing::Values(
        Spoiled{"position", [](auto& c) { c.positions[3].y = kNaN; }, {"scene.bin: position[3] is", "nan"}},
        Spoiled{"texcoords", [](auto& c) { c.texcoords = {{0, 0}}; }, {"arrays.texcoord.count is 1"}},
        Spoiled{"vertex", [](auto& c) { c.triangles[5].vertex.z = 8; }, {"triangle[5].vertex.z is 8", "8 positions"}},
        Spoiled{"material", [](auto& c) { c.triangles[5].material = 9; }, {"triangle[5].material is 9"}},
        Spoiled{"reflectance", [](auto& c) { c.materials[1].reflectance.x = 1.5f; }, {"material[1].reflectance.x is 1.5"}},
        Spoiled{"texture", [](auto& c) { c.materials[0] = {vec3(1), 0, 65536, 65536}; }, {"material[0].first_texel"}},
        Spoiled{"textureHalf", [](auto& c) { c.materials[0].width = 4; }, {"material[0].width"}},
        Spoiled{"buildingTriangles", [](auto& c) { c.buildings[0].triangleCount = 13; }, {"building[0].first_triangle"}},
        Spoiled{"buildingWindows", [](auto& c) { c.buildings[0].firstWindow = 1; }, {"building[0].first_window"}},
        Spoiled{"buildingOverflow", [](auto& c) { c.buildings[0].windowCount = 0xffffffff; }, {"building[0].first_window"}},
        Spoiled{"windowBuilding", [](auto& c) { c.windows[4].building = 3; }, {"window[4].building is 3"}},
        Spoiled{"windowOfNone", [](auto& c) { c.buildings[0].windowCount = 79; }, {"window[79].building is 0"}},
        Spoiled{"centre", [](auto& c) { c.windows[4].centre.x = kInfinity; }, {"window[4].centre", "inf"}},
        Spoiled{"power", [](auto& c) { c.windows[4].power = -1; }, {"window[4].power is -1"}},
        Spoiled{"powerNaN", [](auto& c) { c.windows[4].power = kNaN; }, {"window[4].power is nan"}},
        Spoiled{"colour", [](auto& c) { c.windows[4].colour.y = -1; }, {"window[4].colour"}},
        Spoiled{"brightness", [](auto& c) { c.windows[4].power = 3e38f; c.windows[4].colour = vec3(3); }, {"window[4].colour", "times the power"}},
        Spoiled{"emptyPane", [](auto& c) { c.windows[4].halfV = vec3(0); }, {"window[4].half_u"}},
        Spoiled{"shearedPane", [](auto& c) { c.windows[4].halfV.x = c.windows[4].halfV.y = 0.75f; }, {"window[4].half_u", "right angles"}},
        Spoiled{"sphere", [](auto& c) { c.windows[4].flags = kWindowSphere; c.windows[4].halfU = vec3(0); }, {"window[4].half_u", "radius"}},
        Spoiled{"flags", [](auto& c) { c.windows[4].flags = 4; }, {"window[4].flags is 4"}},
        Spoiled{"windowId", [](auto& c) { c.windows[4].windowId = 3; }, {"window[4].window_id is 3"}},
        Spoiled{"sparseIds", [](auto& c) { c.windows[4].windowId = c.windows[9].windowId = 0xfffffff0; }, {"window[9].window_id is 4294967280"}},
        Spoiled{"flatBox", [](auto& c) { c.mediaBoxes[2].hi.z = c.mediaBoxes[2].lo.z; }, {"media_box[2].hi.z", "greater than lo"}},
        Spoiled{"extinction", [](auto& c) { c.mediaBoxes[2].extinction = kNaN; }, {"media_box[2].extinction is nan"}},
        Spoiled{"albedo", [](auto& c) { c.mediaBoxes[2].albedo = 1.1f; }, {"media_box[2].albedo is 1.1"}},
        Spoiled{"mediaId", [](auto& c) { c.mediaBoxes[2].mediaId = -1; }, {"media_box[2].media_id is -1"}},
        Spoiled{"mediaIdTwice", [](auto& c) { c.mediaBoxes[2].mediaId = 1; }, {"media_box[2].media_id is 1"}},
        Spoiled{"reserved", [](auto& c) { c.mediaBoxes[2].reserved = 1; }, {"media_box[2].reserved is 1"}},
        Spoiled{"listRange", [](auto& c) { c.mediaBoxes[2].lightCount = 0xffffffff; }, {"media_box[2].first_light"}},
        Spoiled{"listWindow", [](auto& c) { c.lightList[3] = 80; }, {"light_list[3] is 80"}},
        Spoiled{"listOrder", [](auto& c) { c.lightList[3] = c.lightList[2]; }, {"light_list[3]", "must rise"}},
        Spoiled{"overlap", [](auto& c) { c.mediaBoxes[2].lo.x -= 0.5f; }, {"mediaId 1 and 2 overlap"}},
        Spoiled{"eventOrder", [](auto& c) { c.windowEvents = {{4, 3, 0}, {2, 3, 1}}; }, {"window_event[1].frame is 2"}},
        Spoiled{"eventTwice", [](auto& c) { c.windowEvents = {{2, 3, 0}, {2, 3, 1}}; }, {"window_event[1].frame is 2"}},
        Spoiled{"eventWindow", [](auto& c) { c.windowEvents = {{2, 80, 0}}; }, {"window_event[0].window is 80"}},
        Spoiled{"eventState", [](auto& c) { c.windowEvents = {{2, 3, 2}}; }, {"window_event[0].on is 2"}},
        Spoiled{"eventFrame", [](auto& c) { c.windowEvents = {{kNaN, 3, 1}}; }, {"window_event[0].frame is nan"}},
        Spoiled{"cameraMirrored", [](auto& c) { c.cameras[1].frames[0].right *= -1.0f; }, {"camera_frame[1].forward", "right x up"}},
        Spoiled{"cameraLength", [](auto& c) { c.cameras[1].frames[0].up *= 1.1f; }, {"camera_frame[1].up"}},
        Spoiled{"cameraFov", [](auto& c) { c.cameras[1].frames[0].tanHalfFov = 0; }, {"camera_frame[1].tan_half_fov is 0"}},
        Spoiled{"cameraShift", [](auto& c) { c.cameras[1].frames[0].shiftY = kInfinity; }, {"camera_frame[1].shift_y is inf"}},
        Spoiled{"cameraPosition", [](auto& c) { c.cameras[1].frames[0].position.z = kNaN; }, {"camera_frame[1].position"}}),
    [](const auto& info) { return info.param.name; });

TEST(SceneFile, MissingFolderIsNamed) {
    try {
        loadScene("no-such.scene");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("no-such.scene/scene.json: cannot be opened"),
                  std::string::npos)
            << error.what();
    }
}

void writeText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

std::string readText(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SceneFile, DeeplyNestedManifestIsRefused) {
    const TemporaryFolder folder;
    const std::string open(2000000, '['), close(2000000, ']');
    writeText(folder.path() / "scene.json", "{\"format\":" + open + close + "}");
    EXPECT_THROW(loadScene(folder.path()), SceneError);
    writeText(folder.path() / "scene.json", open);
    EXPECT_THROW(loadScene(folder.path()), SceneError);
}

TEST(SceneFile, TruncatedFilesAreRefused) {
    const TemporaryFolder folder;
    paperCity(1).write(folder.path());
    for (const char* name : {"scene.json", "scene.bin"}) {
        const std::string whole = readText(folder.path() / name);
        for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 60) {
            writeText(folder.path() / name, whole.substr(0, length));
            EXPECT_THROW(loadScene(folder.path()), SceneError) << name << " of " << length;
        }
        writeText(folder.path() / name, whole);
        EXPECT_NO_THROW(loadScene(folder.path()));
    }
}

// Random bytes of the manifest: an error or, where the change has no meaning (a
// note, a prim's name), a scene. Nothing else, and no memory fault.
TEST(SceneFile, SurvivesRandomManifests) {
    const TemporaryFolder folder;
    paperCity(1).write(folder.path());
    const std::string whole = readText(folder.path() / "scene.json");
    std::mt19937 random(1);
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        std::string spoiled = whole;
        for (int change = 0; change <= round % 3; ++change) {
            spoiled[random() % spoiled.size()] = char(random() % 256);
        }
        writeText(folder.path() / "scene.json", spoiled);
        try {
            loadScene(folder.path());
        } catch (const SceneError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 200);
}

// Random bits of the binary under a hash that fits: what the loader accepts must
// be safe to use.
TEST(SceneFile, SurvivesRandomRecords) {
    std::mt19937 random(2);
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        SceneBuilder city = paperCity(1);
        city.editBinary = [&](std::vector<std::uint8_t>& bytes) {
            bytes[random() % bytes.size()] ^= std::uint8_t(1u << random() % 8);
        };
        try {
            const FlatScene scene = city.load();
            for (const MediaBox& box : scene.mediaBoxes) {
                for (const uint window : scene.lightList.subspan(box.firstLight, box.lightCount)) {
                    ASSERT_TRUE(std::isfinite(scene.windows[window].power));
                }
            }
        } catch (const SceneError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace nightcity
