#include "service/store/store_check.h"

#include "base/error.h"
#include "service/store/database.h"
#include "service/store/job_rows.h"
#include "service/store/job_schema.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows;

std::vector<StoredJob> read_jobs(Database& database) {
    Rows rows(database, "SELECT * FROM jobs ORDER BY sequence");
    std::vector<StoredJob> jobs;
    while (rows.next()) jobs.push_back(read_job(rows));
    return jobs;
}

void check_kind(const std::filesystem::path& file) {
    if (kind_of_store(file) != StoreKind::ours)
        throw base::Error(base::ErrorCode::io, file.string(), "there is no database of shadowbench");
}

}  // namespace

void copy_store(const std::filesystem::path& from, const std::filesystem::path& to) {
    check_kind(from);
    Database database(from, Database::Access::check, store_application);
    check_schema(database);
    const std::string name = to.string();
    sqlite::run(database, "VACUUM INTO ?", {name});
}

StoreContents check_store(const std::filesystem::path& file) {
    check_kind(file);
    Database database(file, Database::Access::check, store_application);
    check_schema(database);
    StoreContents contents;
    sqlite::run(database, "BEGIN");
    {
        Rows rows(database, "PRAGMA integrity_check");
        while (rows.next())
            if (const std::string line = rows.text(0); line != "ok")
                contents.faults.push_back(file.string() + ": " + line);
    }
    for (const std::string& id : find_unsealed(database))
        contents.faults.push_back(file.string() + ": the row of job " + id + " is damaged: its checksum differs");
    contents.jobs = read_jobs(database);
    sqlite::run(database, "COMMIT");
    return contents;
}

std::vector<StoredJob> read_store(const std::filesystem::path& file) {
    check_kind(file);
    Database database(file, Database::Access::check, store_application);
    check_schema(database);
    return read_jobs(database);
}

}  // namespace shadowbench::service
