// SQLite behind two small classes. database.cpp alone knows its header.
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

// One connection; whoever shares it between threads locks. Every fault is a base::Error{io} whose place is the file; of
// a broken file a DamagedStore.
class Database {
public:
    enum class Access { write, read };

    // Opened for writing, the file is made where there is none, put into write-ahead mode, and every commit waits until
    // it is on the disk. The file must be empty or carry `application` (SQLite's application_id).
    Database(const std::filesystem::path& file, Access access, std::int32_t application);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void execute(const std::string& sql);  // several statements, without values
    std::int64_t changes() const;          // rows that the last statement changed
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail_damaged(const std::string& what) const;

private:
    friend class Rows;
    sqlite3_stmt* prepared(std::string_view sql);
    void check(int code) const;

    std::string place_;
    sqlite3* handle_ = nullptr;
    std::map<std::string, sqlite3_stmt*, std::less<>> statements_;  // each prepared once
};

using Value = std::variant<std::monostate, std::int64_t, std::string_view>;  // monostate: NULL

// One execution of a statement: while (rows.next()) rows.text(0) ... Its locks end with it.
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

// Runs a statement that gives no rows; the number of rows it changed.
std::int64_t run(Database& database, std::string_view sql, std::initializer_list<Value> values = {});

// Everything until commit() happens, or nothing of it.
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
