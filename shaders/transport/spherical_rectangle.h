// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Points of a rectangle, uniform in solid angle: Urena, Fajardo and King 2013, An
// area-preserving parametrization for spherical rectangles, EGSR. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_SPHERICAL_RECTANGLE_H
#define NIGHTCITY_TRANSPORT_SPHERICAL_RECTANGLE_H

#include "arithmetic.h"
#include "polynomial_trig.h"

NIGHTCITY_BEGIN

// As seen from the origin: the plane lies at z = z0 < 0, the sides along x and y.
struct SphericalRectangle {
    float x0, y0, z0, x1, y1;  // m
    float b0, b1, k;           // of the paper's listing
    float solidAngle;          // sr
};

NIGHTCITY_FUNCTION float arcCosine(float c) {
    float cosine = clamp(c, -1.0f, 1.0f);
    return arcOf(sqrt(max((1.0f - cosine) * (1.0f + cosine), 0.0f)), cosine);
}

// `corner`: the point with the least x and y, in the rectangle's axes, corner.z < 0.
NIGHTCITY_FUNCTION SphericalRectangle sphericalRectangle(vec3 corner, vec2 size) {
    SphericalRectangle r;
    r.x0 = corner.x;
    r.y0 = corner.y;
    r.z0 = corner.z;
    r.x1 = corner.x + size.x;
    r.y1 = corner.y + size.y;
    // The normals of the four sides' planes, of which only z and one other are not 0.
    float n0 = -r.y0 / sqrt(r.z0 * r.z0 + r.y0 * r.y0);
    float n1 = r.x1 / sqrt(r.z0 * r.z0 + r.x1 * r.x1);
    float n2 = r.y1 / sqrt(r.z0 * r.z0 + r.y1 * r.y1);
    float n3 = -r.x0 / sqrt(r.z0 * r.z0 + r.x0 * r.x0);
    float g0 = arcCosine(-n0 * n1);
    float g1 = arcCosine(-n1 * n2);
    float g2 = arcCosine(-n2 * n3);
    float g3 = arcCosine(-n3 * n0);
    r.b0 = n0;
    r.b1 = n2;
    r.k = 2.0f * kHalfTurn - g2 - g3;
    r.solidAngle = max(g0 + g1 - r.k, 0.0f);
    return r;
}

// u in [0, 1)^2 to (x, y) on the rectangle, m.
NIGHTCITY_FUNCTION vec2 rectanglePoint(SphericalRectangle r, vec2 u) {
    float au = u.x * r.solidAngle + r.k - kHalfTurn;  // in [-pi, pi], where sin and cos are precise
    float fu = (cos(au) * r.b0 + r.b1) / sin(au);
    float cu = 1.0f / sqrt(fu * fu + r.b0 * r.b0);
    cu = clamp(fu > 0.0f ? cu : -cu, -0.999999f, 0.999999f);
    float x = clamp(-(cu * r.z0) / sqrt(1.0f - cu * cu), r.x0, r.x1);
    float d = sqrt(x * x + r.z0 * r.z0);
    float h0 = r.y0 / sqrt(d * d + r.y0 * r.y0);
    float h1 = r.y1 / sqrt(d * d + r.y1 * r.y1);
    float h = h0 + u.y * (h1 - h0);
    float h2 = h * h;
    float y = h2 < 0.999999f ? h * d / sqrt(1.0f - h2) : r.y1;
    return vec2(x, clamp(y, r.y0, r.y1));
}

NIGHTCITY_END

#endif
