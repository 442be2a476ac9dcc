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
    float nearShare;   // of all choices those among nearLights, which were found for this ray
};

LightQuery lightsAt(vec3 point, float extinction) {
    return LightQuery(Ray(point, vec3(0.0)), 0.0, -1.0, extinction, 0.0);
}

// Of one ray. The tree knows of a window that a ray nearly touches only at its last levels, and
// chooses it far too seldom: they are looked for once and chosen as often as by the tree.
NearLights nearLights;
const float kNearShare = 0.5;
const uint kDeepestLight = 32u;  // levels of the tree

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

LightChoice chooseByTree(LightQuery query, inout RandomStream random) {
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

// With which chooseByTree takes a lit window.
float treeProbability(LightQuery query, uint window) {
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

uint chooseNear(float u) {
    uint window = kNone;
    for (uint k = 0u; k < kNearLights; ++k) {
        window = nearLights.chance[k] > 0.0 && u >= 0.0 ? nearLights.window[k] : window;
        u -= nearLights.chance[k];
    }
    return window;
}

// With which chooseLight takes a lit window.
float lightProbability(LightQuery query, uint window) {
    float probability = treeProbability(query, window);
    if (query.nearShare > 0.0) {
        float chance = 0.0;
        for (uint k = 0u; k < kNearLights; ++k) {
            chance += nearLights.window[k] == window ? nearLights.chance[k] : 0.0;
        }
        probability = mix(probability, chance, query.nearShare);
    }
    return probability;
}

LightChoice chooseLight(LightQuery query, inout RandomStream random) {
    if (query.nearShare <= 0.0) {
        return chooseByTree(query, random);
    }
    LightChoice choice;
    if (nextRandom(random) < query.nearShare) {
        choice.window = chooseNear(nextRandom(random));
    } else {
        choice = chooseByTree(query, random);
    }
    choice.probability = choice.window == kNone ? 0.0 : lightProbability(query, choice.window);
    return choice;
}

// The most that one of a node's windows brings, if they are all of the same power.
float mostOfOne(LightNode node, Ray ray, float begin, float end) {
    vec3 way = nodeCentre(node) - ray.origin;
    vec3 nearest = way - clamp(dot(way, ray.direction), begin, end) * ray.direction;
    float across = dot(abs(nearest), 0.5 * (node.hi - node.lo));
    float distance2 = squared(nearest);
    float distance = (distance2 - across) * inversesqrt(max(distance2, 1e-20));
    return kPi * node.power / (float(node.count) * max(distance, 1e-3));
}

// The share of choices for them.
float nearShareOf(NearLights lights) {
    return lights.chance[0] > 0.0 ? kNearShare : 0.0;
}

void insertNear(uint window, float score) {
    for (uint k = 0u; k < kNearLights; ++k) {
        bool swap = score > nearLights.chance[k];
        float lesser = swap ? nearLights.chance[k] : score;
        uint other = swap ? nearLights.window[k] : window;
        nearLights.chance[k] = swap ? score : nearLights.chance[k];
        nearLights.window[k] = swap ? window : nearLights.window[k];
        score = lesser;
        window = other;
    }
}

// Finds nearLights for the part [begin, end] of a ray.
void findNearLights(Ray ray, float begin, float end) {
    for (uint k = 0u; k < kNearLights; ++k) {
        nearLights.window[k] = kNone;
        nearLights.chance[k] = 0.0;
    }
    if (sceneTable.lightNodes == uvec2(0) || !(begin < end)) {
        return;
    }
    LightNodeArray nodes = LightNodeArray(sceneTable.lightNodes);
    LightQuery query = LightQuery(ray, begin, end, 0.0, 0.0);
    uint open[kDeepestLight];
    uint count = 1u;
    open[0] = 0u;
    while (count > 0u) {
        uint index = open[--count];
        LightNode node = nodes.at[index];
        if (mostOfOne(node, ray, begin, end) <= nearLights.chance[kNearLights - 1u]) {
            continue;
        }
        if ((node.child & kLightLeaf) != 0u) {
            insertNear(node.child & ~kLightLeaf, importance(index, query));
        } else {
            bool firstNearer = mostOfOne(nodes.at[index + 1u], ray, begin, end) >=
                               mostOfOne(nodes.at[node.child], ray, begin, end);
            open[count++] = firstNearer ? node.child : index + 1u;
            open[count++] = firstNearer ? index + 1u : node.child;
        }
    }
    float sum = 0.0;
    for (uint k = 0u; k < kNearLights; ++k) {
        sum += nearLights.chance[k];
    }
    for (uint k = 0u; k < kNearLights; ++k) {
        nearLights.chance[k] = sum > 0.0 ? nearLights.chance[k] / sum : 0.0;
    }
}

#endif
