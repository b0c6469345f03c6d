// What the parts of JobStore share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "service/store/database.h"
#include "service/store/job_rows.h"
#include "service/store/job_schema.h"
#include "service/store/job_store.h"
#include "service/store/job_texts.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {

struct JobStore::State {
    explicit State(const std::filesystem::path& file)
        : writer(file, sqlite::Database::Access::write, store_application) {
        make_schema(writer);
        sqlite::Rows rows(writer, "SELECT revision FROM counter");
        if (!rows.next()) writer.fail_damaged("the database is damaged: it has no counter of revisions");
        last = reserved = static_cast<std::uint64_t>(rows.integer(0));
    }

    // Revisions are reserved in the file this many at a time, so that a revision of progress, which is not stored,
    // costs no write.
    static constexpr std::uint64_t revisions_at_once = 1000;

    // Called within a transaction.
    std::uint64_t take_revision() {
        if (last >= reserved) {
            sqlite::run(writer, "UPDATE counter SET revision = revision + ?", {value(revisions_at_once)});
            reserved += revisions_at_once;
        }
        return ++last;
    }

    // Called within a transaction, after each change of a row.
    void seal(const std::string& id) {
        service::seal(writer, id);
        sqlite::Rows rows(writer, "SELECT * FROM jobs WHERE id = ?", {id});
        if (!rows.next()) return;
        const StoredJob job = read_job(rows);
        changed.push_back({job.sequence, searched_text(job)});
    }

    template <class Body>
    auto write(Body&& body) {
        const std::scoped_lock lock(write_mutex);
        changed.clear();
        try {
            sqlite::Transaction all(writer);
            auto result = body();
            all.commit();
            for (auto& [sequence, text] : changed) texts.set(sequence, std::move(text));
            return result;
        } catch (...) {
            reserved = last;  // the reservation may have been rolled back
            throw;
        }
    }

    std::mutex write_mutex, read_mutex, count_mutex, search_mutex;
    sqlite::Database writer;
    // Opened once the file has its tables. Monitors count with one of their own, and texts are searched with one of
    // their own, so that no long search delays others.
    std::optional<sqlite::Database> reader, counter, searcher;
    JobTexts texts;
    // What a transaction changes in the texts: see JobTexts::set().
    std::vector<std::pair<std::int64_t, std::string>> changed;
    std::uint64_t last = 0, reserved = 0;  // the last revision used, and the last one reserved in the file
};

std::optional<JobStore::Added> find_by_key(sqlite::Database& database, const std::string& key,
                                           const std::string& request);

}  // namespace shadowbench::service
