// The rules by which claims are judged: one rule for all claims of a kind, with limits that stand before anything is
// measured. The report prints this table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "claims/value.h"

namespace shadowbench::claims {

enum class Verdict {
    holds,
    in_shape,  // the direction or the law is the paper's, the size of the effect is not
    fails,
    undecided,        // the interval of the measurement crosses a limit of the rule
    not_comparable,   // measured, but not what the paper measured: GPU times, scenes that are not public
    by_construction,  // the technique cannot do otherwise; tests check it
};
inline constexpr std::size_t verdicts = 6;
const char* to_string(Verdict verdict);  // "holds", "holds in shape", "does not hold here", ...

struct Rule {
    const char* id;        // "gain"
    const char* says;      // what the paper says: "A is r times B, or better"
    const char* holds;     // the limits in words
    const char* in_shape;  // "-" if there is no such verdict
    const char* reason;    // why these limits
};
std::span<const Rule> all_rules();

// A verdict, and how it was found.
struct Judged {
    Verdict verdict = Verdict::fails;
    std::string rule;    // ids, joined by commas
    std::string limits;  // the numbers of the rule for this claim: "holds in [0.91, 1.1], in shape in [0.67, 1.5]"
    Verdict best = Verdict::holds, worst = Verdict::fails;  // that it may be if it is undecided
};

// Of each rule below, `measured` is the quantity that the claim is about, and the whole interval of it is judged: if
// all of it lies within a limit, that verdict is certain; if it crosses a limit, the claim is undecided.
Judged judge_ratio(double paper, const Value& measured);
// Of percentages that are added, which have no side of 1. The interval of the paper's value is the range that it names.
Judged judge_added(const Value& paper, const Value& measured);
Judged judge_gain(double paper, const Value& measured);
Judged judge_size(double paper, double without, const Value& measured);
// The interval of the paper's value holds what is rounded to the digits that it prints.
Judged judge_size(const Value& paper, double without, const Value& measured);
Judged judge_exponent(double paper, const Value& measured);
Judged judge_at_most_exponent(double paper, const Value& measured);  // "O(x^p)": what grows less keeps the bound
Judged judge_constant(const Value& factor);
Judged judge_growth(const Value& factor);
Judged judge_negligible(const Value& share);
Judged judge_less(const Value& less, const Value& more);
Judged judge_much_less(const Value& less, const Value& more);
Judged judge_significant(const Value& less, const Value& more);
Judged judge_alike(const Value& one, const Value& other);
// `share`: the difference of two pictures over that of the picture without the paper's idea from the second.
Judged judge_likeness(const Value& share);
Judged judge_fit(const Value& largest_error);
Judged judge_unnoticed(const Value& difference);
Judged judge_visible(const Value& difference);
Judged judge_offset(const Value& pixels);
Judged judge_count(int exact, int over, int entries);  // entries that reach the number, that exceed it, of all
Judged by_construction(bool kept);
Judged not_comparable();

// Claims of several parts. An undecided part may have any verdict from its best to its worst. Where the claim's verdict
// is the same for all of them, it is decided.

// A claim of two halves: the worse of their verdicts. Does not hold is the worst, then not comparable, then in shape.
Judged both(const Judged& a, const Judged& b);
// A claim about "most cases": the verdict that more than half of the cases have at least.
Judged in_most(const std::vector<Judged>& cases);
// A claim about all cases: the worst of their verdicts, but in shape if it holds in most.
Judged in_all(const std::vector<Judged>& cases);
// A claim that a case can be found: the best of their verdicts.
Judged in_any(const std::vector<Judged>& cases);
// A claim whose words can be read in several ways: the verdict of all readings. If they differ it is undecided, and may
// be any of theirs.
Judged in_readings(const std::vector<Judged>& readings);

}  // namespace shadowbench::claims
