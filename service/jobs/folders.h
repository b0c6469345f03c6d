// The folders for the files of jobs, in the state folder:
//   work/<id>-<attempt>/   the files of a run, which may be incomplete
//   work/<id>-copy/        the results of an earlier job, which become those of a new job
//   work/<id>-removed/     the results of a job that is being removed
//   jobs/<id>/             the complete results of a job, with its record (record.h)
// A folder moves from work/ to jobs/ once all its files are on the disk.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::service {

inline constexpr const char* record_name = ".job.json";

struct JobFolders {
    std::filesystem::path jobs, work;
};

// Makes both folders. Throws Error{io}, like every function of this file that changes something.
JobFolders make_job_folders(const std::filesystem::path& state);

// Makes an empty folder; removes the one that was there.
void make_work_folder(const std::filesystem::path& work);

// Syncs a work folder to the disk, then moves it to its place in jobs/. Throws Error{internal} for anything that is
// neither file nor folder, such as a link: that is the job's fault.
void publish(const JobFolders& folders, const std::filesystem::path& work, const std::string& id);

// Puts the files of a job into a work folder: linked, or copied where the file system has no links. Each of the two
// folders can be removed without the other.
void link_files(const std::filesystem::path& from, const std::filesystem::path& work);

bool is_published(const JobFolders& folders, const std::string& id);  // throws like type_of()
// Both ignore faults. They remove the record of a job last, and only when nothing else is left: until then a start can
// tell whose folder it is.
void remove_folder(const std::filesystem::path& folder);
void empty_folder(const std::filesystem::path& folder);

// Moves the results of a job to removed_folder(); if the server dies then, the next start removes them. Returns false
// for a job without results.
bool unpublish(const JobFolders& folders, const std::string& id);
void discard_results(const JobFolders& folders, const std::string& id);  // unpublishes and removes them; ignores faults
std::filesystem::path removed_folder(const JobFolders& folders, const std::string& id);
std::filesystem::path copy_folder(const JobFolders& folders, const std::string& id);
std::filesystem::path attempt_folder(const JobFolders& folders, const std::string& id, int attempt);

// The type of a place, without following a link; not_found where there is nothing. Throws Error{io}, place the path.
std::filesystem::file_type type_of(const std::filesystem::path& place);
// Everything in a folder, sorted, with hidden files and links. Throws Error{io}, place the folder.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);
// The files at any depth of a folder by their relative names, sorted; without hidden files.
std::vector<std::string> list_files(const std::filesystem::path& folder);
// The file of such a name. Nothing when it does not exist, or the name leads out of the folder or through a link.
std::optional<std::filesystem::path> find_file_in(const std::filesystem::path& folder, const std::string& name);

}  // namespace shadowbench::service
