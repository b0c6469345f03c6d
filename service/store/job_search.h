// The search of texts in a job store: FTS5's index of the trigrams of what is searched. Each change of a job changes
// its text in the same transaction.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "service/store/database.h"

namespace shadowbench::service {

// A text in which upper and lower case of the letters of all scripts are the same. What is not well-formed UTF-8, and
// zero bytes, become U+FFFD.
std::string fold_case(std::string_view text);

// The beginning of a folded text as a phrase of FTS5's language of queries; empty for one shorter than a trigram.
std::string phrase_of(std::string_view folded);

// Makes the index anew of all jobs, within a transaction.
void make_search(sqlite::Database& database);

// Brings the text of a job up to date, or removes it before its job is.
void index_job(sqlite::Database& database, const std::string& id);
void unindex_job(sqlite::Database& database, const std::string& id);

// Whether the index is there, has the texts of all jobs and no others, and finds them all. For connections that write.
bool is_search_whole(sqlite::Database& database);

// A line for each fault of the index. For connections that only read.
std::vector<std::string> find_search_faults(sqlite::Database& database);

}  // namespace shadowbench::service
