// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include <unistd.h>

namespace nightcity {

namespace {

class PendingFile {
public:
    explicit PendingFile(const std::filesystem::path& target)
        : target_(target),
          pending_(target.parent_path() / ("." + target.filename().string() + "." +
                                           std::to_string(::getpid()) + ".part")) {}

    ~PendingFile() {
        std::error_code ignored;  // it is gone once it has its name
        std::filesystem::remove(pending_, ignored);
    }
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    void write(std::string_view bytes) {
        std::FILE* out = std::fopen(pending_.c_str(), "wb");
        if (out == nullptr) {
            fail(errno);
        }
        const bool written = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
        const int writeError = errno;
        if (std::fclose(out) != 0 || !written) {
            fail(written ? errno : writeError);
        }
        if (std::rename(pending_.c_str(), target_.c_str()) != 0) {
            fail(errno);
        }
    }

private:
    [[noreturn]] void fail(int error) const {
        throw std::runtime_error(target_.string() + ": cannot be written: " +
                                 std::strerror(error) +
                                 "; check the folder, its permissions and the space on its disk");
    }

    std::filesystem::path target_;
    std::filesystem::path pending_;
};

}  // namespace

void writeWholeFile(const std::filesystem::path& file, std::string_view bytes) {
    PendingFile(file).write(bytes);
}

}  // namespace nightcity
