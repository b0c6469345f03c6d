#include "service/store/old_index.h"

#include <string>
#include <vector>

#include "base/error.h"
#include "service/store/damaged_store.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::Transaction, sqlite::run;

// The tables in which FTS5 keeps the index `jobs_text`, and that itself, whose row in the schema names no page.
constexpr const char* all_sql =
    "SELECT name, rootpage FROM sqlite_schema WHERE type = 'table' AND name IN ('jobs_text', 'jobs_text_data', "
    "'jobs_text_idx', 'jobs_text_content', 'jobs_text_docsize', 'jobs_text_config')";

struct Parts {
    bool index = false;
    std::vector<std::string> tables;
};

Parts parts_of(Database& database) {
    Parts parts;
    Rows rows(database, all_sql);
    while (rows.next()) {
        if (rows.integer(1) == 0)
            parts.index = true;
        else
            parts.tables.push_back(rows.text(0));
    }
    return parts;
}

// DROP TABLE would ask FTS5, which refuses an index that is damaged. Without it its tables are tables like others.
void forget_index(Database& database) {
    database.execute("PRAGMA writable_schema = ON");
    try {
        run(database, "DELETE FROM sqlite_schema WHERE name = 'jobs_text' AND rootpage = 0");
    } catch (...) {
        database.execute("PRAGMA writable_schema = RESET");
        throw;
    }
    database.execute("PRAGMA writable_schema = RESET");
}

}  // namespace

void drop_old_index(Database& database) {
    const Parts parts = parts_of(database);
    if (!parts.index && parts.tables.empty()) return;
    try {
        Transaction all(database);
        if (parts.index) forget_index(database);
        for (const std::string& table : parts.tables) database.execute("DROP TABLE " + table);
        all.commit();
    } catch (const DamagedStore&) {
        throw;
    } catch (const base::Error&) {
        // The index stays for now.
    }
}

}  // namespace shadowbench::service
