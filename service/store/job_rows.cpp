#include "service/store/job_rows.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/hash_text.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::Value, sqlite::run;

// The columns that a checksum covers.
constexpr std::string_view sealed_columns =
    "SELECT checksum, sequence, id, state, name, hash, seed, program, pictures, cached, created, started, ended, "
    "attempts, kept, "
    "fault_code, fault_where, fault_message, revision, scenario, recommend, owner, labels, priority, pinned, bytes, "
    "queued FROM jobs";
constexpr int last_sealed_column = 26;

// Of the current row of sealed_columns. Lengths keep columns apart.
std::string checksum_of(const Rows& rows) {
    std::string all;
    for (int column = 1; column <= last_sealed_column; ++column) {
        const std::string text = rows.text(column);
        all += rows.null(column) ? "-" : std::to_string(text.size());
        all += ':';
        all += text;
    }
    return base::hash_text(all);
}

std::vector<std::string> split_labels(const std::string& text) {
    std::vector<std::string> labels;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        labels.push_back(text.substr(from, end - from));
        from = end + 1;
    }
    return labels;
}

// Owners take turns, so between two jobs of one owner there is one of each other owner that has some.
std::uint64_t ahead_of(Database& database, const StoredJob& job) {
    Rows rows(database, R"(
WITH mine AS (
  SELECT count(*) AS before FROM jobs WHERE state = 'queued' AND owner = ?1
     AND (priority > ?2 OR (priority = ?2 AND sequence < ?3))),
others AS (
  SELECT owner, count(*) AS n FROM jobs WHERE state = 'queued' AND owner <> ?1 GROUP BY owner),
turn AS (SELECT coalesce((SELECT last FROM turns WHERE owner = ?1), 0) AS last)
SELECT before + coalesce((
  SELECT sum(min(n, before + ((coalesce(turns.last, 0), others.owner) < (turn.last, ?1))))
  FROM others LEFT JOIN turns USING (owner)), 0)
FROM mine, turn)",
              {job.owner, std::int64_t{job.priority}, job.sequence});
    rows.next();
    return static_cast<std::uint64_t>(rows.integer(0));
}

}  // namespace

StoredJob read_job(const Rows& rows) {
    StoredJob job;
    job.sequence = rows.integer(0);
    job.id = rows.text(1);
    job.state = rows.text(2);
    job.name = rows.text(3);
    job.key = {rows.text(4), static_cast<std::uint64_t>(rows.integer(5)), rows.text(6), rows.integer(7) != 0,
               rows.text(19)};
    job.cached = rows.integer(8) != 0;
    job.created = rows.text(9);
    job.started = rows.text(10);
    job.ended = rows.text(11);
    job.attempts = static_cast<int>(rows.integer(12));
    if (!rows.null(13)) job.kept = rows.integer(13) != 0;
    if (!rows.null(14)) job.fault = {static_cast<int>(rows.integer(14)), rows.text(15), rows.text(16)};
    job.revision = static_cast<std::uint64_t>(rows.integer(17));
    job.owner = rows.text(20);
    job.labels = split_labels(rows.text(21));
    job.priority = static_cast<int>(rows.integer(22));
    job.pinned = rows.integer(23) != 0;
    job.bytes = static_cast<std::uint64_t>(rows.integer(24));
    job.queued = rows.text(25);
    return job;
}

Value value(const std::optional<bool>& flag) {
    return flag ? Value(std::int64_t{*flag}) : Value();
}

Value value(std::uint64_t number) {
    return static_cast<std::int64_t>(number);
}

std::uint64_t count_in(Database& database, const std::string& state) {
    Rows rows(database, "SELECT count(*) FROM jobs WHERE state = ?", {state});
    rows.next();
    return static_cast<std::uint64_t>(rows.integer(0));
}

std::optional<StoredJob> find_by_id(Database& database, const std::string& id) {
    std::vector<StoredJob> jobs;
    {
        Rows rows(database, "SELECT * FROM jobs WHERE id = ?", {id});
        if (rows.next()) jobs.push_back(read_job(rows));
    }
    count_ahead(database, jobs);
    return jobs.empty() ? std::nullopt : std::optional(std::move(jobs.front()));
}

void count_ahead(Database& database, std::vector<StoredJob>& jobs) {
    for (StoredJob& job : jobs)
        if (job.state == job_states::queued) job.ahead = ahead_of(database, job);
}

void seal(Database& database, const std::string& id) {
    std::string checksum;
    {
        Rows rows(database, std::string(sealed_columns) + " WHERE id = ?", {id});
        if (!rows.next()) return;
        checksum = checksum_of(rows);
    }
    run(database, "UPDATE jobs SET checksum = ? WHERE id = ?", {checksum, id});
}

void seal_all(Database& database) {
    std::vector<std::string> ids;
    {
        Rows rows(database, "SELECT id FROM jobs");
        while (rows.next()) ids.push_back(rows.text(0));
    }
    for (const std::string& id : ids) seal(database, id);
}

std::vector<std::string> find_unsealed(Database& database) {
    std::vector<std::string> ids;
    Rows rows(database, sealed_columns);
    while (rows.next())
        if (rows.text(0) != checksum_of(rows)) ids.push_back(rows.text(2));
    return ids;
}

std::string join_labels(const std::vector<std::string>& labels) {
    std::string text;
    for (const std::string& label : labels) text += (text.empty() ? "" : "\n") + label;
    return text;
}

}  // namespace shadowbench::service
