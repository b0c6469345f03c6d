#include "kernels/folder.h"

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>

namespace shadowbench::kernels {
namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path;

    Folder() {
        std::string name = (fs::temp_directory_path() / "shadowbench-kernels-XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error(name + ": cannot make a folder");
        path = name;
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

}  // namespace

const fs::path& scratch_folder() {
    static const Folder folder;
    return folder.path;
}

}  // namespace shadowbench::kernels
