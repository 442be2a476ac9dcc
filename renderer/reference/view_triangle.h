// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a point sees of a straight stretch: the triangle between them. A place on
// the stretch is a fraction, 0 at its beginning and 1 at its end.
#pragma once

#include <glm/glm.hpp>

namespace nightcity {

class ViewTriangle {
public:
    ViewTriangle(glm::dvec3 apex, glm::dvec3 begin, glm::dvec3 end)
        : apex_(apex),
          toBegin_(begin - apex),
          toEnd_(end - apex),
          normal_(glm::cross(toBegin_, toEnd_)),
          normalSquared_(glm::dot(normal_, normal_)) {}

    glm::dvec3 apex() const { return apex_; }
    glm::dvec3 toBegin() const { return toBegin_; }
    glm::dvec3 toEnd() const { return toEnd_; }
    glm::dvec3 normal() const { return normal_; }

    // Whether the apex lies on the line of the stretch, to rounding.
    bool isFlat() const {
        constexpr double kSine = 1e-13;
        return normalSquared_ <= kSine * kSine * glm::dot(toBegin_, toBegin_) * glm::dot(toEnd_, toEnd_);
    }

    // Which side of the triangle's plane a point lies on: above 0, below 0, or on it.
    double side(glm::dvec3 point) const { return glm::dot(normal_, point - apex_); }

    // (a, b) with point = apex + a (begin - apex) + b (end - apex), for a point of
    // the plane: a + b is 0 at the apex and 1 on the stretch. Not for a flat one.
    glm::dvec2 weights(glm::dvec3 point) const {
        const glm::dvec3 from = point - apex_;
        return glm::dvec2(glm::dot(glm::cross(from, toEnd_), normal_),
                          glm::dot(glm::cross(toBegin_, from), normal_)) /
               normalSquared_;
    }

private:
    glm::dvec3 apex_, toBegin_, toEnd_, normal_;
    double normalSquared_;
};

// Where the line from the apex through a place in weights meets the stretch.
inline double stretchFraction(glm::dvec2 weights) {
    return weights.y / (weights.x + weights.y);
}

}  // namespace nightcity
