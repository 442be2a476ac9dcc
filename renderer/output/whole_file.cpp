// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/whole_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace nightcity {

namespace {

constexpr mode_t kMode = 0666;  // less the user's mask

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int get() const { return number_; }

private:
    int number_;
};

bool writeAll(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) {
            return false;
        }
        bytes.remove_prefix(written > 0 ? std::size_t(written) : 0);
    }
    return true;
}

class PendingFile {
public:
    explicit PendingFile(const std::filesystem::path& target)
        : target_(target),
          folder_(target.has_parent_path() ? target.parent_path() : "."),
          prefix_(std::string(".") + target.filename().string() + "."),
          pending_(folder_ / (prefix_ + std::to_string(::getpid()) + kSuffix)) {}

    ~PendingFile() {
        std::error_code ignored;  // it is gone once it has its name
        std::filesystem::remove(pending_, ignored);
    }
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    void write(std::string_view bytes) {
        removeAbandoned();
        removeAbandoned();
        const Descriptor out(openLocked());
        // Network file systems report a full disk as late as at fsync; others may not know it.
        if (!writeAll(out.get(), bytes) || (::fsync(out.get()) != 0 && errno != EINVAL) ||
            ::rename(pending_.c_str(), target_.c_str()) != 0) {
            fail();
        }
    }

private:
    static constexpr char kSuffix[] = ".part";

    // The lock says that its writer lives: kernels drop it with the process. Where locks are
    // not known, files of killed writers stay.
    int openLocked() const {
        for (;;) {
            const int file = ::open(pending_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
            if (file < 0) {
                fail();
            }
            struct stat status {};
            if (::flock(file, LOCK_EX) != 0 || ::fstat(file, &status) != 0 || status.st_nlink > 0) {
                return file;
            }
            ::close(file);  // removed by another writer before it was locked
        }
    }

    void removeAbandoned() const {
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
            const std::string name = entry.path().filename().string();
            if (!name.starts_with(prefix_) || !name.ends_with(kSuffix)) {
                continue;
            }
            const Descriptor file(::open(entry.path().c_str(), O_WRONLY | O_CLOEXEC));
            if (file.get() >= 0 && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) {
                ::unlink(entry.path().c_str());
            }
        }
    }

    [[noreturn]] void fail() const {
        throw std::runtime_error(target_.string() + ": cannot be written: " + std::strerror(errno) +
                                 "; check the folder, its permissions and the space on its disk");
    }

    std::filesystem::path target_;
    std::filesystem::path folder_;
    std::string prefix_;
    std::filesystem::path pending_;
};

}  // namespace

void writeWholeFile(const std::filesystem::path& file, std::string_view bytes) {
    PendingFile(file).write(bytes);
}

}  // namespace nightcity
