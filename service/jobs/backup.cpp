#include "service/jobs/backup.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <set>
#include <system_error>

#include "base/error.h"
#include "service/jobs/folders.h"
#include "service/jobs/record.h"
#include "service/jobs/state_folder.h"
#include "service/store/damaged_store.h"
#include "service/store/store_check.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr std::size_t jobs_a_page = 1000;

[[noreturn]] void fail_backup(const fs::path& place, const std::error_code& why) {
    throw Error(ErrorCode::io, place.string(), "the back-up cannot be written: " + why.message());
}

void check_target(const fs::path& state, const fs::path& to, const fs::path& partial) {
    std::error_code ignored;
    const fs::path inside = fs::weakly_canonical(to, ignored).lexically_relative(fs::weakly_canonical(state, ignored));
    if (!inside.empty() && *inside.begin() != "..")
        throw Error(ErrorCode::usage, to.string(), "lies in the state folder; name a folder outside of it");
    const fs::file_type type = type_of(to);
    if (type != fs::file_type::not_found && !(type == fs::file_type::directory && entries_of(to).empty()))
        throw Error(ErrorCode::usage, to.string(), "is there already; name a new or an empty folder");
    if (type_of(partial) != fs::file_type::not_found)
        throw Error(ErrorCode::usage, partial.string(), "an earlier back-up was interrupted; remove this folder");
}

// Waits until the file system of a folder has all on the disk.
void sync_file_system(const fs::path& folder) {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool done = file >= 0 && ::syncfs(file) == 0;
    const std::error_code failed(errno, std::generic_category());
    if (file >= 0) ::close(file);
    if (!done) fail_backup(folder, failed);
}

// Returns false for results that were removed meanwhile.
bool copy_results(const fs::path& from, const fs::path& to) {
    constexpr int most_tries = 3;  // while jobs are pinned, which replaces a file
    std::error_code failed;
    for (int i = 1;; ++i) {
        fs::copy(from, to, fs::copy_options::recursive, failed);
        if (!failed) return true;
        const std::error_code why = failed;
        fs::remove_all(to, failed);
        if (type_of(from) == fs::file_type::not_found) return false;
        if (why != std::errc::no_such_file_or_directory || i == most_tries) fail_backup(to, why);
    }
}

std::size_t copy_all(const fs::path& state, const fs::path& to) {
    fs::create_directories(to / "jobs");
    fs::create_directories(to / "work");
    copy_store(state / "jobs.db", to / "jobs.db");
    JobStore store(to / "jobs.db");
    std::int64_t before = 0;
    std::size_t copied = 0;
    for (;;) {
        const std::vector<StoredJob> page = store.list({}, jobs_a_page, before);
        for (const StoredJob& job : page) {
            const bool there =
                job.state != job_states::succeeded || copy_results(state / "jobs" / job.id, to / "jobs" / job.id);
            if (there)
                ++copied;
            else
                store.remove(job.id);
        }
        if (page.size() < jobs_a_page) return copied;
        before = page.back().sequence;
    }
}

std::set<std::string> ids_of(const std::vector<StoredJob>& jobs, const std::set<std::string>& states) {
    std::set<std::string> ids;
    for (const StoredJob& job : jobs)
        if (states.contains(job.state)) ids.insert(job.id);
    return ids;
}

std::vector<std::string> check_results(const fs::path& folder, const std::string& id) {
    if (type_of(folder) == fs::file_type::not_found) return {folder.string() + ": the results of this job are missing"};
    if (const FoundResults found = read_results(folder, id); !found.job)
        return {folder.string() + ": " + found.why_none};
    return check_files(folder);
}

// Results outlive a database that cannot be read.
std::vector<std::string> check_without_database(const Error& error, const std::vector<fs::path>& folders) {
    std::vector<std::string> all = {std::string(error.what()) + "; only the results were checked"};
    for (const fs::path& folder : folders)
        if (const std::string id = folder.filename().string();
            is_job_id(id) && type_of(folder) != fs::file_type::not_found) {
            const std::vector<std::string> found = check_results(folder, id);
            all.insert(all.end(), found.begin(), found.end());
        }
    return all;
}

}  // namespace

std::size_t back_up(const fs::path& state, const fs::path& to) {
    fs::path whole = fs::absolute(to).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();
    const fs::path partial = whole.string() + ".partial";
    check_target(state, whole, partial);
    std::size_t copied = 0;
    try {
        copied = copy_all(state, partial);
        const StateFolder mark(partial, [](const std::string&) {});
        sync_file_system(partial);
        fs::rename(partial, whole);
        sync_file_system(whole.parent_path());
    } catch (const fs::filesystem_error& error) {
        std::error_code ignored;
        fs::remove_all(partial, ignored);
        fail_backup(whole, error.code());
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(partial, ignored);
        throw;
    }
    return copied;
}

std::vector<std::string> check_state(const fs::path& state) {
    // A server may add and remove jobs meanwhile. So the folders are listed before the database is read, and the
    // database is read once more at the end.
    std::vector<fs::path> folders;
    if (type_of(state / "jobs") == fs::file_type::directory) folders = entries_of(state / "jobs");
    const fs::path database = state / "jobs.db";
    StoreContents contents;
    try {
        contents = check_store(database);
    } catch (const DamagedStore& error) {
        if (kind_of_store(database) != StoreKind::ours) throw;
        return check_without_database(error, folders);
    }
    const std::set<std::string> then = ids_of(contents.jobs, {job_states::succeeded});
    std::map<std::string, std::vector<std::string>> faults;  // by job
    for (const std::string& id : then)
        if (auto found = check_results(state / "jobs" / id, id); !found.empty()) faults[id] = std::move(found);
    const std::vector<StoredJob> last = read_store(database);
    const std::set<std::string> now = ids_of(last, {job_states::succeeded});
    // The results of a job that runs are there a moment before its row says so.
    const std::set<std::string> known = ids_of(last, {job_states::succeeded, job_states::running});
    std::vector<std::string> all = contents.faults;
    for (const auto& [id, lines] : faults)
        if (now.contains(id)) all.insert(all.end(), lines.begin(), lines.end());
    for (const fs::path& folder : folders)
        if (const std::string id = folder.filename().string();
            !known.contains(id) && !then.contains(id) && type_of(folder) != fs::file_type::not_found)
            all.push_back(folder.string() +
                          ": the database has no such job that succeeded; a start of the server takes "
                          "it back or moves it to lost+found");
    return all;
}

}  // namespace shadowbench::service
