#include "service/jobs/state_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "service/jobs/folders.h"
#include "service/jobs/record.h"
#include "service/jobs/utc.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using nlohmann::json;

constexpr const char *mark_name = "shadowbench-state", *pending_mark_name = ".shadowbench-state.tmp";
constexpr int layout = 1;
constexpr const char* lost_name = "lost+found";
constexpr const char* beside_database[] = {"-wal", "-shm", "-journal"};

struct Part {
    const char* name;
    fs::file_type type;
};
constexpr Part parts[] = {{mark_name, fs::file_type::regular},
                          {pending_mark_name, fs::file_type::regular},
                          {"lock", fs::file_type::regular},
                          {"shadowbench-reserve", fs::file_type::regular},
                          {"jobs.db", fs::file_type::regular},
                          {"jobs.db-wal", fs::file_type::regular},
                          {"jobs.db-shm", fs::file_type::regular},
                          {"jobs.db-journal", fs::file_type::regular},
                          {"jobs", fs::file_type::directory},
                          {"work", fs::file_type::directory},
                          {lost_name, fs::file_type::directory}};

[[noreturn]] void refuse(const fs::path& place, const std::string& why) {
    throw Error(ErrorCode::usage, place.string(), why + "; give --state a new or an empty folder");
}

[[noreturn]] void fail(const fs::path& place, const char* what, const std::error_code& why) {
    throw Error(ErrorCode::io, place.string(), std::string(what) + ": " + why.message());
}

// Whether the folder is empty, but for files that a start makes before the mark, and for the lost+found of a new file
// system.
bool holds_nothing(const fs::path& folder) {
    for (const fs::path& entry : entries_of(folder)) {
        const std::string name = entry.filename().string();
        if (name == lost_name || name == pending_mark_name) continue;
        std::error_code failed;
        const bool empty_file = (name == "lock" || name == "jobs.db") && fs::file_size(entry, failed) == 0;
        const bool empty_folder = (name == "jobs" || name == "work") && entries_of(entry).empty();
        if (!empty_file && !empty_folder) return false;
    }
    return true;
}

bool has_results(const fs::path& jobs) {
    for (const fs::path& entry : entries_of(jobs))
        if (const std::string name = entry.filename().string(); is_job_id(name) && read_results(entry, name).job)
            return true;
    return false;
}

bool is_of_earlier_version(const fs::path& folder) {
    switch (kind_of_store(folder / "jobs.db")) {
        case StoreKind::ours:
            return true;
        case StoreKind::another_programs:
            return false;
        case StoreKind::none:
        case StoreKind::no_database:
            break;
    }
    return type_of(folder / "jobs") == fs::file_type::directory && has_results(folder / "jobs");
}

void check_mark(const fs::path& mark) {
    const json read = json::parse(base::read_bytes(mark), nullptr, false);
    const auto found = read.is_object() ? read.find("layout") : read.end();
    if (!read.is_object() || read.value("program", json()) != "shadowbench" || found == read.end() ||
        !found->is_number_integer())
        refuse(mark, "not the mark of a state folder of shadowbench");
    if (*found < layout) refuse(mark, "not the mark of a state folder of shadowbench");
    if (*found > layout)
        throw Error(ErrorCode::io, mark.string(),
                    "a newer shadowbench made this state folder; run that one, or use another folder");
}

// Checks the folder without writing. Returns whether it has the mark.
bool check_ours(const fs::path& folder) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) refuse(folder, "not a folder");
    for (const Part& part : parts) {
        const fs::file_type type = type_of(folder / part.name);
        if (type != fs::file_type::not_found && type != part.type)
            refuse(folder / part.name, part.type == fs::file_type::directory
                                           ? "expected a folder here, not a file or a link"
                                           : "expected a file here, not a folder or a link");
    }
    if (type_of(folder / mark_name) != fs::file_type::not_found) {
        check_mark(folder / mark_name);
        return true;
    }
    if (!holds_nothing(folder) && !is_of_earlier_version(folder))
        refuse(folder, "this folder has other files and is not a state folder of shadowbench");
    return false;
}

void sync_place(const fs::path& place) {
    const int file = ::open(place.c_str(), O_RDONLY | O_CLOEXEC);
    const bool done = file >= 0 && ::fsync(file) == 0;
    const std::error_code failed(errno, std::generic_category());
    if (file >= 0) ::close(file);
    if (!done) fail(place, "cannot be synced to the disk", failed);
}

// The mark appears complete or not at all.
void write_mark(const fs::path& folder) {
    const std::string text = json{{"program", "shadowbench"}, {"layout", layout}}.dump() + "\n";
    const fs::path pending = folder / pending_mark_name;
    const int file = ::open(pending.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    const bool done =
        file >= 0 && ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(file) == 0;
    std::error_code failed(errno, std::generic_category());
    if (file >= 0) ::close(file);
    if (!done) fail(folder, "the state folder cannot be written", failed);
    fs::rename(pending, folder / mark_name, failed);
    if (failed) fail(folder / mark_name, "cannot be written", failed);
    sync_place(folder);
}

// Makes a new folder in lost+found, named after the current time.
fs::path make_lost(const fs::path& state) {
    std::error_code failed;
    fs::create_directory(state / lost_name, failed);
    std::string time = now_utc();
    for (char& c : time)
        if (c == ':') c = '-';
    for (int number = 1; !failed; ++number) {
        const fs::path folder = state / lost_name / (number == 1 ? time : fmt::format("{}-{}", time, number));
        if (fs::create_directory(folder, failed)) return folder;
    }
    fail(state / lost_name, "cannot be written", failed);
}

}  // namespace

StateFolder::StateFolder(const fs::path& folder, Say say) : path_(folder), say_(std::move(say)) {
    std::error_code failed;
    if (!fs::exists(folder, failed)) fs::create_directories(folder, failed);
    if (failed) fail(folder, "cannot make the state folder", failed);
    const bool marked = check_ours(folder);
    lock_.emplace(folder);
    if (!marked) write_mark(folder);
}

bool StateFolder::set_aside(const fs::path& place, const std::string& why) {
    const std::string from = (path_ / place).string();
    std::error_code failed;
    try {
        if (lost_.empty()) lost_ = make_lost(path_);
        const fs::path to = lost_ / place;
        fs::create_directories(to.parent_path(), failed);
        if (!failed && type_of(to) != fs::file_type::not_found) failed = std::make_error_code(std::errc::file_exists);
        if (!failed) fs::rename(path_ / place, to, failed);
        if (!failed) {
            sync_place(lost_);
            say_(fmt::format("{}: {}; moved to {}", from, why, to.string()));
            return true;
        }
        say_(fmt::format("{}: {}; it stays, because it cannot be moved to {}: {}", from, why, to.string(),
                         failed.message()));
    } catch (const Error& error) {
        say_(fmt::format("{}: {}; it stays, because it cannot be moved: {}", from, why, error.what()));
    }
    return false;
}

void StateFolder::set_aside_if_there(const std::string& name, const std::string& why) {
    if (type_of(path_ / name) != fs::file_type::not_found && !set_aside(name, why))
        throw Error(ErrorCode::io, (path_ / name).string(),
                    "it cannot be moved to lost+found; move it out of the state folder by hand");
}

void StateFolder::set_database_aside(const std::string& why) {
    set_aside_if_there("jobs.db", why);
    set_beside_database_aside(why);
}

void StateFolder::set_beside_database_aside(const std::string& why) {
    for (const char* end : beside_database) set_aside_if_there(std::string("jobs.db") + end, why);
}

}  // namespace shadowbench::service
