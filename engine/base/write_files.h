// Writes files and folders that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"

namespace shadowbench::base {

// A file or folder that could not be written; it is the place of the error.
class WriteError : public Error {
public:
    WriteError(const std::filesystem::path& place, const std::string& what, std::error_code why);
    WriteError(const WriteError& error, std::uintmax_t bytes);
    const std::error_code& why() const { return why_; }  // the system's error; none if the system reported none
    // The size of all files of the call on the disk, in blocks of 4,096 bytes.
    std::uintmax_t bytes() const { return bytes_; }

private:
    std::error_code why_;
    std::uintmax_t bytes_ = 0;
};

// Removes the files and empty folders that were recorded, newest first, unless keep() is called.
class Undo {
public:
    Undo() = default;
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;
    ~Undo();
    void record(const std::filesystem::path& path) { paths_.push_back(path); }
    void keep() { paths_.clear(); }

private:
    std::vector<std::filesystem::path> paths_;
};

// A file to write and its content.
struct NewFile {
    std::filesystem::path path;
    std::string content;
};

// Writes all files under temporary names beside their places, then renames them: a reader sees the old or the new
// content of each, never half of one. Makes missing folders. If writing fails, removes everything it made and leaves
// what was there before. Throws WriteError, an Error{io}.
void write_files(const std::vector<NewFile>& files);

// Makes the folder if it is missing and tries to write in it, before hours are spent on the results. `undo` removes the
// folders that were made. Throws Error{io}.
void make_writable(const std::filesystem::path& folder, Undo& undo);

}  // namespace shadowbench::base
