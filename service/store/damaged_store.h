// The error for a store whose file is damaged.
#pragma once

#include "base/error.h"

namespace shadowbench::service {

// The file of a store is not a database, is damaged, or lacks tables that its version has: its content cannot be
// trusted. Not thrown for the file of another program or of a newer version.
class DamagedStore : public base::Error {
public:
    using base::Error::Error;
};

}  // namespace shadowbench::service
