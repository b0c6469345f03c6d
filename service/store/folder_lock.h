#pragma once

#include <filesystem>

namespace shadowbench::service {

// Holds a folder for one server at a time, by a lock on its file "lock" that ends with the process, however it ends.
class FolderLock {
public:
    // A server that is just ending has a second to do so. Throws Error{io}, place the folder: it cannot be written, or
    // another server holds it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace shadowbench::service
