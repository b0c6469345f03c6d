// The index of texts (FTS5) that earlier programs kept in a job store.
#pragma once

#include "service/store/database.h"

namespace shadowbench::service {

// Drops the index, in whatever state it is. Does nothing where it cannot be written, as on a full disk: nothing reads
// it, and the next start drops it. An earlier program makes its own anew. Throws DamagedStore.
void drop_old_index(sqlite::Database& database);

}  // namespace shadowbench::service
