// Where the files of jobs are, under the state folder:
//   work/<id>-<attempt>/   what a child writes; it may be half of something
//   work/<id>-copy/        the results of an earlier job, on their way to answer for a new one
//   work/<id>-removed/     the results of a job that is being removed
//   jobs/<id>/             the whole results of a job, with its record (record.h)
// A folder moves from work/ to jobs/ once all in it is on the disk.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::service {

struct JobFolders {
    std::filesystem::path jobs, work;
};

// Makes both. Throws Error{io}, as does all of this file that changes something.
JobFolders make_job_folders(const std::filesystem::path& state);

// An empty folder, in place of what was there.
void make_work_folder(const std::filesystem::path& work);

// Puts all of a work folder onto the disk, then moves it to its place. Refuses links and whatever else is neither file
// nor folder, with Error{internal}: that is the job's fault.
void publish(const JobFolders& folders, const std::filesystem::path& work, const std::string& id);

// The files of one job as those of another, in a work folder: linked, or copied where the file system has no links.
// Either may be removed without the other.
void link_files(const std::filesystem::path& from, const std::filesystem::path& work);

bool is_published(const JobFolders& folders, const std::string& id);
void remove_folder(const std::filesystem::path& folder);  // as far as it can be
void empty_folder(const std::filesystem::path& folder);   // likewise

// Takes the results of a job from their place to removed_folder(), from where a start would go on to remove them;
// false: there are none.
bool unpublish(const JobFolders& folders, const std::string& id);
void discard_results(const JobFolders& folders, const std::string& id);  // all that, as far as it can be
std::filesystem::path removed_folder(const JobFolders& folders, const std::string& id);
std::filesystem::path copy_folder(const JobFolders& folders, const std::string& id);
std::filesystem::path attempt_folder(const JobFolders& folders, const std::string& id, int attempt);

// What lies in a folder, sorted; hidden things and links too. Throws Error{io}, place the folder.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);
// By relative names with '/', sorted; hidden files are left out.
std::vector<std::string> list_files(const std::filesystem::path& folder);
// The file of such a name; nothing when there is none, when the name leads elsewhere, or through a link.
std::optional<std::filesystem::path> find_file_in(const std::filesystem::path& folder, const std::string& name);

}  // namespace shadowbench::service
