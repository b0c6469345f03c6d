// Writes a file that appears whole or not at all.
#pragma once

#include <filesystem>

namespace shadowbench::base {

// Creates an empty temporary file beside the place, which the caller fills. commit() moves it to its place and replaces
// the file there. Without commit() the temporary file goes and the place stays as it was.
class PendingFile {
public:
    // Throws Error{io}, place the file, if the file cannot be created there.
    explicit PendingFile(std::filesystem::path place);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    const std::filesystem::path& place() const { return place_; }
    const std::filesystem::path& temporary() const { return temporary_; }  // has the same extension as place()

    // Call it once, when everything is written and the file is closed. Throws Error{io}.
    void commit();

private:
    std::filesystem::path place_, temporary_;
};

}  // namespace shadowbench::base
