#include "base/write_files.h"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::base {
namespace {

namespace fs = std::filesystem;

void make_folders(const fs::path& folder, Undo& undo) {
    std::error_code failed;
    if (folder.empty() || fs::is_directory(folder, failed)) return;
    make_folders(folder.parent_path(), undo);
    if (fs::create_directory(folder, failed)) undo.record(folder);
    if (failed) throw WriteError(folder, "cannot make the folder", failed);
}

fs::path temporary_name(const fs::path& path) {
    return path.parent_path() / fmt::format(".{}.{}.tmp", path.filename().string(), getpid());
}

// Faults name the file that is asked for, `place`, and not a temporary one.
void write_one(const fs::path& path, const std::string& content, const fs::path& place) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    const std::error_code why(errno, std::generic_category());
    if (!file) throw WriteError(place, "cannot write the file", why);
}

void write_and_rename(const std::vector<NewFile>& files, Undo& undo) {
    std::error_code failed;
    for (const NewFile& file : files) {
        // rename() would refuse a folder only after it has replaced other files.
        if (fs::is_directory(file.path, failed))
            throw WriteError(file.path, "there is a folder of that name; choose another file",
                             std::make_error_code(std::errc::is_a_directory));
        make_folders(file.path.parent_path(), undo);
        undo.record(temporary_name(file.path));
        write_one(temporary_name(file.path), file.content, file.path);
    }
    for (const NewFile& file : files) {
        fs::rename(temporary_name(file.path), file.path, failed);
        if (failed) throw WriteError(file.path, "cannot replace the file", failed);
    }
}

std::uintmax_t bytes_of(const std::vector<NewFile>& files) {
    constexpr std::uintmax_t block = 4096;
    std::uintmax_t bytes = 0;
    for (const NewFile& file : files) bytes += (file.content.size() + block - 1) / block * block;
    return bytes;
}

}  // namespace

WriteError::WriteError(const fs::path& place, const std::string& what, std::error_code why)
    : Error(ErrorCode::io, place.string(), why ? what + ": " + why.message() : what), why_(why) {}

WriteError::WriteError(const WriteError& error, std::uintmax_t bytes) : Error(error), why_(error.why_), bytes_(bytes) {}

Undo::~Undo() {
    std::error_code ignored;
    for (auto path = paths_.rbegin(); path != paths_.rend(); ++path) fs::remove(*path, ignored);
}

void write_files(const std::vector<NewFile>& files) {
    Undo undo;
    try {
        write_and_rename(files, undo);
    } catch (const WriteError& error) {
        throw WriteError(error, bytes_of(files));
    }
    undo.keep();
}

void make_writable(const fs::path& folder, Undo& undo) {
    try {
        make_folders(folder, undo);
    } catch (const Error& error) {
        throw Error(ErrorCode::io, folder.string(),
                    "results cannot go there; choose another folder: " + std::string(error.what()));
    }
    // Permissions do not decide everything for root, nor on read-only file systems: only a trial write shows it.
    Undo attempt;
    const fs::path file = temporary_name(folder / "result.json");
    attempt.record(file);
    try {
        write_one(file, "", folder);
    } catch (const Error&) {
        throw Error(ErrorCode::io, folder.string(), "results cannot be written there; choose another folder");
    }
}

}  // namespace shadowbench::base
