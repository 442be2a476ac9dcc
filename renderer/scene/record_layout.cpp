// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/record_layout.h"

#include <array>
#include <cstddef>
#include <type_traits>

#include "scene.h"

namespace nightcity {

namespace {

template <typename Member>
constexpr FieldLayout field(std::string_view name, std::size_t offset) {
    std::size_t components = 1;
    if constexpr (std::is_same_v<Member, vec3> || std::is_same_v<Member, uvec3>) {
        components = 3;
    }
    std::string_view type = "u32";
    if constexpr (std::is_same_v<Member, vec3> || std::is_same_v<Member, float>) {
        type = "f32";
    } else if constexpr (std::is_same_v<Member, int>) {
        type = "i32";
    }
    return {name, type, components, offset};
}

// Name in the file, then type and offset of the member that it is read into.
#define FIELD(name, record, member) \
    field<decltype(record::member)>(name, offsetof(record, member))

constexpr std::array kPosition{FieldLayout{"position", "f32", 3, 0}};
constexpr std::array kTexcoord{FieldLayout{"texcoord", "f32", 2, 0}};
constexpr std::array kTexel{FieldLayout{"rgba", "u8", 4, 0}};
constexpr std::array kLightList{FieldLayout{"window", "u32", 1, 0}};
constexpr std::array kTriangle{FIELD("vertex", Triangle, vertex),
                               FIELD("material", Triangle, material)};
constexpr std::array kBuilding{FIELD("first_triangle", Building, firstTriangle),
                               FIELD("triangle_count", Building, triangleCount),
                               FIELD("first_window", Building, firstWindow),
                               FIELD("window_count", Building, windowCount),
                               FIELD("building_id", Building, buildingId)};
constexpr std::array kMaterial{FIELD("reflectance", Material, reflectance),
                               FIELD("first_texel", Material, firstTexel),
                               FIELD("width", Material, width),
                               FIELD("height", Material, height)};
constexpr std::array kWindow{FIELD("centre", Window, centre),  FIELD("power", Window, power),
                             FIELD("half_u", Window, halfU),   FIELD("building", Window, building),
                             FIELD("half_v", Window, halfV),   FIELD("window_id", Window, windowId),
                             FIELD("colour", Window, colour),  FIELD("flags", Window, flags)};
constexpr std::array kMediaBox{
    FIELD("lo", MediaBox, lo),           FIELD("extinction", MediaBox, extinction),
    FIELD("hi", MediaBox, hi),           FIELD("albedo", MediaBox, albedo),
    FIELD("media_id", MediaBox, mediaId), FIELD("first_light", MediaBox, firstLight),
    FIELD("light_count", MediaBox, lightCount), FIELD("reserved", MediaBox, reserved)};
constexpr std::array kWindowEvent{FIELD("frame", WindowEvent, frame),
                                  FIELD("window", WindowEvent, window),
                                  FIELD("on", WindowEvent, on)};
constexpr std::array kCameraFrame{
    FIELD("position", CameraFrame, position), FIELD("tan_half_fov", CameraFrame, tanHalfFov),
    FIELD("right", CameraFrame, right),       FIELD("shift_x", CameraFrame, shiftX),
    FIELD("up", CameraFrame, up),             FIELD("shift_y", CameraFrame, shiftY),
    FIELD("forward", CameraFrame, forward),   FIELD("aspect", CameraFrame, aspect)};

#undef FIELD

constexpr std::array<RecordLayout, kSceneArrayCount> kLayouts{{
    {"position", sizeof(vec3), kPosition},
    {"texcoord", sizeof(vec2), kTexcoord},
    {"triangle", sizeof(Triangle), kTriangle},
    {"building", sizeof(Building), kBuilding},
    {"material", sizeof(Material), kMaterial},
    {"texel", sizeof(std::uint32_t), kTexel},
    {"window", sizeof(Window), kWindow},
    {"media_box", sizeof(MediaBox), kMediaBox},
    {"light_list", sizeof(std::uint32_t), kLightList},
    {"window_event", sizeof(WindowEvent), kWindowEvent},
    {"camera_frame", sizeof(CameraFrame), kCameraFrame},
}};

}  // namespace

std::span<const RecordLayout, kSceneArrayCount> recordLayouts() {
    return kLayouts;
}

}  // namespace nightcity
