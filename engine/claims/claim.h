// The claims of a paper beside our measurements, as plain values.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/result.h"

namespace shadowbench::claims {

enum class Verdict {
    holds,      // the value is met, or bettered if the paper claims a bound
    in_shape,   // only the direction or the law is the paper's
    fails,      // neither
    undecided,  // measured, but not judged: see undecided()
};
const char* to_string(Verdict verdict);  // "holds", "holds in shape", "does not hold here", "undecided"

// A number with its interval: 95 % for medians, or the number itself twice if nothing varies.
struct Value {
    double value = 0.0, low = 0.0, high = 0.0;
};
Value exactly(double value);
Value of(const results::Sample& sample);
Value operator/(const Value& a, const Value& b);  // both above 0; the widest interval that the operands allow
Value operator+(const Value& a, const Value& b);
Value operator-(const Value& a, const Value& b);
Value operator*(double factor, const Value& a);

// "14.2 [13.9, 14.6]", or "14.2" if nothing varies.
std::string to_text(const Value& value);

struct Claim {
    std::string place;     // in the paper: "section 6, figure 7"
    std::string says;      // what the paper says, with its value
    std::string measured;  // our value with its interval
    Verdict verdict = Verdict::fails;
    std::string why;            // one sentence
    std::vector<Value> values;  // the numbers in `measured`, in their order
};

// A claim that is measured but gets no verdict until its experiment is done again. `reason`, half a sentence, goes
// before the claim's own `why`.
Claim undecided(Claim claim, const std::string& reason);

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
    std::string caption;  // the columns, from left to right
    std::string png;      // the file's bytes
};

struct PaperReport {
    std::string id, title;
    std::string conditions;              // how our measurements differ from the paper's, one paragraph
    std::vector<std::string> documents;  // "name hash" of each scenario that was run
    double seconds = 0.0;
    std::vector<Claim> claims;
    std::vector<Table> tables;
    std::vector<Plot> plots;
    std::vector<Sheet> sheets;
};

// The functions below judge the value and both ends of its interval, and return the worst of the three verdicts.
// Within a factor of `near` of the paper's ratio: holds; on the same side of 1: in shape.
Verdict judge_ratio(double paper, const Value& measured, double near = 1.5);
// The same for a gain: a ratio further from 1 than the paper's holds too.
Verdict judge_gain(double paper, const Value& measured, double near = 1.5);
// Within `tolerance` of the paper's value: holds; within `shape` of it: in shape.
Verdict judge_value(double paper, const Value& measured, double tolerance, double shape);
// At most `holds`: holds; at most `shape`: in shape.
Verdict judge_at_most(const Value& measured, double holds, double shape);

}  // namespace shadowbench::claims
