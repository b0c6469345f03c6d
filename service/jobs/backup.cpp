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
#include "service/store/store_check.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr std::size_t jobs_a_page = 1000;

[[noreturn]] void fail_backup(const fs::path& place, const std::error_code& why) {
    throw Error(ErrorCode::io, place.string(), "the back-up cannot be written: " + why.message());
}

void check_target(const fs::path& to, const fs::path& partial) {
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
    std::error_code failed;
    fs::copy(from, to, fs::copy_options::recursive, failed);
    if (!failed) return true;
    if (type_of(from) != fs::file_type::not_found) fail_backup(to, failed);
    fs::remove_all(to, failed);
    return false;
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

std::set<std::string> succeeded(const StoreContents& contents) {
    std::set<std::string> ids;
    for (const StoredJob& job : contents.jobs)
        if (job.state == job_states::succeeded) ids.insert(job.id);
    return ids;
}

std::vector<std::string> check_results(const fs::path& folder, const std::string& id) {
    if (type_of(folder) == fs::file_type::not_found) return {folder.string() + ": the results of this job are missing"};
    if (const FoundResults found = read_results(folder, id); !found.job)
        return {folder.string() + ": " + found.why_none};
    return check_files(folder);
}

}  // namespace

std::size_t back_up(const fs::path& state, const fs::path& to) {
    fs::path whole = fs::absolute(to).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();
    const fs::path partial = whole.string() + ".partial";
    check_target(whole, partial);
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
    const StoreContents contents = check_store(state / "jobs.db");
    std::map<std::string, std::vector<std::string>> faults;  // by job
    for (const std::string& id : succeeded(contents))
        if (auto found = check_results(state / "jobs" / id, id); !found.empty()) faults[id] = std::move(found);
    // A server may have added and removed jobs meanwhile.
    const std::set<std::string> now = succeeded(check_store(state / "jobs.db"));
    std::vector<std::string> all = contents.faults;
    for (const auto& [id, lines] : faults)
        if (now.contains(id)) all.insert(all.end(), lines.begin(), lines.end());
    const std::set<std::string> then = succeeded(contents);
    for (const fs::path& entry : entries_of(state / "jobs"))
        if (const std::string id = entry.filename().string(); !now.contains(id) && !then.contains(id))
            all.push_back(entry.string() +
                          ": the database has no such job that succeeded; a start of the server takes "
                          "it back or moves it to lost+found");
    return all;
}

}  // namespace shadowbench::service
