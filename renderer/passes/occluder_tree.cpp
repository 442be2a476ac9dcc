// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/occluder_tree.h"

#include "passes/box_nodes.h"
#include "scene/convex_faces.h"

namespace nightcity {
namespace {

OccluderFace faceRecord(std::span<const glm::dvec3> corners, std::size_t firstCorner) {
    const glm::dvec3 area = areaVector(corners);
    const double size = glm::length(area);
    OccluderFace face{};
    face.normal = size > 0 ? vec3(area / size) : vec3(0);
    face.firstCorner = static_cast<std::uint32_t>(firstCorner);
    face.cornerCount = static_cast<std::uint32_t>(corners.size());
    return face;
}

}  // namespace

OccluderTree buildOccluderTree(const FlatScene& scene) {
    const ConvexFaces faces(scene);
    OccluderTree tree;
    tree.nodes = buildBoxNodes(faces.bounds());
    tree.faceOfTriangle.assign(faces.ofTriangle().begin(), faces.ofTriangle().end());
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        tree.faces.push_back(faceRecord(faces.face(i), tree.corners.size()));
        for (const glm::dvec3 corner : faces.face(i)) {
            tree.corners.emplace_back(corner);
        }
    }
    return tree;
}

}  // namespace nightcity
