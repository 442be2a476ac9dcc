// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets the headers of this folder compile as C++ (with GLM) and as GLSL
// (GL_EXT_scalar_block_layout): the same records, byte for byte.
#ifndef NIGHTCITY_SHADERS_LANGUAGE_H
#define NIGHTCITY_SHADERS_LANGUAGE_H

#ifdef __cplusplus
#include <cstdint>

#include <glm/glm.hpp>
#define NIGHTCITY_BEGIN namespace nightcity {
#define NIGHTCITY_END }
NIGHTCITY_BEGIN
using glm::ivec2;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
NIGHTCITY_END
#define NIGHTCITY_CONST constexpr
#else
#define NIGHTCITY_BEGIN
#define NIGHTCITY_END
#define NIGHTCITY_CONST const
#endif

#endif
