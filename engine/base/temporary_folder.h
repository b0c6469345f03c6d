// A folder for temporary files.
#pragma once

#include <filesystem>

namespace shadowbench::base {

// New and empty, in the folder for temporary files ($TMPDIR), and removed with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder();  // throws Error{io}
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace shadowbench::base
