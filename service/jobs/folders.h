// Where the files of jobs are, under the state folder:
//   work/<id>-<attempt>/   what a child writes; anything here may be half of something
//   jobs/<id>/             the whole results of a job
// A folder moves from the first to the second once all in it is on the disk.
#pragma once

#include <filesystem>
#include <functional>
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
// nor folder.
void publish(const JobFolders& folders, const std::filesystem::path& work, const std::string& id);

// The files of one job as those of another, in a work folder: linked, or copied where the file system has no links.
// Either may be removed without the other.
void link_files(const std::filesystem::path& from, const std::filesystem::path& work);

bool is_published(const JobFolders& folders, const std::string& id);
void remove_folder(const std::filesystem::path& folder);  // as far as it can be

// Empties work/, and removes from jobs/ what is `kept` by no job.
void sweep(const JobFolders& folders, const std::function<bool(const std::string& id)>& kept);

// By relative names with '/', sorted; hidden files are left out.
std::vector<std::string> list_files(const std::filesystem::path& folder);
// The file of such a name; nothing when there is none, when the name leads elsewhere, or through a link.
std::optional<std::filesystem::path> find_file_in(const std::filesystem::path& folder, const std::string& name);

}  // namespace shadowbench::service
