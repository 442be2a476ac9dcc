// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_file.h"

#include "scene/checks.h"
#include "scene/content_hash.h"
#include "scene/fault.h"
#include "scene/manifest.h"
#include "scene/mapped_file.h"
#include "scene/number_checks.h"

namespace nightcity {

namespace {

void checkBinary(const Manifest& manifest, std::span<const std::byte> bytes,
                 const std::filesystem::path& file) {
    if (bytes.size() != manifest.binaryBytes) {
        failScene(file, "the file", std::to_string(bytes.size()) + " bytes long",
                  "scene.json says " + std::to_string(manifest.binaryBytes) +
                      "; the copy is not whole, or the two files do not belong together: " +
                      kExportAgain);
    }
    const std::string hash = contentHash(bytes);
    if (hash != manifest.binaryHash) {
        failScene(file, "the hash", hash,
                  "scene.json says '" + manifest.binaryHash +
                      "'; the bytes were changed or do not belong together: " + kExportAgain);
    }
}

template <typename Record>
void view(std::span<const Record>& target, SceneArray name, const Manifest& manifest,
          std::span<const std::byte> bytes) {
    const ArrayRange& range = manifest.array(name);
    if (range.count > 0) {
        target = {reinterpret_cast<const Record*>(bytes.data() + range.offset),
                  std::size_t(range.count)};
    }
}

void viewArrays(FlatScene& scene, const Manifest& manifest, std::span<const std::byte> bytes) {
    view(scene.positions, SceneArray::position, manifest, bytes);
    view(scene.texcoords, SceneArray::texcoord, manifest, bytes);
    view(scene.triangles, SceneArray::triangle, manifest, bytes);
    view(scene.buildings, SceneArray::building, manifest, bytes);
    view(scene.materials, SceneArray::material, manifest, bytes);
    view(scene.texels, SceneArray::texel, manifest, bytes);
    view(scene.windows, SceneArray::window, manifest, bytes);
    view(scene.mediaBoxes, SceneArray::mediaBox, manifest, bytes);
    view(scene.lightList, SceneArray::lightList, manifest, bytes);
    view(scene.windowEvents, SceneArray::windowEvent, manifest, bytes);
}

void viewCameras(FlatScene& scene, const Manifest& manifest, std::span<const std::byte> bytes,
                 const std::filesystem::path& file) {
    std::span<const CameraFrame> cameraFrames;
    view(cameraFrames, SceneArray::cameraFrame, manifest, bytes);
    checkCameras(cameraFrames, file);
    for (const CameraEntry& entry : manifest.cameras) {
        scene.cameras.push_back({entry.name, entry.prim, entry.firstFrame,
                                 cameraFrames.subspan(entry.first, entry.count)});
    }
}

}  // namespace

FlatScene loadScene(const std::filesystem::path& folder) {
    const std::filesystem::path manifestFile = folder / "scene.json";
    const std::filesystem::path binaryFile = folder / "scene.bin";
    const MappedFile manifestBytes(manifestFile);
    Manifest manifest = parseManifest(manifestBytes.bytes(), manifestFile);
    const auto binary = std::make_shared<MappedFile>(binaryFile);
    checkBinary(manifest, binary->bytes(), binaryFile);

    FlatScene scene;
    viewArrays(scene, manifest, binary->bytes());
    viewCameras(scene, manifest, binary->bytes(), binaryFile);
    scene.ground = manifest.ground;
    scene.frames = manifest.frames;
    scene.defaults = std::move(manifest.defaults);
    scene.origin = manifest.origin;
    scene.hash = contentHash(manifestBytes.bytes());
    scene.generator = std::move(manifest.generator);
    scene.notes = std::move(manifest.notes);
    scene.file = binary;
    checkGeometry(scene, binaryFile);
    checkBuildings(scene, binaryFile);
    checkWindows(scene, binaryFile);
    checkMedia(scene, binaryFile);
    scene.dropPages();
    return scene;
}

}  // namespace nightcity
