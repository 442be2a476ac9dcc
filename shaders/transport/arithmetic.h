// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets transport formulas be written once, in the common part of C++ (with GLM)
// and GLSL: the mathematical functions by their GLSL names. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_ARITHMETIC_H
#define NIGHTCITY_TRANSPORT_ARITHMETIC_H

#include "../shared/language.h"

#ifdef __cplusplus
#define NIGHTCITY_FUNCTION inline
NIGHTCITY_BEGIN
using glm::abs;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::sin;
using glm::sqrt;
NIGHTCITY_END
#else
#define NIGHTCITY_FUNCTION
#endif

#endif
