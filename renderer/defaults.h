// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a command line gets that leaves the model or the method open: decided here alone.
#pragma once

#include "settings.h"

namespace nightcity {

// --model single, the default: all windows, hidden by what stands before them, as panes.
inline constexpr Model kSingleModel{.lights = Lights::all,
                                    .visibility = Visibility::full,
                                    .emitter = Emitter::pane,
                                    .scattering = Scattering::single,
                                    .surfaces = Surfaces::dim};

// The fastest method that knows the model and holds the tolerance; `paths`: something that only
// paths know is asked for. Lit surfaces take the field minutes, and take paths none. What it says
// of a pixel must not depend on how many are asked for: neither frames nor pixels nor tiles decide.
inline Method defaultMethod(const RenderSettings& settings, bool paths) {
    const bool isFine = settings.tolerance.value_or(kFieldTolerance) < kFieldTolerance;
    const bool isListed = settings.model.lights == Lights::listed;
    if (settings.model.scattering == Scattering::multiple) {
        const bool isLit = settings.model.surfaces == Surfaces::lit;
        return paths || isLit || isListed || settings.reach ? Method::path : Method::field;
    }
    return isListed || settings.reach || isFine ? Method::gauss : Method::field;
}

}  // namespace nightcity
