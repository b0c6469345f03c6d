// The state folder, in which a server keeps its jobs:
//   shadowbench-state     the mark: it names the program and the version of the layout
//   lock                  see store/folder_lock.h
//   shadowbench-reserve   see reserve.h
//   jobs.db               see store/job_store.h, with the files that SQLite puts beside it
//   jobs/, work/          see folders.h
//   lost+found/<time>/    unknown files and damaged results that a start found in the places above and moved there
// Other files in it are left alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "service/store/folder_lock.h"

namespace shadowbench::service {

using Say = std::function<void(const std::string& line)>;  // a message for the operator of the server

class StateFolder {
public:
    // Opens a folder that is new or empty, has the mark, or comes from an earlier version, which wrote no mark: it has
    // a job store or, if that is lost, results of a job. Throws Error{usage} for any other folder, and when one of the
    // names above is a link or of another kind; it then changes nothing. Throws Error{io} when the folder cannot be
    // read or written, another server holds it, or a newer version made it. `say` gets a line for each call of
    // set_aside().
    StateFolder(const std::filesystem::path& folder, Say say);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path database() const { return path_ / "jobs.db"; }

    // Moves a file or folder, by its path relative to the state folder, into lost+found, and reports it with the
    // reason. Never overwrites a file there. Returns false, and reports that, when it cannot be moved.
    bool set_aside(const std::filesystem::path& place, const std::string& why);
    // The first sets aside the database and the files that SQLite keeps beside it, the second only those. Throw
    // Error{io}.
    void set_database_aside(const std::string& why);
    void set_beside_database_aside(const std::string& why);

private:
    void set_aside_if_there(const std::string& name, const std::string& why);

    std::filesystem::path path_;
    Say say_;
    std::optional<FolderLock> lock_;
    std::filesystem::path lost_;  // the folder of this start in lost+found; made when it is needed
};

}  // namespace shadowbench::service
