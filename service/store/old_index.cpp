#include "service/store/old_index.h"

#include <string>
#include <vector>

#include "base/error.h"
#include "service/store/damaged_store.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::Transaction, sqlite::run;

// The tables in which FTS5 keeps the index `jobs_text`, and that itself, whose row in the schema names no page.
constexpr const char* tables_sql =
    "SELECT name FROM sqlite_schema WHERE type = 'table' AND rootpage <> 0 AND name IN ('jobs_text', 'jobs_text_data', "
    "'jobs_text_idx', 'jobs_text_content', 'jobs_text_docsize', 'jobs_text_config')";
constexpr const char* index_sql = "SELECT 1 FROM sqlite_schema WHERE name = 'jobs_text' AND rootpage = 0";

// DROP TABLE would ask FTS5, which refuses an index that is damaged. Its tables alone are tables like others.
void forget_index(Database& database) {
    {
        Rows rows(database, index_sql);
        if (!rows.next()) return;
    }
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
    try {
        forget_index(database);
        std::vector<std::string> tables;
        {
            Rows rows(database, tables_sql);
            while (rows.next()) tables.push_back(rows.text(0));
        }
        if (tables.empty()) return;
        Transaction all(database);
        for (const std::string& table : tables) database.execute("DROP TABLE " + table);
        all.commit();
    } catch (const DamagedStore&) {
        throw;
    } catch (const base::Error&) {
        // The index stays for now.
    }
}

}  // namespace shadowbench::service
