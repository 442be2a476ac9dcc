// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A file mapped into memory, read-only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace nightcity {

class MappedFile {
public:
    // Throws SceneError where the file can't be opened or mapped, saying why.
    explicit MappedFile(const std::filesystem::path& file);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<const std::byte> bytes() const { return bytes_; }  // starts on a page
    // Gives back the memory that holds what was read so far; it is read again when it is needed.
    void dropPages() const;

private:
    std::span<const std::byte> bytes_;
};

}  // namespace nightcity
