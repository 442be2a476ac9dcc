// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the node planes of the far field lie, so that borders of media, and with them walls and
// roofs, lie on them: across those the field has edges, which no interpolation follows.
#pragma once

#include <span>

#include "scene.h"
#include "settings.h"

namespace nightcity {

struct LatticeAlignment {
    float spacing = 1;  // m
    vec3 origin{0};     // m, a node; less than two spacings below the lower corner of the media
};

// Of all spacings from 0.8 `wanted` to `wanted` (m) the one on whose planes most borders of the media
// lie; of several the largest. Borders that share no pitch do no harm: then some lie on planes.
// Isotropic windows, a hair before their walls, have edges of shadows on the planes of those, where
// the others have no light: for them the borders lie in the middle between node planes.
LatticeAlignment alignLattice(std::span<const MediaBox> media, float wanted, Emitter emitter);

}  // namespace nightcity
