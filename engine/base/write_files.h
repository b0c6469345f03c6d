// Files and folders that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"

namespace shadowbench::base {

// A file or folder that could not be written; place: it.
class WriteError : public Error {
public:
    WriteError(const std::filesystem::path& place, const std::string& what, std::error_code why);
    WriteError(const WriteError& error, std::uintmax_t bytes);
    const std::error_code& why() const { return why_; }  // what the system says; no error where it said nothing
    // What all files of the call take on the disk, in blocks of 4,096.
    std::uintmax_t bytes() const { return bytes_; }

private:
    std::error_code why_;
    std::uintmax_t bytes_ = 0;
};

// Takes away the files and empty folders that were made, newest first, unless it is told to keep them.
class Undo {
public:
    Undo() = default;
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;
    ~Undo();
    void made(const std::filesystem::path& path) { made_.push_back(path); }
    void keep() { made_.clear(); }

private:
    std::vector<std::filesystem::path> made_;
};

// A file and all that it will hold.
struct NewFile {
    std::filesystem::path path;
    std::string content;
};

// Writes all files under temporary names beside their places, then renames them: a reader sees the old or the new
// content of each, never half of one. Missing folders are made. When writing fails, nothing that was made stays, and
// what was there before is as it was. Throws WriteError, an Error{io}.
void write_files(const std::vector<NewFile>& files);

// Makes the folder where it is missing and tries to write in it, before hours are spent on what goes there. `undo`
// takes away the folders that were made. Throws Error{io}.
void make_writable(const std::filesystem::path& folder, Undo& undo);

}  // namespace shadowbench::base
