// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/occluder_tree.h"

#include <cmath>
#include <limits>

#include "scene/convex_faces.h"

namespace nightcity {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float atMost(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest <= value ? nearest : std::nextafter(nearest, -kInfinity);
}

float atLeast(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest >= value ? nearest : std::nextafter(nearest, kInfinity);
}

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

std::vector<BoxNode> packBoxTree(const BoxTree& tree) {
    std::vector<BoxNode> nodes;
    for (const BoxTree::DepthFirstNode& from : tree.depthFirst()) {
        const Bounds& bounds = from.bounds;
        BoxNode node{};
        node.lo = {atMost(bounds.lo.x), atMost(bounds.lo.y), atMost(bounds.lo.z)};
        node.hi = {atLeast(bounds.hi.x), atLeast(bounds.hi.y), atLeast(bounds.hi.z)};
        node.next = from.next;
        node.item = from.box;
        nodes.push_back(node);
    }
    return nodes;
}

OccluderTree buildOccluderTree(const FlatScene& scene) {
    const ConvexFaces faces(scene);
    OccluderTree tree;
    tree.nodes = packBoxTree(BoxTree(faces.bounds()));
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
