// The folder that a test writes to, gone with the test.
#pragma once

#include <string>

#include "base/temporary_folder.h"

namespace shadowbench {

class TemporaryFolder : public base::TemporaryFolder {
public:
    using base::TemporaryFolder::path;
    std::string path(const std::string& name) const { return (path() / name).string(); }
};

}  // namespace shadowbench
