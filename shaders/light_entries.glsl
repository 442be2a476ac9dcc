// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The packed light lists (dispatch.h), in pages of uniform or storage buffers.
// A list may straddle pages.
#ifndef NIGHTCITY_SHADERS_LIGHT_ENTRIES_GLSL
#define NIGHTCITY_SHADERS_LIGHT_ENTRIES_GLSL

#extension GL_EXT_nonuniform_qualifier : require

#include "addresses.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_UNIFORM_PAGES) const uint kUniformPages = 1;
layout(constant_id = NIGHTCITY_CONSTANT_PAGE_COUNT) const uint kPageCount = 1;
layout(constant_id = NIGHTCITY_CONSTANT_PAGE_ENTRIES) const uint kPageEntries = 1024;

const uint kUniformPageCount = kUniformPages != 0u ? kPageCount : 1u;
const uint kStoragePageCount = kUniformPages != 0u ? 1u : kPageCount;
const uint kUniformPageEntries = kUniformPages != 0u ? kPageEntries : kUnusedPageEntries;

layout(set = 0, binding = NIGHTCITY_BINDING_UNIFORM_PAGES, std140) uniform UniformPage {
    vec4 entry[kUniformPageEntries];
} uniformPages[kUniformPageCount];

layout(set = 0, binding = NIGHTCITY_BINDING_STORAGE_PAGES, std430) readonly buffer StoragePage {
    vec4 entry[];
} storagePages[kStoragePageCount];

// A page is chosen by a constant where there is only one: that is what makes a small scene fast.
vec4 lightEntry(uint index) {
    if (kPageCount == 1u) {
        return kUniformPages != 0u ? uniformPages[0].entry[index] : storagePages[0].entry[index];
    }
    uint page = index / kPageEntries;
    uint slot = index % kPageEntries;
    return kUniformPages != 0u ? uniformPages[nonuniformEXT(page)].entry[slot]
                               : storagePages[nonuniformEXT(page)].entry[slot];
}

#endif
