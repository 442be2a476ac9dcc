// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The images that a frame can have, as bits: what is not asked for is not written.
#ifndef NIGHTCITY_SHADERS_AOVS_H
#define NIGHTCITY_SHADERS_AOVS_H

#include "language.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kAovBeauty = 1u;
NIGHTCITY_CONST uint kAovGlow = 2u;
NIGHTCITY_CONST uint kAovSurface = 4u;
NIGHTCITY_CONST uint kAovTransmittance = 8u;
NIGHTCITY_CONST uint kAovDepth = 16u;
NIGHTCITY_CONST uint kAovNormal = 32u;
NIGHTCITY_CONST uint kAovMediaId = 64u;
NIGHTCITY_CONST uint kAovMaterialId = 128u;
NIGHTCITY_CONST uint kAovGlowError = 256u;  // Monte Carlo only
NIGHTCITY_CONST uint kAovError = 512u;      // of --method field, as kAovCost
NIGHTCITY_CONST uint kAovCost = 1024u;
NIGHTCITY_CONST uint kAllAovs = 2047u;
NIGHTCITY_CONST uint kCommonAovs = 255u;    // that every method has
NIGHTCITY_CONST uint kLedgerAovs = kAovError | kAovCost;
NIGHTCITY_CONST uint kHazeAovs =
    kAovGlow | kAovTransmittance | kAovMediaId | kLedgerAovs;  // constant without

NIGHTCITY_END

#endif
