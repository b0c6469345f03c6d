#include "base/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "base/error.h"

namespace shadowbench::base {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
    std::error_code failed;
    std::string name = (fs::temp_directory_path(failed) / "shadowbench-XXXXXX").string();
    if (!failed && !::mkdtemp(name.data())) failed.assign(errno, std::generic_category());
    if (failed) throw Error(ErrorCode::io, name, "the temporary folder cannot be made: " + failed.message());
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace shadowbench::base
