// What run and merge print of their results.
#pragma once

#include <iosfwd>
#include <ostream>
#include <string>
#include <vector>

#include "results/merge_cells.h"
#include "results/report.h"

namespace CLI {
class App;
}

namespace shadowbench::service {

struct OutputArguments {
    bool wide = false;         // all columns of the table
    bool json = false;         // the results as JSON, and nothing else
    bool csv = false;          // the results as CSV, and nothing else
    bool quiet = false;        // no text, and no progress
    bool has_data() const { return json || csv; }
};

class Output {
public:
    // `several`: --json prints an array.
    Output(const OutputArguments& arguments, bool several, std::ostream& out, std::ostream& err);

    // For people: standard output, or nothing with --json, --csv or --quiet.
    std::ostream& text() { return text_; }
    // For progress: standard error, or nothing with --quiet.
    std::ostream& progress() { return progress_; }
    const results::TableStyle& style() const { return style_; }

    // Prints the table, or keeps the data for end().
    void add(const results::Result& result);
    void add(const results::Merged& merged);
    // What the table of a result means, unless --quiet, --json or --csv.
    void explain(const results::Result& result);
    // Prints the data.
    void end();

private:
    void print_table(const results::Result& result);
    void keep(const std::string& json, const std::string& csv);

    const OutputArguments arguments_;
    const bool several_;
    std::ostream& out_;
    std::ostream nowhere_{nullptr};
    std::ostream& text_;
    std::ostream& progress_;
    const results::TableStyle style_;
    std::string json_, csv_;
};

}  // namespace shadowbench::service
