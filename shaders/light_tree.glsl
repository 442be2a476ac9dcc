// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses one of the lit windows, near and strong ones rather than others, and says
// with what probability: the same number whether it was drawn or is only asked for.
#ifndef NIGHTCITY_SHADERS_LIGHT_TREE_GLSL
#define NIGHTCITY_SHADERS_LIGHT_TREE_GLSL

#include "camera_ray.glsl"
#include "path_random.glsl"
#include "transport/light_importance.h"

layout(constant_id = NIGHTCITY_CONSTANT_EMITTER) const uint kEmitter = kEmitterIsotropic;

// What the windows are to light: a point, or a part of a ray.
struct LightQuery {
    Ray ray;           // its origin is the point
    float begin, end;  // m, of the part; end < begin for a point
    float extinction;  // 1/m, at the point
};

LightQuery lightsAt(vec3 point, float extinction) {
    return LightQuery(Ray(point, vec3(0.0)), 0.0, -1.0, extinction);
}

LightQuery lightsAlong(Ray ray, float begin, float end) {
    return LightQuery(ray, begin, end, 0.0);
}

struct LightChoice {
    uint window;  // or kNone
    float probability;
};

float importance(uint index, LightQuery query) {
    LightNode node = LightNodeArray(sceneTable.lightNodes).at[index];
    bool cosines = kEmitter != kEmitterIsotropic;
    return query.end < query.begin
               ? importanceAt(node, query.ray.origin, query.extinction, cosines)
               : importanceAlong(node, query.ray.origin, query.ray.direction, query.begin,
                                 query.end, cosines);
}

// Of the first child of a node; negative where neither child shines.
float firstProbability(uint index, uint second, LightQuery query) {
    float a = importance(index + 1, query);
    float b = importance(second, query);
    return a + b > 0.0 ? a / (a + b) : -1.0;
}

LightChoice chooseLight(LightQuery query, inout RandomStream random) {
    LightChoice choice = LightChoice(kNone, 0.0);
    if (sceneTable.lightNodes == uvec2(0)) {
        return choice;
    }
    float probability = 1.0;
    uint index = 0;
    uint child = LightNodeArray(sceneTable.lightNodes).at[index].child;
    while ((child & kLightLeaf) == 0u) {
        float first = firstProbability(index, child, query);
        if (first < 0.0) {
            return choice;
        }
        bool takeFirst = nextRandom(random) < first;
        probability *= takeFirst ? first : 1.0 - first;
        index = takeFirst ? index + 1 : child;
        child = LightNodeArray(sceneTable.lightNodes).at[index].child;
    }
    return LightChoice(child & ~kLightLeaf, probability);
}

// With which chooseLight takes a lit window.
float lightProbability(LightQuery query, uint window) {
    uint trail = UintArray(sceneTable.lightTrails).at[window];
    float probability = 1.0;
    uint index = 0;
    uint child = LightNodeArray(sceneTable.lightNodes).at[index].child;
    for (; (child & kLightLeaf) == 0u && probability > 0.0; trail >>= 1) {
        float first = max(firstProbability(index, child, query), 0.0);
        bool isSecond = (trail & 1u) != 0u;
        probability *= isSecond ? 1.0 - first : first;
        index = isSecond ? child : index + 1;
        child = LightNodeArray(sceneTable.lightNodes).at[index].child;
    }
    return probability;
}

#endif
