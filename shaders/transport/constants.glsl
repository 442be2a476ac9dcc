// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#ifndef NIGHTCITY_TRANSPORT_CONSTANTS_GLSL
#define NIGHTCITY_TRANSPORT_CONSTANTS_GLSL

const float kPi = 3.14159265358979324;
const float kInverse4Pi = 0.0795774715459476679;  // 1 / (4 pi): isotropic phase, 1/sr

#endif
