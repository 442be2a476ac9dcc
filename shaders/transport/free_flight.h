// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Optical depths at which light is scattered. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_FREE_FLIGHT_H
#define NIGHTCITY_TRANSPORT_FREE_FLIGHT_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

// 1 - exp(-depth), without its cancellation in thin haze.
NIGHTCITY_FUNCTION float collisionProbability(float depth) {
    return depth < 0.01f ? depth * (1.0f - depth * (0.5f - depth / 6.0f)) : 1.0f - exp(-depth);
}

// The optical depth before which a share of all light collides: -log(1 - share),
// share in [0, 1).
NIGHTCITY_FUNCTION float depthOfShare(float share) {
    return share < 0.01f ? share * (1.0f + share * (0.5f + share * (1.0f / 3.0f + share * 0.25f)))
                         : -log(1.0f - share);
}

NIGHTCITY_END

#endif
