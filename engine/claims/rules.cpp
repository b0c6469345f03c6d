#include "claims/rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace shadowbench::claims {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double near_ratio = 1.5, far_ratio = 3.0;          // factors
constexpr double near_size = 1.1, far_size = 1.35;           // factors
constexpr double near_exponent = 0.05, far_exponent = 0.25;  // distances
constexpr double constant = 1.25, nearly_constant = 2.0;     // factors
constexpr double negligible = 0.1, small = 1.0 / 3.0;        // shares
constexpr double much = 0.3;                                 // "much less" is at most this share
constexpr double alike = 1.1, similar = 1.5;                 // factors
constexpr double fits = 0.02, fits_roughly = 0.05;           // of visibility
constexpr double grey_step = 1.0 / 255.0;                    // of a picture of 8 bits
constexpr double edge_step = 1.0;                            // pixels

constexpr Rule rules[] = {
    {"ratio", "A is r times B, or adds r % to it",
     "the ratio is within a factor of 1.5 of r, or of the nearer end of a range that the paper names",
     "within a factor of 3, on the same side of 1 (a percentage that is added has no such side)",
     "Scenes and machines differ; 1.5 is what a rebuilt scene or another compiler explains. Three times more or less "
     "is another effect."},
    {"gain", "A is r times better than B", "the gain is at least r / 1.5", "at least r / 3, and a gain",
     "As for a ratio, but a larger gain than the paper's fulfils its claim."},
    {"size", "a map is s times as large as another",
     "within 10 % of s, or of a value that rounds to s as the paper prints it",
     "nearer to s than to the size without the paper's idea (their geometric mean), at most 1.35 times off on the "
     "other "
     "side",
     "Sizes follow from the method and do not depend on the machine."},
    {"exponent", "a quantity grows as x^p", "the fitted exponent is within 0.05 of p", "within 0.25 of p",
     "0.25 separates the laws that the papers compare: 1/4, 1/2, 1."},
    {"bound", "a quantity grows at most as x^p, or slowly: O(x^p)", "the fitted exponent is at most p + 0.05",
     "at most p + 0.25",
     "The counterpart of exponent with one side: what grows less than a bound keeps it. The limits are those of "
     "exponent."},
    {"constant", "a time does not change, or only slightly", "it grows by at most a factor of 1.25",
     "by at most a factor of 2",
     "Another compiler or cache explains 1.25. A time that followed the samples, the width, the steps of a blurred "
     "function or the depths of a cell would at least double."},
    {"growth", "a time or a width grows", "by a factor of at least 2", "by a factor of at least 1.25",
     "The counterpart of constant."},
    {"negligible", "one cost is negligible beside another", "it is at most a tenth", "at most a third",
     "A tenth is within the noise of most measurements of a frame."},
    {"less", "A is less than B", "A is certainly less", "-", "The paper gives a direction, and no size."},
    {"much less", "A is much less than B, or B shows artifacts that A does not", "A is at most 0.3 of B",
     "A is less than B", "A smaller error of the same order is less, but not much less."},
    {"significant", "A is significantly less than B", "A is at most B / 1.25", "A is less than B",
     "What differs by a factor of 1.25 or less has changed slightly: see constant. No more than that can be asked: one "
     "of the images of which Reeves et al. say that they cost significantly less takes 0.69."},
    {"alike", "A is as good as B", "their errors are within 10 % of each other", "within a factor of 1.5",
     "Neither may be the better picture: the rule has two sides."},
    {"likeness", "the picture of A looks like that of B",
     "they differ by at most 0.3 of the difference that the paper's idea is to remove", "by less than that difference",
     "The paper compares the pictures with each other, and not with a truth. Without the paper's idea A would be "
     "another picture. What looks like B must differ from B much less than that one does."},
    {"fit", "a stored function fits almost exactly", "its largest error is at most 0.02", "at most 0.05",
     "0.02 are five grey levels of 8 bits, at the single worst depth. A claim that is also read by the mean over "
     "depth has the same limits for it."},
    {"unnoticed", "a difference is not noticed", "it is at most 1/255", "-", "One grey level of a picture of 8 bits."},
    {"visible", "an artifact is visible", "it is more than 1/255", "-", "The counterpart of unnoticed."},
    {"offset", "a boundary's offset is not noticed",
     "the boundary is moved by at most a pixel of the picture, on average", "-",
     "A picture shows the place of an edge to a pixel."},
    {"count", "a number of outcomes is reached", "it is reached in every entry and never exceeded",
     "never exceeded, but not always reached", "Counting is exact."},
    {"construction", "a size, a format, or arithmetic of a cost that the paper counts", "not judged: the technique cannot do otherwise", "-",
     "Tests check it; measuring it shows nothing about the method."},
    {"not comparable",
     "the size of a GPU's time, a number of a scene that is not public, or a method without a stated accuracy",
     "not judged: the number is given", "-",
     "A processor's thread cannot test a GPU's time, a stand-in does not have another scene's numbers, and a limit "
     "that the paper does not give would be ours. What a paper says of its methods is judged on stand-ins, too."},
};

struct Range {
    double low, high;
};

bool inside(const Value& value, const Range& range) {
    return value.low >= range.low && value.high <= range.high;
}

bool apart(const Value& value, const Range& range) {
    return value.high < range.low || value.low > range.high;
}

std::string to_text(const Range& range) {
    if (range.low == -infinity) return fmt::format("up to {:.3g}", range.high);
    if (range.high == infinity) return fmt::format("from {:.3g}", range.low);
    return fmt::format("in [{:.3g}, {:.3g}]", range.low, range.high);
}

// `in_shape` contains `holds`. Undecided, the verdict may be any that a value of the interval has.
Judged judge(const char* rule, const Value& value, const Range& holds, const Range& in_shape) {
    const bool one_limit = holds.low == in_shape.low && holds.high == in_shape.high;
    Judged judged{Verdict::undecided, rule, "holds " + to_text(holds)};
    if (!one_limit) judged.limits += ", in shape " + to_text(in_shape);
    if (!(std::isfinite(value.low) && std::isfinite(value.high))) return judged;
    judged.best = apart(value, in_shape) ? Verdict::fails : apart(value, holds) ? Verdict::in_shape : Verdict::holds;
    judged.worst = inside(value, holds)      ? Verdict::holds
                   : inside(value, in_shape) ? Verdict::in_shape
                                             : Verdict::fails;
    if (judged.best == judged.worst) judged.verdict = judged.best;
    return judged;
}

Judged judge(const char* rule, const Value& value, const Range& holds) {
    return judge(rule, value, holds, holds);
}

Judged judge_at_most(const char* rule, const Value& value, double holds, double in_shape) {
    return judge(rule, value, {-infinity, holds}, {-infinity, in_shape});
}

}  // namespace

const char* to_string(Verdict verdict) {
    switch (verdict) {
        case Verdict::holds:
            return "holds";
        case Verdict::in_shape:
            return "holds in shape";
        case Verdict::fails:
            return "does not hold here";
        case Verdict::undecided:
            return "undecided";
        case Verdict::not_comparable:
            return "not comparable";
        case Verdict::by_construction:
            return "by construction";
    }
    return "";
}

std::span<const Rule> all_rules() {
    return rules;
}

Judged judge_ratio(double paper, const Value& measured) {
    const Range side{paper > 1.0 ? 1.0 : 0.0, paper < 1.0 ? 1.0 : infinity};
    return judge("ratio", measured, {paper / near_ratio, paper * near_ratio},
                 {std::min(std::max(paper / far_ratio, side.low), paper / near_ratio),
                  std::max(std::min(paper * far_ratio, side.high), paper * near_ratio)});
}

Judged judge_added(const Value& paper, const Value& measured) {
    return judge("ratio", measured, {paper.low / near_ratio, paper.high * near_ratio},
                 {paper.low / far_ratio, paper.high * far_ratio});
}

Judged judge_gain(double paper, const Value& measured) {
    return judge("gain", measured, {paper / near_ratio, infinity},
                 {std::min(std::max(paper / far_ratio, 1.0), paper / near_ratio), infinity});
}

Judged judge_size(double paper, double without, const Value& measured) {
    return judge_size(exactly(paper), without, measured);
}

Judged judge_size(const Value& paper, double without, const Value& measured) {
    const Range near{paper.low / near_size, paper.high * near_size};
    const Range far = without > paper.value
                          ? Range{paper.low / far_size, std::max(std::sqrt(paper.high * without), near.high)}
                          : Range{std::min(std::sqrt(paper.low * without), near.low), paper.high * far_size};
    return judge("size", measured, near, far);
}

Judged judge_exponent(double paper, const Value& measured) {
    return judge("exponent", measured, {paper - near_exponent, paper + near_exponent},
                 {paper - far_exponent, paper + far_exponent});
}

Judged judge_at_most_exponent(double paper, const Value& measured) {
    return judge_at_most("bound", measured, paper + near_exponent, paper + far_exponent);
}

Judged judge_constant(const Value& factor) {
    return judge_at_most("constant", factor, constant, nearly_constant);
}

Judged judge_growth(const Value& factor) {
    return judge("growth", factor, {nearly_constant, infinity}, {constant, infinity});
}

Judged judge_negligible(const Value& share) {
    return judge_at_most("negligible", share, negligible, small);
}

Judged judge_less(const Value& less, const Value& more) {
    Judged judged{Verdict::undecided, "less", ""};
    if (less.high < more.low) judged.verdict = judged.worst = Verdict::holds;
    if (less.low >= more.high) judged.verdict = judged.best = Verdict::fails;
    return judged;
}

Judged judge_much_less(const Value& less, const Value& more) {
    return judge_at_most("much less", less / more, much, 1.0);
}

Judged judge_significant(const Value& less, const Value& more) {
    return judge_at_most("significant", less / more, 1.0 / constant, 1.0);
}

Judged judge_alike(const Value& one, const Value& other) {
    return judge("alike", one / other, {1.0 / alike, alike}, {1.0 / similar, similar});
}

Judged judge_likeness(const Value& share) {
    return judge_at_most("likeness", share, much, 1.0);
}

Judged judge_visible(const Value& difference) {
    return judge("visible", absolute(difference), {grey_step, infinity});
}

Judged judge_fit(const Value& largest_error) {
    return judge_at_most("fit", largest_error, fits, fits_roughly);
}

Judged judge_unnoticed(const Value& difference) {
    return judge("unnoticed", absolute(difference), {-infinity, grey_step});
}

Judged judge_offset(const Value& pixels) {
    return judge("offset", absolute(pixels), {-infinity, edge_step});
}

Judged judge_count(int exact, int over, int entries) {
    return {over > 0           ? Verdict::fails
            : exact == entries ? Verdict::holds
                               : Verdict::in_shape,
            "count", fmt::format("holds at {} of {}", entries, entries)};
}

Judged by_construction(bool kept) {
    return {kept ? Verdict::by_construction : Verdict::fails, "construction", ""};
}

Judged not_comparable() {
    return {Verdict::not_comparable, "not comparable", ""};
}

}  // namespace shadowbench::claims
