// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The arrays behind the addresses of SceneTable and FrameTable.
#ifndef NIGHTCITY_SHADERS_ADDRESSES_GLSL
#define NIGHTCITY_SHADERS_ADDRESSES_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require

#include "dispatch.h"
#include "facade.h"

#define NIGHTCITY_ARRAY(Name, Type)                                             \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Name {  \
        Type at[];                                                              \
    };

NIGHTCITY_ARRAY(FloatArray, float)
NIGHTCITY_ARRAY(UintArray, uint)
NIGHTCITY_ARRAY(Vec2Array, vec2)
NIGHTCITY_ARRAY(Vec3Array, vec3)
NIGHTCITY_ARRAY(Vec4Array, vec4)
NIGHTCITY_ARRAY(UvecArray, uvec2)
NIGHTCITY_ARRAY(TriangleArray, Triangle)
NIGHTCITY_ARRAY(MaterialArray, Material)
NIGHTCITY_ARRAY(WindowArray, Window)
NIGHTCITY_ARRAY(MediaBoxArray, MediaBox)
NIGHTCITY_ARRAY(MarchMediumArray, MarchMedium)
NIGHTCITY_ARRAY(FacadeArray, Facade)
NIGHTCITY_ARRAY(SurfaceRecordArray, SurfaceRecord)
NIGHTCITY_ARRAY(RayProgressArray, RayProgress)
NIGHTCITY_ARRAY(SegmentArray, Segment)
NIGHTCITY_ARRAY(LightNodeArray, LightNode)
NIGHTCITY_ARRAY(NearLightsArray, NearLights)
NIGHTCITY_ARRAY(PathSumsArray, PathSums)
NIGHTCITY_ARRAY(BoxNodeArray, BoxNode)
NIGHTCITY_ARRAY(OccluderFaceArray, OccluderFace)
NIGHTCITY_ARRAY(HazeNodeArray, HazeNode)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SceneReference {
    SceneTable table;
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameReference {
    FrameTable table;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CountersReference {
    PassCounters counters;
};

layout(push_constant, scalar) uniform Push {
    PushConstants push;
};

// Some devices load a word of a table anew, as slowly as any other, at each use, so in
// each turn of a loop. A pass with loops keeps both at hand: it defines NIGHTCITY_KEEP_TABLES and
// calls keepTables first.
#ifdef NIGHTCITY_KEEP_TABLES
SceneTable sceneTable;
FrameTable frameTable;

void keepSceneTable() {
    sceneTable = SceneReference(push.scene).table;
}

void keepTables() {
    keepSceneTable();
    frameTable = FrameReference(push.frame).table;
}
#else
#define sceneTable SceneReference(push.scene).table
#define frameTable FrameReference(push.frame).table
#endif

#define NIGHTCITY_GAUSS_PAIRS FloatArray(sceneTable.gaussPairs).at

#endif
