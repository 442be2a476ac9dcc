// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A finished image on the host, and what making it cost.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace nightcity {

// Sky pixels: depth of nothing, as other renderers write it.
inline constexpr float kSkyDepth = 1e10f;

// One value a pixel, row by row from the top left (or in the order of
// RenderProduct::pixels, as one row). Radiance in W m^-2 sr^-1, linear Rec. 709.
struct Frame {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    // beauty = surface + glow. Alpha: 1 where the ray ends on a surface, else 1 - transmittance.
    std::vector<glm::vec4> beauty;
    std::vector<glm::vec3> glow;
    std::vector<glm::vec3> surface;     // surfaces as seen through the haze: radiance x transmittance
    std::vector<glm::vec3> glowError;   // standard error of glow (Monte Carlo); 0 for other methods
    std::vector<float> error;           // estimated relative error of glow (Method::field); 0 for others
    std::vector<float> cost;            // evaluations along the pixel's own rays (Method::field)
    std::vector<float> transmittance;   // of all media before the surface (or of all, to the sky)
    // Of the sample nearest the pixel's centre, never averaged:
    std::vector<float> depth;           // m along the camera's axis, kSkyDepth where there is nothing
    std::vector<glm::vec3> normal;      // world, towards the camera; 0 for sky
    std::vector<float> mediaId;         // first media box on the ray, -1 for none
    std::vector<float> materialId;      // index of the material, -1 for sky and panes

    void resize(std::uint32_t w, std::uint32_t h);
};

struct PassTime {
    std::string name;
    double milliseconds = 0;
};

// To what the pass took before, or as the last pass.
inline void addPassTime(std::vector<PassTime>& passes, const std::string& name,
                        double milliseconds) {
    for (PassTime& pass : passes) {
        if (pass.name == name) {
            pass.milliseconds += milliseconds;
            return;
        }
    }
    passes.push_back({name, milliseconds});
}

// Whatever depends on the camera is frame; what depends only on the scene is bake.
struct RenderStatistics {
    double frameMilliseconds = 0;   // of the last render call, from submission to the last fence
    double bakeMilliseconds = 0;    // of the last sync: acceleration structures and tables
    std::vector<PassTime> bakePasses;  // of the last sync: of the far field, where it was baked
    std::vector<PassTime> passes;   // of the last render call, in order
    std::uint64_t lightEvaluations = 0;  // light terms computed by the last render call
    std::uint32_t lightPages = 0;
    std::string lightStorage;       // "uniform" or "storage", as it was, not as asked
    std::string device;
    std::uint64_t deviceMemoryBytes = 0;  // after the last render call
    std::uint64_t plannedBytes = 0;       // at most, as foretold; 0: was not asked
    std::uint64_t devicePeakBytes = 0;    // the most at any time
    std::map<std::string, std::uint64_t> deviceMemory;  // bytes by name, after the last render call
    std::uint64_t farFieldBytes = 0;     // of these, for Method::field
    std::uint64_t farFieldBricks = 0;
};

}  // namespace nightcity
