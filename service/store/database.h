// SQLite behind small classes. Only database.cpp includes its header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

struct sqlite3;
struct sqlite3_stmt;

namespace shadowbench::service::sqlite {

// One connection. Threads that share it must lock. Every fault is a base::Error{io} whose place is the file, or a
// DamagedStore for a damaged file.
class Database {
public:
    enum class Access { write, read, check };

    // Access::write creates a missing file and turns write-ahead mode on; every commit then waits until it is on the
    // disk. The file must be empty or have this application_id. Access::check reads, and needs no room on the disk:
    // where there is none for the file that connections share, it locks others out and keeps that in memory.
    Database(const std::filesystem::path& file, Access access, std::int32_t application);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void execute(const std::string& sql);  // one or more statements, without values
    std::int64_t changes() const;          // rows that the last statement changed
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail_damaged(const std::string& what) const;

private:
    friend class Rows;
    sqlite3_stmt* prepared(std::string_view sql);
    void check(int code) const;
    void open(int flags);
    void close();
    void read_alone_if_full();

    std::string place_;
    sqlite3* handle_ = nullptr;
    std::map<std::string, sqlite3_stmt*, std::less<>> statements_;  // prepared statements by their text
};

using Value = std::variant<std::monostate, std::int64_t, std::string_view>;  // monostate: NULL

// One execution of a statement: while (rows.next()) rows.text(0) ... Its destructor ends its locks.
class Rows {
public:
    Rows(Database& database, std::string_view sql, std::initializer_list<Value> values = {});
    ~Rows();
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;

    bool next();
    bool null(int column) const;
    std::int64_t integer(int column) const;
    std::string text(int column) const;

private:
    Database& database_;
    sqlite3_stmt* statement_;
};

// Runs a statement that gives no rows. Returns the number of rows that it changed.
std::int64_t run(Database& database, std::string_view sql, std::initializer_list<Value> values = {});

// A transaction, rolled back unless commit() is called.
class Transaction {
public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

private:
    Database& database_;
    bool open_ = true;
};

}  // namespace shadowbench::service::sqlite
