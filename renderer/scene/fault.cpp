// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/fault.h"

#include <sstream>

#include "errors.h"

namespace nightcity {

void failScene(const std::filesystem::path& file, const std::string& field,
               const std::string& value, const std::string& mend) {
    throw SceneError(file.string() + ": " + field + " is " + value + ": " + mend);
}

std::string fieldName(std::string_view array, std::size_t index, std::string_view field,
                      int component) {
    std::string name = std::string(array) + "[" + std::to_string(index) + "]";
    if (!field.empty()) {
        name += "." + std::string(field);
    }
    if (component >= 0) {
        name += std::string(".") + "xyz"[component];
    }
    return name;
}

std::string text(double value) {
    std::ostringstream out;
    out.precision(9);
    out << value;
    return out.str();
}

std::string text(vec3 value) {
    return "(" + text(value.x) + ", " + text(value.y) + ", " + text(value.z) + ")";
}

}  // namespace nightcity
