// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace nightcity {

// A file that appears under its name only when it is whole: written under a hidden
// name in the same folder, then renamed. Removed where it is not finished.
class PendingFile {
public:
    explicit PendingFile(std::filesystem::path target);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    // Where to write; has the extension of the target.
    const std::filesystem::path& path() const { return pending_; }
    // Throws std::runtime_error naming the target.
    void finish();
    [[noreturn]] void fail(const std::string& why) const;

private:
    std::filesystem::path target_;
    std::filesystem::path pending_;
};

// Writes text whole or not at all. Throws std::runtime_error naming the file.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

}  // namespace nightcity
