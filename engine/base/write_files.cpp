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
    if (fs::create_directory(folder, failed)) undo.made(folder);
    if (failed) throw Error(ErrorCode::io, folder.string(), "cannot make the folder: " + failed.message());
}

fs::path temporary_name(const fs::path& path) {
    return path.parent_path() / fmt::format(".{}.{}.tmp", path.filename().string(), getpid());
}

void write_one(const fs::path& path, const std::string& content) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    const std::string why = errno ? ": " + std::generic_category().message(errno) : "";
    if (!file) throw Error(ErrorCode::io, path.string(), "cannot write the file" + why);
}

}  // namespace

Undo::~Undo() {
    std::error_code ignored;
    for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, ignored);
}

void write_files(const std::vector<NewFile>& files) {
    Undo undo;
    std::error_code failed;
    for (const NewFile& file : files) {
        // rename() would refuse a folder only after other files have been replaced.
        if (fs::is_directory(file.path))
            throw Error(ErrorCode::io, file.path.string(), "a folder is in the file's place");
        make_folders(file.path.parent_path(), undo);
        undo.made(temporary_name(file.path));
        write_one(temporary_name(file.path), file.content);
    }
    for (const NewFile& file : files) {
        fs::rename(temporary_name(file.path), file.path, failed);
        if (failed) throw Error(ErrorCode::io, file.path.string(), "cannot replace the file: " + failed.message());
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
    // Permissions do not tell root everything, nor of file systems that take no files: only trying does.
    Undo attempt;
    const fs::path file = temporary_name(folder / "result.json");
    attempt.made(file);
    try {
        write_one(file, "");
    } catch (const Error&) {
        throw Error(ErrorCode::io, folder.string(), "results cannot be written there; choose another folder");
    }
}

}  // namespace shadowbench::base
