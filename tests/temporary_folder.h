// The one kind of folder that tests write to.
#pragma once

#include "base/temporary_folder.h"

namespace shadowbench {

using base::TemporaryFolder;

}  // namespace shadowbench
