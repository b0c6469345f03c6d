// The search of texts in a job store: what is searched of each job, in memory. The rows are the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "service/store/database.h"
#include "service/store/job_store.h"

namespace shadowbench::service {

// A text in which upper and lower case of the letters of all scripts are the same. What is not well-formed UTF-8, and
// zero bytes, become U+FFFD.
std::string fold_case(std::string_view text);

// What is searched of a job, folded: a line for each part, and line breaks around them, so that a label or an owner can
// be looked for as a whole.
std::string searched_text(const StoredJob& job);

// The texts of all jobs, read from the rows when the first search asks for them. Thread-safe.
class JobTexts {
public:
    // Reads the texts that it does not have, for one thread at a time. Changes of jobs wait for some hundred rows at
    // most. Throws Error{io}.
    void load(sqlite::Database& rows);

    // The new text of a job, once its row is on the disk; an empty one: the job was removed.
    void set(std::int64_t sequence, std::string text) noexcept;

    // The jobs below `before` whose text has all these parts, the newest first, and perhaps some with a long text that
    // has not: only its beginning is kept. At most `most`.
    std::vector<std::int64_t> find(const std::vector<std::string>& parts, std::int64_t before, std::size_t most) const;

private:
    mutable std::mutex mutex_;
    std::map<std::int64_t, std::string> texts_;
    std::int64_t loaded_ = 0;  // the texts of the jobs up to this one are here, and kept up to date
};

}  // namespace shadowbench::service
