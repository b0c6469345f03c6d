#include <fmt/format.h>

#include "compare/report.h"
#include "compare/words.h"

namespace shadowbench::compare {
namespace {

// XML 1.0 allows no control characters, even escaped.
std::string xml_escaped(const std::string& text) {
    std::string result;
    for (const char c : text) switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    return result;
}

std::string case_of(const Line& line, const Options& options) {
    const std::string what =
        fmt::format("{}: {}{}{}", to_string(line.verdict), values_text(line),
                    values_text(line).empty() || change_text(line).empty() ? "" : "; ", change_text(line));
    std::string text = fmt::format("  <testcase classname=\"{}\" name=\"{}\"", xml_escaped(title_of(line)),
                                   xml_escaped(line.measure.empty() ? "all measures" : line.measure));
    if (code_of(line, options) > 0)
        return text + fmt::format("><failure type=\"{}\" message=\"{}\">{}</failure></testcase>\n",
                                  to_string(line.verdict), xml_escaped(what),
                                  line.rerun.source.empty() ? "" : xml_escaped(command_of(line.rerun)));
    if (line.verdict == Verdict::inconclusive || line.verdict == Verdict::not_comparable ||
        line.verdict == Verdict::missing)
        return text + fmt::format("><skipped message=\"{}\"/></testcase>\n", xml_escaped(what));
    return text + "/>\n";
}

}  // namespace

std::string to_junit(const Comparison& comparison) {
    std::string cases;
    int failures = 0, skipped = 0;
    for (const Line& line : comparison.lines) {
        const bool fails = code_of(line, comparison.options) > 0;
        failures += fails;
        skipped += !fails && (line.verdict == Verdict::inconclusive || line.verdict == Verdict::not_comparable ||
                              line.verdict == Verdict::missing);
        cases += case_of(line, comparison.options);
    }
    std::string out;
    for (const FrontChange& change : comparison.fronts) out += front_text(change) + "\n";
    for (const std::string& note : comparison.notes) out += "note: " + note + "\n";
    std::string lines;  // xml_escaped() would replace line breaks
    for (std::size_t at = 0, end; (end = out.find('\n', at)) != std::string::npos; at = end + 1)
        lines += xml_escaped(out.substr(at, end - at)) + "\n";
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"shadowbench compare\" tests=\"{}\" "
        "failures=\"{}\" errors=\"0\" skipped=\"{}\">\n{}  <system-out>{}</system-out>\n</testsuite>\n",
        comparison.lines.size(), failures, skipped, cases, lines);
}

}  // namespace shadowbench::compare
