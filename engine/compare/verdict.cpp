#include <algorithm>

#include "compare/compare.h"

namespace shadowbench::compare {

const char* to_string(Verdict verdict) {
    switch (verdict) {
        case Verdict::same:
            return "same";
        case Verdict::faster:
            return "faster";
        case Verdict::slower:
            return "slower";
        case Verdict::smaller:
            return "smaller";
        case Verdict::larger:
            return "larger";
        case Verdict::more_accurate:
            return "more accurate";
        case Verdict::less_accurate:
            return "less accurate";
        case Verdict::inconclusive:
            return "inconclusive";
        case Verdict::not_comparable:
            return "not comparable";
        case Verdict::missing:
            return "missing";
        case Verdict::extra:
            return "extra";
    }
    return "";
}

std::string title_of(const std::string& suite, const std::string& group, const std::string& cell) {
    std::string title = suite;
    for (const std::string* part : {&group, &cell})
        if (!part->empty()) title += " / " + *part;
    return title;
}

std::string title_of(const Line& line) {
    return title_of(line.suite, line.group, line.cell);
}

int code_of(const Line& line, const Options& options) {
    switch (line.verdict) {
        case Verdict::larger:
        case Verdict::less_accurate:
            return 2;
        case Verdict::slower:
            return 1;
        case Verdict::missing:
            return options.allow_missing ? 0 : 2;
        case Verdict::not_comparable:
            return options.allow_missing || line.time ? 0 : 2;
        default:
            return 0;
    }
}

int exit_code(const Comparison& comparison) {
    int code = 0;
    for (const Line& line : comparison.lines) code = std::max(code, code_of(line, comparison.options));
    return code;
}

}  // namespace shadowbench::compare
