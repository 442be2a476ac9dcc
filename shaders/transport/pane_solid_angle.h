// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A rectangular pane in its own frame: centre at the origin, sides along x and y, the
// bright side towards z > 0. Its solid angle from a point in front of it. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_PANE_SOLID_ANGLE_H
#define NIGHTCITY_TRANSPORT_PANE_SOLID_ANGLE_H

#include "polynomial_trig.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST float kPaneNearest = 1e-6f;  // m, a point is at least so far in front

struct PaneFrame {
    float a, b;           // half sides, m
    vec3 origin;          // of the ray, m
    vec3 direction;       // of the ray
};

// fromCentre: the ray's origin less the pane's centre. halfU and halfV are
// perpendicular; their cross product points to the bright side.
NIGHTCITY_FUNCTION PaneFrame paneFrame(vec3 fromCentre, vec3 direction, vec3 halfU, vec3 halfV) {
    PaneFrame pane;
    pane.a = sqrt(dot(halfU, halfU));
    pane.b = sqrt(dot(halfV, halfV));
    vec3 u = halfU / pane.a;
    vec3 v = halfV / pane.b;
    vec3 n = cross(u, v);
    pane.origin = vec3(dot(fromCentre, u), dot(fromCentre, v), dot(fromCentre, n));
    pane.direction = vec3(dot(direction, u), dot(direction, v), dot(direction, n));
    return pane;
}

// sr, 0 to 2 pi; z of the point at least kPaneNearest. The two triangles of van Oosterom
// and Strackee 1983, The solid angle of a plane triangle, equation 8: tan(angle / 2) = n / m,
// whose triple product n is z times the area of the pane for both, without
// rounding; their angles are added as those of complex numbers, by one arc. From afar all
// terms are sums, close to the pane the error grows as 1 / z near its edges and one
// diagonal (relative 1e-5 at a hundredth of a side).
NIGHTCITY_FUNCTION float paneSolidAngle(vec3 point, float a, float b) {
    float x0 = -a - point.x;
    float x1 = a - point.x;
    float y0 = -b - point.y;
    float y1 = b - point.y;
    float z2 = point.z * point.z;
    float l00 = sqrt(x0 * x0 + y0 * y0 + z2);
    float l10 = sqrt(x1 * x1 + y0 * y0 + z2);
    float l11 = sqrt(x1 * x1 + y1 * y1 + z2);
    float l01 = sqrt(x0 * x0 + y1 * y1 + z2);
    float across = x0 * x1 + y0 * y1 + z2;  // the diagonal's corners
    float below = l00 * l10 * l11 + (x0 * x1 + y0 * y0 + z2) * l11 +
                  (x1 * x1 + y0 * y1 + z2) * l00 + across * l10;
    float above = l00 * l01 * l11 + (x0 * x0 + y0 * y1 + z2) * l11 +
                  (x0 * x1 + y1 * y1 + z2) * l00 + across * l01;
    float n = 4.0f * a * b * point.z;
    return 2.0f * arcOf(max(n * (below + above), 0.0f), below * above - n * n);
}

// The distance by which light from the pane is attenuated at a point from which it has this
// solid angle, m: the mean over the solid angle, within 0.04 (median) and 0.18 (largest) of the
// side, a tenth of that from 4 sides away. (area z / solid angle)^(1/3) is the mean of
// d^-3 over the pane; close by light comes from the nearer parts, hence the factor.
NIGHTCITY_FUNCTION float paneMeanDistance(float area, float z, float solidAngle) {
    float share = solidAngle / (2.0f * kHalfTurn);
    return exp2(log2(area * z / solidAngle) / 3.0f) * (1.0f - 0.3f * share);
}

NIGHTCITY_END

#endif
