// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Counts what the passes compute, in 64 bits.
#ifndef NIGHTCITY_SHADERS_COUNTERS_GLSL
#define NIGHTCITY_SHADERS_COUNTERS_GLSL

#include "addresses.glsl"

void countLights(uint lightSegments) {
    if (lightSegments == 0u) {
        return;
    }
    CountersReference counters = CountersReference(frameTable.counters);
    uint old = atomicAdd(counters.counters.lightSegmentsLow, lightSegments);
    if (old + lightSegments < old) {
        atomicAdd(counters.counters.lightSegmentsHigh, 1u);
    }
}

#endif
