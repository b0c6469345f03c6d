#pragma once

#include "base/error.h"

namespace shadowbench::service {

// The file of a store is no database, is broken, or lacks tables that its version has. What is in it cannot be relied
// on; a file of another program, or of a newer version, is not meant.
class DamagedStore : public base::Error {
public:
    using base::Error::Error;
};

}  // namespace shadowbench::service
