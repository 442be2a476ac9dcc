// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where finished frames come from: the device or the reference, by the same calls.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "options.h"
#include "scene/flat_scene.h"

namespace nightcity {

class FrameSource {
public:
    virtual ~FrameSource() = default;
    virtual Frame render(const RenderProduct& product, const ProgressCallback& progress) = 0;
    virtual RenderStatistics statistics() const = 0;    // of the last frame
    virtual std::vector<std::string> notes() const = 0; // for the user
};

// The scene and the options must outlive it.
std::unique_ptr<FrameSource> makeFrameSource(const FlatScene& scene, const Options& options);

}  // namespace nightcity
