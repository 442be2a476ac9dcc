// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/pending_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <unistd.h>

namespace nightcity {

PendingFile::PendingFile(std::filesystem::path target) : target_(std::move(target)) {
    const std::string name = "." + target_.stem().string() + "." + std::to_string(::getpid()) +
                             ".part" + target_.extension().string();
    pending_ = target_.parent_path() / name;
}

PendingFile::~PendingFile() {
    std::error_code ignored;  // gone after finish()
    std::filesystem::remove(pending_, ignored);
}

void PendingFile::finish() {
    std::error_code error;
    std::filesystem::rename(pending_, target_, error);
    if (error) {
        fail(error.message());
    }
}

void PendingFile::fail(const std::string& why) const {
    throw std::runtime_error(target_.string() + ": cannot be written: " + why +
                             "; check the folder, its permissions and the space on its disk");
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    PendingFile pending(file);
    std::FILE* out = std::fopen(pending.path().c_str(), "wb");
    if (out == nullptr) {
        pending.fail(std::strerror(errno));
    }
    const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
    const int writeError = errno;
    if (std::fclose(out) != 0 || !written) {
        pending.fail(std::strerror(written ? errno : writeError));
    }
    pending.finish();
}

}  // namespace nightcity
