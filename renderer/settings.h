// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What to render and how: filled from the command line, checked before any
// work, then passed on as const.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "aovs.h"

namespace nightcity {

// Which physics (the model). Enumerators are added as the renderer learns them.
enum class Lights { listed, all };
enum class Visibility { none, full };
enum class Emitter { isotropic, lambertian, pane };
enum class Scattering { single, multiple };
enum class Surfaces { dim, lit };

// How its integral is computed.
enum class Method {
    march,      // N equal steps a segment, midpoints, on the GPU
    gauss,      // quadrature over the visible part of each window's light, on the GPU
    field,      // far fluence baked on a grid, near windows along each ray, on the GPU
    path,       // unbiased Monte Carlo, on the GPU
    reference,  // in double precision, on the CPU: the same march, or the exact integral
};
enum class MarchOrder { steps, lights };        // which loop is outside
enum class LightStorage { uniform, storage };   // where the light lists live
enum class Filter { box, gauss };
// How the triangles that the camera sees are found on the device.
enum class Primary {
    raster,  // where device, scene and frame allow, else as rays
    rays,    // ray queries
};

// Method::field: along which pixels' rays glow is integrated.
enum class GlowRays {
    sparse,  // as few as the tolerance allows; the other pixels are interpolated
    all,
};

struct Model {
    Lights lights = Lights::listed;
    Visibility visibility = Visibility::none;
    Emitter emitter = Emitter::isotropic;
    Scattering scattering = Scattering::single;
    Surfaces surfaces = Surfaces::dim;

    bool operator==(const Model&) const = default;
};

// Of events on the way from a window to the eye: scattering in haze, reflection by surfaces.
struct Orders {
    std::uint32_t first = 1;
    std::optional<std::uint32_t> last;  // none: all that follow

    bool operator==(const Orders&) const = default;
};

// RenderSettings::bricks
inline constexpr std::uint32_t kLeastBricks = 64, kMostBricks = 1'000'000;

inline constexpr double kFieldTolerance = 0.01;  // of Method::field, where none is given

struct RenderSettings {
    Model model;
    Method method = Method::march;
    MarchOrder marchOrder = MarchOrder::lights;
    LightStorage lightStorage = LightStorage::uniform;
    std::uint32_t subdivisions = 25;         // steps a segment, at least 1
    // m; with Lights::all: what is farther from a window's centre gets no light of it. Unset: all do.
    std::optional<double> reach;
    std::optional<std::uint32_t> lightCap;   // at most this many lit windows a box, the nearest ids first
    // Relative error of a pixel's glow. Method::field: in 95 of 100 pixels. Method::reference: exact
    // to a tenth of this; unset: the march.
    std::optional<double> tolerance;
    // Method::path:
    std::uint32_t samples = 64;              // paths a pixel sample, at least 1
    Orders orders;                           // within those of model.scattering
    float anisotropy = 0;                    // g of Henyey and Greenstein, within (-1, 1)
    GlowRays glowRays = GlowRays::sparse;
    std::optional<std::uint32_t> bricks;     // of Method::field's baked part, most; unset: by the scene
    bool media = true;                       // off: the surface frame
    bool writeOnly = false;                  // with media off: write the images, look at nothing
    Primary primary = Primary::raster;
    std::uint32_t pixelSamples = 1;
    Filter filter = Filter::box;             // with 1 sample: the pixel centre
    std::uint64_t seed = 0;
};

// Rows of a frame, from the top.
struct RowRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

// One image: where from, how large, which pixels.
struct RenderProduct {
    std::string camera;
    int frame = 1;
    glm::vec3 cameraOffset{0};  // m, added to the camera's position (repeats move it)
    std::uint32_t width = 1920;
    std::uint32_t height = 1061;
    std::vector<glm::uvec2> pixels;  // only these, in this order; empty: all
    std::uint32_t aovs = kAllAovs;   // images of the frame that matter (aovs.h)
    std::optional<RowRange> tile;    // without a pixel list: only these rows, at least one

    RowRange rows() const { return tile.value_or(RowRange{0, height}); }
};

}  // namespace nightcity
