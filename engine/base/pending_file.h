// A file that appears whole or not at all.
#pragma once

#include <filesystem>

namespace shadowbench::base {

// Makes an empty file of another name beside the place; whoever writes fills that one. commit() moves it to its place,
// over what was there; without it nothing stays, and what was there is as it was.
class PendingFile {
public:
    // Throws Error{io}, place the file, when nothing can be written there.
    explicit PendingFile(std::filesystem::path place);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    const std::filesystem::path& place() const { return place_; }
    const std::filesystem::path& temporary() const { return temporary_; }  // of the same extension

    // Once, when all is written and closed. Throws Error{io}.
    void commit();

private:
    std::filesystem::path place_, temporary_;
};

}  // namespace shadowbench::base
