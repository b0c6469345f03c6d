// Files and folders that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::base {

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
// what was there before is as it was. Throws Error{io}.
void write_files(const std::vector<NewFile>& files);

// Makes the folder where it is missing and tries to write in it, before hours are spent on what goes there. `undo`
// takes away the folders that were made. Throws Error{io}.
void make_writable(const std::filesystem::path& folder, Undo& undo);

}  // namespace shadowbench::base
