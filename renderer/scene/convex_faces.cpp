// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/convex_faces.h"

#include <array>
#include <cmath>

namespace nightcity {

namespace {

constexpr double kPlanar = 1e-6;  // m; float32 corners of one wall differ by this much

// The turn at corner `at` does not go against the normal.
bool turnsInward(const std::vector<glm::dvec3>& face, std::size_t at, glm::dvec3 normal) {
    const std::size_t count = face.size();
    const glm::dvec3 before = face[(at + count - 1) % count];
    const glm::dvec3 after = face[(at + 1) % count];
    const glm::dvec3 turn = glm::cross(face[at] - before, after - face[at]);
    return glm::dot(turn, normal) >= 0;
}

// Whether the triangle could be joined to the face.
bool joinTriangle(std::vector<glm::dvec3>& face, const std::array<glm::dvec3, 3>& triangle) {
    const glm::dvec3 sum = areaVector(face);
    const double size = glm::length(sum);
    if (!(size > 0)) {
        return false;
    }
    const glm::dvec3 normal = sum / size;
    for (std::size_t i = 0; i < face.size(); ++i) {
        const std::size_t next = (i + 1) % face.size();
        for (std::size_t k = 0; k < 3; ++k) {
            // The common edge runs the other way round in the neighbour.
            if (triangle[k] != face[next] || triangle[(k + 1) % 3] != face[i]) {
                continue;
            }
            const glm::dvec3 apex = triangle[(k + 2) % 3];
            const bool planar = std::abs(glm::dot(apex - face[0], normal)) <= kPlanar;
            const bool outside = glm::dot(glm::cross(face[next] - face[i], apex - face[i]), normal) < 0;
            if (!planar || !outside) {
                return false;
            }
            std::vector<glm::dvec3> joined = face;
            joined.insert(joined.begin() + std::ptrdiff_t(i) + 1, apex);
            const std::size_t count = joined.size();
            if (!turnsInward(joined, i, normal) || !turnsInward(joined, (i + 2) % count, normal)) {
                return false;
            }
            face = std::move(joined);
            return true;
        }
    }
    return false;
}

}  // namespace

glm::dvec3 areaVector(std::span<const glm::dvec3> face) {
    glm::dvec3 sum(0);
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        sum += glm::cross(face[i] - face[0], face[i + 1] - face[0]);
    }
    return sum;
}

ConvexFaces::ConvexFaces(const FlatScene& scene) {
    std::vector<glm::dvec3> face;
    const auto close = [&] {
        corners_.insert(corners_.end(), face.begin(), face.end());
        if (!face.empty()) {
            first_.push_back(std::uint32_t(corners_.size()));
        }
    };
    for (const Triangle& triangle : scene.triangles) {
        std::array<glm::dvec3, 3> corner;
        for (int i = 0; i < 3; ++i) {
            corner[std::size_t(i)] = glm::dvec3(scene.positions[triangle.vertex[i]]);
        }
        if (!joinTriangle(face, corner)) {
            close();
            face.assign(corner.begin(), corner.end());
        }
        ofTriangle_.push_back(std::uint32_t(size()));
    }
    close();
}

std::vector<Bounds> ConvexFaces::bounds() const {
    std::vector<Bounds> bounds(size());
    for (std::uint32_t i = 0; i < bounds.size(); ++i) {
        for (const glm::dvec3 corner : face(i)) {
            bounds[i].add(corner);
        }
    }
    return bounds;
}

}  // namespace nightcity
