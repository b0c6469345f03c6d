// The folder that a server keeps its jobs in:
//   shadowbench-state     the mark: whose folder it is, and the version of its layout
//   lock                  see store/folder_lock.h
//   jobs.db               see store/job_store.h, with what SQLite puts beside it
//   jobs/, work/          see folders.h
//   lost+found/<time>/    what a start found in the server's places and nobody knows, moved there as it was
// Anything else in it is left alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "service/store/folder_lock.h"

namespace shadowbench::service {

using Say = std::function<void(const std::string& line)>;  // to who watches the server

class StateFolder {
public:
    // Takes a folder that is new or empty, has the mark, or is of an earlier version, which put none: it has a database
    // of ours or, where that is lost, results of a job. Nothing in any other is touched: Error{usage}, as where one of
    // the names above is a link or of another kind. Throws Error{io} too: it cannot be read or written, another server
    // holds it, or a newer version made it. `say` gets what set_aside() does.
    StateFolder(const std::filesystem::path& folder, Say say);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path database() const { return path_ / "jobs.db"; }

    // Moves what is at this place, relative to the folder, into lost+found, and says so and why. Nothing is ever
    // overwritten there. False, and that is said: it cannot be moved, and stays.
    bool set_aside(const std::filesystem::path& place, const std::string& why);
    // The database with what SQLite keeps beside it; or that alone. Throws Error{io}.
    void set_database_aside(const std::string& why);
    void set_beside_database_aside(const std::string& why);

private:
    void set_aside_if_there(const std::string& name, const std::string& why);

    std::filesystem::path path_;
    Say say_;
    std::optional<FolderLock> lock_;
    std::filesystem::path lost_;  // of this start; made with the first that goes there
};

}  // namespace shadowbench::service
