// The claims of a paper beside our measurements, as plain values.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "claims/rules.h"
#include "claims/value.h"

namespace shadowbench::claims {

struct Claim {
    std::string place;     // in the paper: "section 6, figure 7"
    std::string says;      // what the paper says, with its value
    std::string measured;  // our value with its interval
    Judged judged;
    std::string why;            // one sentence
    std::vector<Value> values;  // the numbers in `measured`, in their order
};

// Rows of text under a header.
struct Table {
    std::string title;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

// Curves over one axis, drawn as an SVG file.
struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points;
    bool line = true;  // joined by a line; otherwise only points
};
struct Plot {
    std::string name;  // of the file, without extension
    std::string title, x_label, y_label;
    bool log_x = false, log_y = false;
    std::vector<Series> series;
};

// Pictures side by side.
struct Sheet {
    std::string name;     // of the file, without extension
    std::string caption;  // what the pictures are, and in which order: sentences, without the last full stop
    std::string png;      // the file's bytes
};

struct PaperReport {
    std::string id, title;
    std::string conditions;               // how our measurements differ from the paper's, one paragraph
    std::vector<std::string> documents;   // "name hash" of each scenario that was run
    double seconds = 0.0;                 // of the measurement
    std::optional<double> steal_seconds;  // that the host took from all processors meanwhile; absent if unknown
    std::vector<Claim> claims;
    std::vector<Table> tables;
    std::vector<Plot> plots;
    std::vector<Sheet> sheets;
};

}  // namespace shadowbench::claims
