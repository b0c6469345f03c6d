// Locks a folder for one process.
#pragma once

#include <filesystem>

namespace shadowbench::service {

// Holds a folder for one server at a time, by a lock on its file "lock" and one on the folder itself, which holds when
// the file is removed. The locks end with the process, however that ends.
class FolderLock {
public:
    // Waits a second for a server that is stopping. Throws Error{io}, place the folder, when the folder cannot be
    // written or another server holds it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    void release();
    int file_ = -1, folder_ = -1;
};

}  // namespace shadowbench::service
