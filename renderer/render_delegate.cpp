// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "render_delegate.h"

#include "errors.h"

namespace nightcity {

std::vector<std::string> listDevices() {
    return {};
}

std::unique_ptr<RenderDelegate> RenderDelegate::create(const DeviceOptions&) {
    throw DeviceError("this build renders on no GPU yet; --method reference runs on the CPU");
}

}  // namespace nightcity
