// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options.h"

namespace nightcity {

// Loads the scene, renders every frame that was asked for, writes images and
// statistics. Throws what errors.h names, and Stopped: what was finished stays.
void runSession(const Options& options);

}  // namespace nightcity
