#include "service/store/database.h"

#include <sqlite3.h>

#include <system_error>

#include "base/error.h"
#include "service/store/damaged_store.h"

namespace shadowbench::service::sqlite {
namespace {

constexpr int busy_milliseconds = 5000;  // waits for other readers of the file, such as sqlite3's shell

std::int64_t pragma(Database& database, const std::string& name) {
    Rows rows(database, "PRAGMA " + name);
    return rows.next() ? rows.integer(0) : 0;
}

bool has_tables(Database& database) {
    Rows rows(database, "SELECT 1 FROM sqlite_schema LIMIT 1");
    return rows.next();
}

void check_whole(Database& database) {
    // The index of texts of an earlier program is dropped, right or wrong: later versions of SQLite report it here.
    const auto of_index = [](const std::string& fault) {
        return fault.find("fts5") != std::string::npos || fault.find("FTS5") != std::string::npos;
    };
    Rows rows(database, "PRAGMA integrity_check");
    bool any = false;
    while (rows.next()) {
        any = true;
        if (rows.text(0) != "ok" && !of_index(rows.text(0))) database.fail_damaged("the database is damaged");
    }
    if (!any) database.fail_damaged("the database is damaged");
}

// What SQLite's message leaves out of a fault of the storage.
std::string further(sqlite3* handle) {
    if (!handle) return "";
    if (sqlite3_extended_errcode(handle) == SQLITE_IOERR_SHMSIZE)
        return "; its disk has no room for the 32 KiB that connections share: free some space";
    const int code = sqlite3_errcode(handle), why = sqlite3_system_errno(handle);
    if ((code != SQLITE_IOERR && code != SQLITE_CANTOPEN) || why == 0) return "";
    return " (" + std::generic_category().message(why) + ")";
}

void write_ahead(Database& database) {
    Rows rows(database, "PRAGMA journal_mode = WAL");
    if (!rows.next() || rows.text(0) != "wal")
        database.fail("this file system cannot hold a database in write-ahead mode; use a local folder");
}

}  // namespace

Database::Database(const std::filesystem::path& file, Access access, std::int32_t application) : place_(file.string()) {
    try {
        open(access == Access::write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY);
        if (access == Access::check) read_alone_if_full();
        if (access != Access::write) return;
        const std::int64_t found = pragma(*this, "application_id");
        if (found != application) {
            if (found != 0 || has_tables(*this)) fail("this is another program's database; use another folder");
            execute("PRAGMA application_id = " + std::to_string(application));
        }
        check_whole(*this);
        write_ahead(*this);
        execute("PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
    } catch (...) {
        close();
        throw;
    }
}

Database::~Database() {
    close();
}

void Database::open(int flags) {
    check(sqlite3_open_v2(place_.c_str(), &handle_, flags | SQLITE_OPEN_NOMUTEX, nullptr));
    check(sqlite3_busy_timeout(handle_, busy_milliseconds));
}

void Database::close() {
    for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
    statements_.clear();
    sqlite3_close(handle_);
    handle_ = nullptr;
}

void Database::read_alone_if_full() {
    try {
        has_tables(*this);
        return;
    } catch (const base::Error&) {
        if (sqlite3_extended_errcode(handle_) != SQLITE_IOERR_SHMSIZE) throw;
    }
    close();
    open(SQLITE_OPEN_READWRITE);  // the lock asks for it
    check(sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr));
    execute("PRAGMA locking_mode = EXCLUSIVE");
    has_tables(*this);
}

void Database::execute(const std::string& sql) {
    check(sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Database::changes() const {
    return sqlite3_changes64(handle_);
}

void Database::fail(const std::string& message) const {
    throw base::Error(base::ErrorCode::io, place_, message);
}

void Database::fail_damaged(const std::string& what) const {
    throw DamagedStore(base::ErrorCode::io, place_,
                       what + "; the next start sets it aside and makes a new one from the results");
}

void Database::check(int code) const {
    switch (code) {
        case SQLITE_OK:
        case SQLITE_ROW:
        case SQLITE_DONE:
            return;
        case SQLITE_NOTADB:
            fail_damaged("not a database");
        case SQLITE_CORRUPT:
            fail_damaged("the database is damaged");
        default:
            fail(std::string("the database cannot be used: ") +
                 (handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(code)) + further(handle_));
    }
}

sqlite3_stmt* Database::prepared(std::string_view sql) {
    const auto known = statements_.find(sql);
    if (known != statements_.end()) return known->second;
    sqlite3_stmt* statement = nullptr;
    check(sqlite3_prepare_v3(handle_, sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT, &statement,
                             nullptr));
    return statements_.emplace(sql, statement).first->second;
}

Rows::Rows(Database& database, std::string_view sql, std::initializer_list<Value> values)
    : database_(database), statement_(database.prepared(sql)) {
    int place = 0;
    for (const Value& value : values) {
        ++place;
        if (const auto* number = std::get_if<std::int64_t>(&value)) {
            database.check(sqlite3_bind_int64(statement_, place, *number));
        } else if (const auto* text = std::get_if<std::string_view>(&value)) {
            database.check(sqlite3_bind_text64(statement_, place, text->data() ? text->data() : "", text->size(),
                                               SQLITE_TRANSIENT, SQLITE_UTF8));
        } else {
            database.check(sqlite3_bind_null(statement_, place));
        }
    }
}

Rows::~Rows() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
}

bool Rows::next() {
    const int code = sqlite3_step(statement_);
    database_.check(code);
    return code == SQLITE_ROW;
}

bool Rows::null(int column) const {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

std::int64_t Rows::integer(int column) const {
    return sqlite3_column_int64(statement_, column);
}

std::string Rows::text(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))) : std::string();
}

std::int64_t run(Database& database, std::string_view sql, std::initializer_list<Value> values) {
    Rows rows(database, sql, values);
    rows.next();
    return database.changes();
}

Transaction::Transaction(Database& database) : database_(database) {
    run(database_, "BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
    if (!open_) return;
    try {
        run(database_, "ROLLBACK");
    } catch (const base::Error&) {
        // After some faults, such as a full disk, SQLite has already rolled back.
    }
}

void Transaction::commit() {
    run(database_, "COMMIT");
    open_ = false;
}

}  // namespace shadowbench::service::sqlite
