// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/box_tree.h"
#include "scene/checks.h"
#include "scene/number_checks.h"

namespace nightcity {

namespace {

void checkBox(const MediaBox& box, std::size_t i, const std::filesystem::path& file) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(box.lo[axis])) {
            failScene(file, fieldName("media_box", i, "lo", axis), text(box.lo[axis]),
                      "must be finite");
        }
        if (!std::isfinite(box.hi[axis]) || !(box.hi[axis] > box.lo[axis])) {
            failScene(file, fieldName("media_box", i, "hi", axis), text(box.hi[axis]),
                      "must be finite and greater than lo, " + text(box.lo[axis]) +
                          "; a box needs a size in every direction");
        }
    }
    if (!notNegative(box.extinction)) {
        failScene(file, fieldName("media_box", i, "extinction"), text(box.extinction),
                  "must be finite and not negative, in 1/m");
    }
    if (!unitInterval(box.albedo)) {
        failScene(file, fieldName("media_box", i, "albedo"), text(box.albedo),
                  "must lie from 0 to 1");
    }
    if (box.mediaId < 0) {
        failScene(file, fieldName("media_box", i, "media_id"), std::to_string(box.mediaId),
                  "must not be negative; set nightcity:mediaId");
    }
    if (box.reserved != 0) {
        failScene(file, fieldName("media_box", i, "reserved"), std::to_string(box.reserved),
                  "must be 0; export the stage with this version");
    }
}

void checkList(const FlatScene& scene, std::size_t i, const std::filesystem::path& file) {
    const MediaBox& box = scene.mediaBoxes[i];
    if (box.firstLight > scene.lightList.size() ||
        box.lightCount > scene.lightList.size() - box.firstLight) {
        failScene(file, fieldName("media_box", i, "first_light"),
                  std::to_string(box.firstLight) + " with " + std::to_string(box.lightCount) +
                      " lights",
                  "the list ends past the " + std::to_string(scene.lightList.size()) +
                      " entries of light_list");
    }
    for (std::size_t k = box.firstLight; k < std::size_t{box.firstLight} + box.lightCount; ++k) {
        const uint window = scene.lightList[k];
        if (window >= scene.windows.size()) {
            failScene(file, fieldName("light_list", k, ""), std::to_string(window),
                      "must be below the " + std::to_string(scene.windows.size()) + " windows");
        }
        if (k > box.firstLight && window <= scene.lightList[k - 1]) {
            failScene(file, fieldName("light_list", k, ""), std::to_string(window),
                      "the windows of media_box[" + std::to_string(i) + "] must rise; " +
                          kExportAgain);
        }
    }
}

void checkOverlap(const FlatScene& scene, const std::filesystem::path& file) {
    std::vector<Bounds> bounds;
    bounds.reserve(scene.mediaBoxes.size());
    for (const MediaBox& box : scene.mediaBoxes) {
        bounds.push_back({glm::dvec3(box.lo), glm::dvec3(box.hi)});
    }
    const BoxTree tree(std::move(bounds));
    for (std::uint32_t i = 0; i < scene.mediaBoxes.size(); ++i) {
        tree.visitTouching(tree.box(i), [&](std::uint32_t other) {
            const MediaBox& a = scene.mediaBoxes[i];
            const MediaBox& b = scene.mediaBoxes[other];
            if (other <= i || !glm::all(glm::lessThan(a.lo, b.hi)) ||
                !glm::all(glm::lessThan(b.lo, a.hi))) {
                return;
            }
            const vec3 lo = glm::max(a.lo, b.lo);
            const vec3 hi = glm::min(a.hi, b.hi);
            failScene(file, fieldName("media_box", other, "lo"), text(b.lo),
                      "the media with mediaId " + std::to_string(a.mediaId) + " and " +
                          std::to_string(b.mediaId) + " overlap from " + text(lo) + " to " +
                          text(hi) + "; move or shrink one of them");
        });
    }
}

}  // namespace

void checkMedia(const FlatScene& scene, const std::filesystem::path& file) {
    std::vector<uint> ids(scene.mediaBoxes.size());
    for (std::size_t i = 0; i < scene.mediaBoxes.size(); ++i) {
        checkBox(scene.mediaBoxes[i], i, file);
        checkList(scene, i, file);
        ids[i] = uint(scene.mediaBoxes[i].mediaId);
    }
    const std::size_t twice = findDuplicate(ids);
    if (twice < ids.size()) {
        failScene(file, fieldName("media_box", twice, "media_id"), std::to_string(ids[twice]),
                  "another media box has this id; give each its own nightcity:mediaId");
    }
    checkOverlap(scene, file);
}

}  // namespace nightcity
