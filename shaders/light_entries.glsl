// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The packed light lists: in pages of uniform buffers, or in storage. A list
// may straddle pages; an entry of two vec4 never does, for pages hold a power
// of two.
#ifndef NIGHTCITY_SHADERS_LIGHT_ENTRIES_GLSL
#define NIGHTCITY_SHADERS_LIGHT_ENTRIES_GLSL

#extension GL_EXT_nonuniform_qualifier : require

#include "addresses.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_UNIFORM_PAGES) const uint kUniformPages = 1;
layout(constant_id = NIGHTCITY_CONSTANT_PAGE_COUNT) const uint kPageCount = 1;
layout(constant_id = NIGHTCITY_CONSTANT_PAGE_ENTRIES) const uint kPageEntries = 1024;

layout(set = 0, binding = NIGHTCITY_BINDING_LIGHT_PAGES, std140) uniform LightPage {
    vec4 entry[kPageEntries];
} lightPages[kPageCount];

vec4 lightEntry(uint index) {
    if (kUniformPages == 0u) {
        return LightEntryArray(sceneTable.lightEntries).at[index];
    }
    if (kPageCount == 1u) {
        return lightPages[0].entry[index];
    }
    return lightPages[nonuniformEXT(index / kPageEntries)].entry[index % kPageEntries];
}

#endif
