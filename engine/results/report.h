// A result as JSON, CSV and a table.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/result.h"

namespace shadowbench::results {

// Increased when a key of result.json changes its name or meaning.
inline constexpr int result_schema_version = 1;

// One line for each note of the file readers, indented: at most 5, then how many more there are and where to see them.
std::string notes_text(const std::vector<std::string>& notes, const std::string& indent);

// All measurements, as result.json. Values that depend on the clock are in objects under the key "times"; without
// these, two results of one scenario on one machine are equal. Numbers that do not exist or are not finite are null.
// "notes" is there only if there are some.
nlohmann::ordered_json to_json(const Result& result);

// One measure of a cell, as result.json has it.
nlohmann::ordered_json to_json(const FewestNodes& over);

// Adds the load and the job of Slurm, as far as they are known, to an object of times.
void add_state_to(nlohmann::ordered_json& out, const RunTimes& times);

// The inverse of to_json(), and the only place that reads measurements from a result.json: to_json(from_json(j)) == j
// for every j that to_json() wrote. Also reads results that earlier programs wrote under this schema version, and
// portable baselines (portable.h): what they lack keeps its default. Throws Error{bad_input} for a value that is
// missing, of another type or out of range; its place is `origin`, then the JSON pointer of the value.
Result from_json(const nlohmann::json& json, const std::string& origin);

// Removes every "times" object, at any depth.
void strip_times(nlohmann::ordered_json& result);

// A tidy table: a header line, then one row for each measure of each cell, with its interval, separated by commas and
// quoted as in RFC 4180. A cell without measures, which failed, has one row. results/README.md describes the columns.
std::string to_csv(const Result& result);

// A table for people: the notes of the file readers, then for each variant and light, what was captured and how
// accurate the truth is, then one line per cell. It has all columns, and its lines are as long as they are.
std::string to_table(const Result& result);

struct TableStyle {
    std::size_t width = 100;  // characters of a line, at least 60
    bool colour = false;
};

// The same with the columns that decide, in lines of this width: what does not fit goes on in the next line. Where the
// width is too small for all of them, it leaves out the interval of the error, then the ratio to the floor, then the
// interval of the time.
std::string to_fitting_table(const Result& result, const TableStyle& style = {});

// In a sentence or two a light, what the table means: which technique has the smallest error, and which of those that
// may have it takes the fewest bytes and answers fastest. Ties are called ties, and what the intervals of the fronts
// (fronts.h) leave open is called undecided. For many lights: in how many of them a technique is the cheapest.
std::string meaning_text(const Result& result, const TableStyle& style = {});

}  // namespace shadowbench::results
