// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/mapped_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "errors.h"

namespace nightcity {

namespace {

[[noreturn]] void failOpen(const std::filesystem::path& file, const char* what, int error) {
    throw SceneError(file.string() + ": " + what + ": " + std::strerror(error) +
                     "; give the folder that 'nightcity export' wrote");
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        failOpen(file, "cannot be opened", errno);
    }
    struct stat status {};
    void* start = nullptr;
    int error = ::fstat(descriptor, &status) != 0 ? errno : 0;
    if (error == 0 && !S_ISREG(status.st_mode)) {
        error = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
    }
    const std::size_t size = std::size_t(status.st_size);
    if (error == 0 && size > 0) {  // an empty file has nothing to map
        start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
        error = start == MAP_FAILED ? errno : 0;
    }
    ::close(descriptor);
    if (error != 0) {
        failOpen(file, "cannot be read", error);
    }
    bytes_ = {static_cast<const std::byte*>(start), size};
}

void MappedFile::dropPages() const {
    if (!bytes_.empty()) {
        ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
    }
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) {
        ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
    }
}

}  // namespace nightcity
