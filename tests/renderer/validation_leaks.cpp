// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The validation layer leaks some kilobytes of its own when an instance goes.
// A leak checker would report them as ours: the layer is kept mapped, so that
// they carry its name, and leaks of that name are left out. Ours still count.
#include <dlfcn.h>

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libVkLayer_khronos_validation\n";
}

namespace {
[[maybe_unused]] void* const kLayer =
    dlopen("libVkLayer_khronos_validation.so", RTLD_LAZY | RTLD_NODELETE);
}
