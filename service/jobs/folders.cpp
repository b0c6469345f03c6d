#include "service/jobs/folders.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

void check(const std::error_code& failed, const fs::path& path, const char* what) {
    if (failed) throw Error(ErrorCode::io, path.string(), std::string(what) + ": " + failed.message());
}

// Syncs the content of a file, or the names in a folder, to the disk.
void sync(const fs::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    const bool done = file >= 0 && ::fsync(file) == 0;
    const std::error_code failed(errno, std::generic_category());
    if (file >= 0) ::close(file);
    if (!done) check(failed, path, "cannot be synced to the disk");
}

void sync_all(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const fs::file_type type = entry.symlink_status().type();
        if (type != fs::file_type::regular && type != fs::file_type::directory)
            throw Error(ErrorCode::internal, entry.path().filename().string(),
                        "a job's results may hold only files and folders");
        sync(entry.path());
    }
    sync(folder);
}

void make_folder(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    check(failed, folder, "cannot make the folder");
}

}  // namespace

JobFolders make_job_folders(const fs::path& state) {
    const JobFolders folders{state / "jobs", state / "work"};
    make_folder(folders.jobs);
    make_folder(folders.work);
    sync(state / ".");  // the state folder may be a link
    return folders;
}

void make_work_folder(const fs::path& work) {
    remove_folder(work);
    make_folder(work);
}

void publish(const JobFolders& folders, const fs::path& work, const std::string& id) {
    try {
        sync_all(work);
    } catch (const fs::filesystem_error& error) {
        check(error.code(), work, "the results cannot be read");
    }
    std::error_code failed;
    fs::rename(work, folders.jobs / id, failed);
    check(failed, folders.jobs / id, "the results cannot be moved to their place");
    sync(folders.jobs);
    sync(folders.work);
}

void link_files(const fs::path& from, const fs::path& work) {
    for (const std::string& name : list_files(from)) {
        make_folder((work / name).parent_path());
        std::error_code failed;
        fs::create_hard_link(from / name, work / name, failed);
        if (failed) fs::copy_file(from / name, work / name, failed);
        check(failed, from / name, "cannot be copied");
    }
}

bool unpublish(const JobFolders& folders, const std::string& id) {
    std::error_code failed;
    fs::rename(folders.jobs / id, removed_folder(folders, id), failed);
    if (failed == std::errc::no_such_file_or_directory) return false;
    check(failed, folders.jobs / id, "the results cannot be removed");
    return true;
}

void discard_results(const JobFolders& folders, const std::string& id) {
    try {
        if (unpublish(folders, id)) remove_folder(removed_folder(folders, id));
    } catch (const Error&) {
        // The next start removes them.
    }
}

fs::path removed_folder(const JobFolders& folders, const std::string& id) {
    return folders.work / (id + "-removed");
}

fs::path copy_folder(const JobFolders& folders, const std::string& id) {
    return folders.work / (id + "-copy");
}

fs::path attempt_folder(const JobFolders& folders, const std::string& id, int attempt) {
    return folders.work / (id + "-" + std::to_string(attempt));
}

bool is_published(const JobFolders& folders, const std::string& id) {
    return type_of(folders.jobs / id) == fs::file_type::directory;
}

void remove_folder(const fs::path& folder) {
    empty_folder(folder);
    std::error_code ignored;
    fs::remove(folder, ignored);
}

void empty_folder(const fs::path& folder) {
    std::error_code failed;
    if (!fs::is_directory(fs::symlink_status(folder, failed))) return;
    std::vector<fs::path> entries;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
        if (entry->path().filename() != record_name) entries.push_back(entry->path());
    bool all = !failed;
    for (const fs::path& entry : entries) {
        fs::remove_all(entry, failed);
        all = all && !failed;
    }
    if (all) fs::remove_all(folder / record_name, failed);
}

fs::file_type type_of(const fs::path& place) {
    std::error_code failed;
    const fs::file_type type = fs::symlink_status(place, failed).type();
    if (type == fs::file_type::none) check(failed, place, "cannot be read");
    return type;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> entries;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
        entries.push_back(entry->path());
    check(failed, folder, "cannot be read");
    std::sort(entries.begin(), entries.end());
    return entries;
}

std::vector<std::string> list_files(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code failed;
    for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        const bool hidden = entry->path().filename().string()[0] == '.';
        const fs::file_type type = entry->symlink_status(failed).type();
        if (hidden && type == fs::file_type::directory) entry.disable_recursion_pending();
        if (!hidden && type == fs::file_type::regular)
            names.push_back(entry->path().lexically_relative(folder).generic_string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::optional<fs::path> find_file_in(const fs::path& folder, const std::string& name) {
    if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
    fs::path path = folder;
    fs::file_type type = fs::file_type::directory;
    for (std::size_t start = 0; start <= name.size();) {
        const std::size_t end = std::min(name.find('/', start), name.size());
        const std::string part = name.substr(start, end - start);
        // Refuses "", ".", ".." and hidden files.
        if (part.empty() || part[0] == '.' || type != fs::file_type::directory) return std::nullopt;
        path /= part;
        std::error_code failed;
        type = fs::symlink_status(path, failed).type();
        start = end + 1;
    }
    return type == fs::file_type::regular ? std::optional(path) : std::nullopt;
}

}  // namespace shadowbench::service
