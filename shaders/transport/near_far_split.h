// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The share of a window's fluence that is integrated along each ray (near); the rest (far)
// is smooth enough to live on a grid. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_NEAR_FAR_SPLIT_H
#define NIGHTCITY_TRANSPORT_NEAR_FAR_SPLIT_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

// y: (d / R)^2 with d the distance from the window's centre and R the near radius. 1 at the
// centre, 0 from R on, twice continuously differentiable there. The weight (1 - y)^3 alone
// leaves 3 / R^2 of 1 / d^2 at the centre, where a cosine emitter's lobe has a kink: the factor
// 1 + 3 y takes the far part to 0 there as 6 d^2 / R^4. At a node spacing of R / 4 its
// trilinear interpolation is off by a tenth of what it is without.
NIGHTCITY_FUNCTION float nearShare(float y) {
    float rest = max(1.0f - y, 0.0f);
    return rest * rest * rest * (1.0f + 3.0f * y);
}

// 1 - nearShare(y), without cancellation.
NIGHTCITY_FUNCTION float farShare(float y) {
    float inside = min(y, 1.0f);
    return inside * inside * (6.0f + inside * (-8.0f + 3.0f * inside));
}

// With the near share blurred over the ball of R: its n(y) / d^2 is taken for b n(y) / R^2. Both bring
// the same to the ball, whatever the lobe: b is the integral of n(u^2) over u from 0 to 1 over that
// of u^2 n(u^2), (64 / 105) / (64 / 693) = 33 / 5.
NIGHTCITY_FUNCTION float blurredShare(float y) {
    return farShare(y) + 6.6f * y * nearShare(y);
}

// What of a window's light nodes hold that are `spacing` apart: R, m, and the share within it. A blur
// is so wide that the nodes meet it.
NIGHTCITY_FUNCTION float splitRadius(float nearRadius, float spacing, bool isBlurred) {
    return isBlurred ? max(nearRadius, 2.0f * spacing) : nearRadius;
}
NIGHTCITY_FUNCTION float bakedShare(float y, bool isBlurred) {
    return isBlurred ? blurredShare(y) : farShare(y);
}

NIGHTCITY_END

#endif
