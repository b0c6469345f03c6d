#include "kernels/folder.h"

#include "base/temporary_folder.h"

namespace shadowbench::kernels {

const std::filesystem::path& scratch_folder() {
    static const base::TemporaryFolder folder;
    return folder.path();
}

}  // namespace shadowbench::kernels
