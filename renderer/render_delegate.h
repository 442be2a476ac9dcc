// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The renderer as a render delegate has it: create, sync what changed, render a
// product, resolve the image. A Hydra delegate would be a thin wrapper.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frame.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

struct DeviceOptions {
    std::string device;       // part of a name, or an index of listDevices; empty: the best
    std::optional<std::uint64_t> memoryBytes;  // most that may be held on it; none: no limit
    bool validation = false;  // core and synchronization validation; a message is an error
};

// One line a device: index, name, driver, and what it lacks for rendering, if anything.
std::vector<std::string> listDevices();

// What of the scene is new since the last sync.
struct SceneChanges {
    bool geometry = true;    // triangles, facades, materials, media boxes
    bool windowState = true; // which windows are on (frame), cap, storage
};

using ProgressCallback = std::function<void(double done)>;  // 0 to 1

class RenderDelegate {
public:
    // Throws DeviceError where no device will do, naming what is missing.
    static std::unique_ptr<RenderDelegate> create(const DeviceOptions& options);
    virtual ~RenderDelegate() = default;

    // Bytes that the device will hold at most while the product is baked and rendered. Throws
    // DeviceError with the figure where that is more than DeviceOptions allows.
    virtual std::uint64_t planMemory(const FlatScene& scene, const RenderProduct& product,
                                     const RenderSettings& settings) = 0;
    // The scene must outlive the delegate or the next sync. `settings` gives cap and storage.
    // `camera` is that of the shot: where it is at any frame chooses what is baked how finely.
    // `progress` is called while a bake goes on; what it throws ends the bake.
    virtual void sync(const FlatScene& scene, const std::string& camera, int frame,
                      const RenderSettings& settings, const SceneChanges& changes,
                      const ProgressCallback& progress = {}) = 0;
    virtual void render(const RenderProduct& product, const RenderSettings& settings,
                        const ProgressCallback& progress) = 0;
    virtual Frame resolve() = 0;                       // of the last render
    virtual RenderStatistics statistics() const = 0;
    // Sentences for the user: what was chosen differently from what was asked, and why.
    virtual std::vector<std::string> notes() const = 0;
};

}  // namespace nightcity
