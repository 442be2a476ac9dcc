// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/manifest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "scene/fault.h"
#include "scene/json_field.h"

namespace nightcity {

namespace {

constexpr std::uint64_t kAlignment = 64;  // bytes
constexpr std::uint64_t kMaxCount = 0xffffffff;  // indices are u32 and this one means none
constexpr std::uint64_t kMaxImageSide = 65536;   // pixels
constexpr std::size_t kMaxManifestBytes = std::size_t{1} << 28;

nlohmann::json parseJson(std::span<const std::byte> bytes, const std::filesystem::path& file) {
    if (bytes.size() > kMaxManifestBytes) {
        failScene(file, "the manifest", std::to_string(bytes.size()) + " bytes",
                  "a manifest is smaller than 256 MiB; export the stage again");
    }
    const char* first = reinterpret_cast<const char*>(bytes.data());
    try {
        return nlohmann::json::parse(first, first + bytes.size());
    } catch (const nlohmann::json::exception& error) {
        failScene(file, "the manifest", "no JSON",
                  std::string(error.what()) + "; export the stage again");
    }
}

ArrayRange readArray(const JsonField& entry, const RecordLayout& layout, std::uint64_t bytes) {
    entry.at("stride").mustBe(layout.stride);
    nlohmann::json wanted = nlohmann::json::array();
    for (const FieldLayout& field : layout.fields) {
        wanted.push_back({field.name, field.type, field.components, field.offset});
    }
    entry.at("fields").mustBe(wanted);
    ArrayRange range;
    range.count = entry.at("count").unsignedNumber(kMaxCount - 1);
    range.offset = entry.at("offset").unsignedNumber(std::numeric_limits<std::uint64_t>::max());
    if (range.offset % kAlignment != 0) {
        entry.at("offset").fail("must be a multiple of 64; export the stage again");
    }
    // count and stride are small enough that their product does not overflow.
    if (range.offset > bytes || range.count * layout.stride > bytes - range.offset) {
        entry.at("count").fail("the array ends past the " + std::to_string(bytes) +
                               " bytes of scene.bin; export the stage again");
    }
    return range;
}

void checkApart(const Manifest& manifest, const std::filesystem::path& file) {
    struct Extent {
        std::uint64_t begin, end;
        std::string_view name;
    };
    std::vector<Extent> extents;
    for (std::size_t i = 0; i < kSceneArrayCount; ++i) {
        const auto& layout = recordLayouts()[i];
        const auto& range = manifest.arrays[i];
        if (range.count > 0) {
            extents.push_back(
                {range.offset, range.offset + range.count * layout.stride, layout.name});
        }
    }
    std::sort(extents.begin(), extents.end(),
              [](const Extent& a, const Extent& b) { return a.begin < b.begin; });
    for (std::size_t i = 1; i < extents.size(); ++i) {
        if (extents[i].begin < extents[i - 1].end) {
            failScene(file, "arrays." + std::string(extents[i].name) + ".offset",
                      std::to_string(extents[i].begin),
                      "lies inside the array " + std::string(extents[i - 1].name) +
                          "; export the stage again");
        }
    }
}

void readBinary(const JsonField& root, Manifest& manifest) {
    const JsonField binary = root.at("binary");
    binary.at("file").mustBe("scene.bin");
    manifest.binaryBytes =
        binary.at("bytes").unsignedNumber(std::numeric_limits<std::int64_t>::max());
    manifest.binaryHash = binary.at("hash").string();
}

void readCameras(const JsonField& list, Manifest& manifest) {
    const std::uint64_t available = manifest.array(SceneArray::cameraFrame).count;
    std::set<std::string> names;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const JsonField entry = list.at(i);
        CameraEntry camera;
        camera.name = entry.at("name").string();
        if (camera.name.empty() || !names.insert(camera.name).second) {
            entry.at("name").fail("every camera needs a name of its own; rename the prim");
        }
        camera.prim = entry.at("prim").string();
        camera.firstFrame = entry.at("first_frame").integer();
        camera.first = entry.at("first").unsignedNumber(kMaxCount);
        camera.count = entry.at("count").unsignedNumber(kMaxCount);
        if (camera.count == 0 || camera.first > available ||
            camera.count > available - camera.first) {
            entry.at("count").fail("must be at least 1 and end within the " +
                                   std::to_string(available) + " records of camera_frame");
        }
        manifest.cameras.push_back(std::move(camera));
    }
}

void readGround(const JsonField& field, Manifest& manifest) {
    if (field.isNull()) {
        return;
    }
    GroundPlane ground;
    const double height = field.at("height").finiteNumber();
    ground.height = float(height);
    if (!std::isfinite(ground.height)) {
        field.at("height").fail("must be a finite 32-bit number of metres");
    }
    const std::uint64_t materials = manifest.array(SceneArray::material).count;
    const std::uint64_t material = field.at("material").unsignedNumber(kMaxCount);
    if (material >= materials) {
        field.at("material").fail("must be below the " + std::to_string(materials) + " materials");
    }
    ground.material = uint(material);
    manifest.ground = ground;
}

void readFrames(const JsonField& field, Manifest& manifest) {
    manifest.frames.first = field.at("first").integer();
    manifest.frames.last = field.at("last").integer();
    manifest.frames.perSecond = field.at("per_second").finiteNumber();
    if (manifest.frames.last < manifest.frames.first) {
        field.at("last").fail("must not come before frames.first; set the stage's end time code");
    }
    if (!(manifest.frames.perSecond > 0)) {
        field.at("per_second").fail("must be above 0; set timeCodesPerSecond on the stage");
    }
}

void readDefaults(const JsonField& field, Manifest& manifest) {
    RenderDefaults& defaults = manifest.defaults;
    const JsonField camera = field.at("camera");
    if (!camera.isNull()) {
        defaults.camera = camera.string();
        const auto named = [&](const CameraEntry& entry) { return entry.name == defaults.camera; };
        if (std::none_of(manifest.cameras.begin(), manifest.cameras.end(), named)) {
            camera.fail("no camera has this name; mend the stage's render settings");
        }
    }
    defaults.width = uint(field.at("width").unsignedNumber(kMaxImageSide));
    defaults.height = uint(field.at("height").unsignedNumber(kMaxImageSide));
    const JsonField aovs = field.at("aovs");
    for (std::size_t i = 0; i < aovs.size(); ++i) {
        defaults.aovs.push_back(aovs.at(i).string());
    }
}

}  // namespace

Manifest parseManifest(std::span<const std::byte> bytes, const std::filesystem::path& file) {
    const nlohmann::json json = parseJson(bytes, file);
    const JsonField root(file, "", json);
    root.at("format").mustBe("nightcity-scene");
    root.at("version").mustBe(1);
    root.at("byte_order").mustBe("little");
    root.at("up_axis").mustBe("z");
    root.at("units").mustBe({{"length", "m"},
                             {"power", "W"},
                             {"extinction", "1/m"},
                             {"radiance", "W m^-2 sr^-1"}});
    Manifest manifest;
    manifest.generator = root.at("generator").string();
    for (std::size_t i = 0; i < 3; ++i) {
        manifest.origin[i] = root.at("origin").at(i).finiteNumber();
    }
    readBinary(root, manifest);
    for (std::size_t i = 0; i < kSceneArrayCount; ++i) {
        const RecordLayout& layout = recordLayouts()[i];
        manifest.arrays[i] = readArray(root.at("arrays").at(std::string(layout.name)), layout,
                                       manifest.binaryBytes);
    }
    checkApart(manifest, file);
    readCameras(root.at("cameras"), manifest);
    readGround(root.at("ground"), manifest);
    readFrames(root.at("frames"), manifest);
    readDefaults(root.at("render"), manifest);
    const JsonField notes = root.at("notes");
    for (std::size_t i = 0; i < notes.size(); ++i) {
        manifest.notes.push_back(notes.at(i).string());
    }
    return manifest;
}

}  // namespace nightcity
