// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What can go wrong, by exit code. Messages are for people: what, where (file,
// field, value), and the mend.
#pragma once

#include <stdexcept>
#include <string>

namespace nightcity {

struct UsageError : std::runtime_error {  // exit code 2
    using std::runtime_error::runtime_error;
};

struct SceneError : std::runtime_error {  // exit code 3
    using std::runtime_error::runtime_error;
};

struct DeviceError : std::runtime_error {  // exit code 4
    using std::runtime_error::runtime_error;
};

}  // namespace nightcity
