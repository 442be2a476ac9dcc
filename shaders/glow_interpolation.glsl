// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Glow and optical depth between the rays of a cell (vec4: rgb and depth).
#ifndef NIGHTCITY_SHADERS_GLOW_INTERPOLATION_GLSL
#define NIGHTCITY_SHADERS_GLOW_INTERPOLATION_GLSL

#include "glow_cells.glsl"

// The corners of a cell and, where all of them see its plane, the next ones around: point (i, j)
// is kGlowCell (i - 1, j - 1) from the first.
struct GlowPatch {
    vec4 at[16];
    bool isWhole;  // all are there
};

// Of a cell that sees one plane.
GlowPatch glowPatch(ivec2 cell, GlowTable table) {
    CellSpan span = cellSpan(cell, table);
    GlowPatch patch_;
    patch_.isWhole = all(equal(span.last - span.first, ivec2(kGlowCell))) && all(greaterThan(cell, ivec2(0))) &&
                     all(lessThan(span.last + int(kGlowCell), ivec2(frameTable.width, table.rows)));
    uint plane = planeSeen(span.first);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            bool isCorner = (i == 1 || i == 2) && (j == 1 || j == 2);
            ivec2 at = isCorner ? ivec2(i == 1 ? span.first.x : span.last.x,
                                        j == 1 ? span.first.y : span.last.y)
                                : span.first + int(kGlowCell) * (ivec2(i, j) - 1);
            if (!isCorner && patch_.isWhole) {
                patch_.isWhole = planeSeen(at) == plane;
            }
            patch_.at[4 * j + i] = isCorner || patch_.isWhole ? valueAt(at, table) : vec4(0.0);
        }
    }
    return patch_;
}

// Of a cell whose patch is known to be whole.
GlowPatch wholePatch(ivec2 cell, GlowTable table) {
    GlowPatch patch_;
    patch_.isWhole = true;
    for (int k = 0; k < 16; ++k) {
        patch_.at[k] = valueAt((cell + ivec2(k & 3, k >> 2) - 1) * int(kGlowCell), table);
    }
    return patch_;
}

// Weights of four points, one apart, at a share of the way from the second to the third:
// Lagrange's cubic, or the straight line.
vec4 cubicWeights(float f) {
    float a = f + 1.0;
    float b = f - 1.0;
    float c = f - 2.0;
    return vec4(-f * b * c / 6.0, 0.5 * a * b * c, -0.5 * a * f * c, a * f * b / 6.0);
}

vec4 alongRow(GlowPatch points, int row, vec4 weights) {
    return weights.x * points.at[4 * row] + weights.y * points.at[4 * row + 1] +
           weights.z * points.at[4 * row + 2] + weights.w * points.at[4 * row + 3];
}

vec4 inPatch(GlowPatch points, vec4 across, vec4 down) {
    return down.x * alongRow(points, 0, across) + down.y * alongRow(points, 1, across) +
           down.z * alongRow(points, 2, across) + down.w * alongRow(points, 3, across);
}

// Weights of three points, two pixels apart, at a pixel from 0 to 4: the parabola.
vec3 parabolaWeights(int pixel) {
    float x = 0.5 * float(pixel);
    return vec3(0.5 * (x - 1.0) * (x - 2.0), x * (2.0 - x), 0.5 * x * (x - 1.0));
}

// The corners of the quarters of a whole cell: point (i, j) is (2 i, 2 j) pixels from the first.
struct GlowQuarters {
    vec4 at[9];
};

GlowQuarters glowQuarters(ivec2 cell, GlowTable table) {
    CellSpan span = cellSpan(cell, table);
    GlowQuarters quarters;
    for (int k = 0; k < 9; ++k) {
        quarters.at[k] = valueAt(min(span.first + 2 * ivec2(k % 3, k / 3), span.last), table);
    }
    return quarters;
}

// On the parabolas through the nine.
vec4 inQuarters(GlowQuarters points, vec3 across, vec3 down) {
    vec4 rows[3];
    for (int j = 0; j < 3; ++j) {
        rows[j] = across.x * points.at[3 * j] + across.y * points.at[3 * j + 1] +
                  across.z * points.at[3 * j + 2];
    }
    return down.x * rows[0] + down.y * rows[1] + down.z * rows[2];
}

// Between the corners of the quarter that holds a pixel of the cell.
vec4 straightInQuarter(GlowQuarters points, int x, int y) {
    int low = 3 * (y >> 1) + (x >> 1);
    int right = x & 1;
    int down = 3 * (y & 1);
    return 0.25 * (points.at[low] + points.at[low + right] + points.at[low + down] +
                   points.at[low + right + down]);
}

float largest(vec4 value) {
    return max(value.r, max(value.g, value.b));
}

// Of a difference between two ways to interpolate, as a share of the least of four corners: that
// of glow, or of depth, which has a kink where the haze has an edge and may hide it in the glow.
float shareOf(vec4 apart, vec4 one, vec4 other, vec4 third, vec4 fourth) {
    vec4 low = min(min(one, other), min(third, fourth));
    return max(largest(apart) / max(largest(low), 1e-30), apart.w / max(low.w, 1e-30));
}

// What the cubic and the straight line differ by halfway between two corners of the cell, the most
// of its four sides, as shareOf has it.
float bendOfPatch(GlowPatch points) {
    vec4 most = vec4(0.0);
    for (int k = 1; k <= 2; ++k) {
        int row = 4 * k;
        most = max(most, abs(points.at[row + 1] + points.at[row + 2] - points.at[row] -
                             points.at[row + 3]));
        most = max(most, abs(points.at[4 + k] + points.at[8 + k] - points.at[k] -
                             points.at[12 + k]));
    }
    return shareOf(most / 16.0, points.at[5], points.at[6], points.at[9], points.at[10]);
}

// What the parabola and the straight line differ by halfway along a quarter, the most of all,
// as shareOf has it.
float bendOfQuarters(GlowQuarters points) {
    vec4 most = vec4(0.0);
    for (int k = 0; k < 3; ++k) {
        most = max(most, abs(points.at[3 * k] - 2.0 * points.at[3 * k + 1] +
                             points.at[3 * k + 2]));
        most = max(most, abs(points.at[k] - 2.0 * points.at[k + 3] + points.at[k + 6]));
    }
    return shareOf(most / 8.0, points.at[0], points.at[2], points.at[6], points.at[8]);
}

// Between the corners of the quarter whose first is point `low`: the largest less the smallest.
float riseOfQuarter(GlowQuarters points, int low) {
    vec4 right = points.at[low + 1];
    vec4 down = points.at[low + 3];
    vec4 across = points.at[low + 4];
    return largest(max(max(points.at[low], right), max(down, across)) -
                   min(min(points.at[low], right), min(down, across)));
}

#endif
