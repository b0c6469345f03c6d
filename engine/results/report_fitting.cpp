#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/table.h"
#include "results/report.h"
#include "results/table_lines.h"

namespace shadowbench::results {
namespace {

using base::Colour;
using base::coloured;

constexpr std::size_t least_line = 60, rows_indent = 2, columns_gap = 2;
constexpr std::size_t name_room = 20, most_name_room = 24, least_name = 10;  // characters of the first column

enum FittingColumn {
    of_name,
    of_bytes,
    of_time,
    of_time_interval,
    of_floor,
    of_error,
    of_error_interval,
    of_front,
    of_verdict
};
constexpr FittingColumn left_out[] = {of_error_interval, of_floor, of_time_interval};  // in this order

using Shown = std::array<bool, of_verdict + 1>;  // one a FittingColumn

// What the columns mean that some table shows.
std::string fitting_legend(const Shown& shown) {
    std::string text = "lookup ns: median time of a lookup in random order";
    if (shown[of_time_interval]) text += ", with its 95 % interval";
    if (shown[of_floor]) text += ". x floor: its ratio to reading the same cache lines";
    text += ". error: RMS of lookups against the truth";
    if (shown[of_error_interval])
        text += ", with the 95 % interval expected over seeds of the rays (with ?: of the truth's uncertainty only)";
    return text +
           ". front: T certainly no other technique beats it in time and error, B in bytes and error; T? and B? "
           "perhaps none does. degraded: every promise holds, but none bounds the error, and it is above the noise "
           "tolerance. --wide shows all columns.\n";
}

using Fields = std::vector<std::string>;  // one a FittingColumn

Fields fields_of(const Cell& cell, const LightResult& light) {
    Fields fields{title(cell),      base::bytes_text(cell.bytes), "-", "-", "-", "-", "-",
                  front_text(cell), to_string(cell.verdict)};
    if (cell.times) {
        const LookupTimes& lookup = cell.times->random_order;
        fields[of_time] = time_text(lookup.ns, light);
        fields[of_time_interval] =
            fmt::format("{}-{}", time_text(lookup.ns.interval.low), time_text(lookup.ns.interval.high));
        if (lookup.ratio) fields[of_floor] = fmt::format("{:.1f}", lookup.ratio->median);
    }
    if (cell.lookup) {
        fields[of_error] = base::error_text(cell.lookup->norms.rms);
        fields[of_error_interval] = interval_text(*cell.lookup);
    }
    return fields;
}

// Of the first column: so much that no word of the settings is broken, in reason.
std::size_t room_for_words(const std::vector<Fields>& rows) {
    std::size_t room = name_room;
    for (const Fields& row : rows) {
        std::istringstream words(row[of_name]);
        for (std::string word; words >> word;) room = std::max(room, word.size() + 2);  // indented
    }
    return std::min(room, most_name_room);
}

// The columns that fit into lines of this width, and the width of the first.
struct Fitting {
    std::vector<FittingColumn> columns;
    std::size_t name_width = 0;
};

Fitting fit(const std::vector<Fields>& rows, std::size_t width) {
    std::vector<std::size_t> widths(rows[0].size(), 0);
    for (const Fields& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    Fitting fitting;
    for (std::size_t c = 0; c < widths.size(); ++c) fitting.columns.push_back(static_cast<FittingColumn>(c));
    const auto rest = [&] {
        std::size_t used = rows_indent;
        for (const FittingColumn c : fitting.columns)
            if (c != of_name) used += columns_gap + widths[c];
        return used;
    };
    const std::size_t wanted = std::min(widths[of_name], room_for_words(rows));
    for (const FittingColumn column : left_out)
        if (rest() + wanted > width) std::erase(fitting.columns, column);
    const std::size_t left = width > rest() ? width - rest() : 0;
    fitting.name_width = std::min(widths[of_name], std::max(left, least_name));
    return fitting;
}

// A title in lines of this width, all but the first indented.
std::vector<std::string> lines_of_title(const std::string& text, std::size_t width) {
    std::vector<std::string> lines;
    std::string line;
    const auto end_line = [&] {
        lines.push_back(line);
        line = "  ";
    };
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        std::string word = text.substr(at, end - at);
        at = end + 1;
        const bool begins = line.find_first_not_of(' ') == std::string::npos;
        if (!begins && line.size() + 1 + word.size() > width)
            end_line();
        else if (!begins)
            line += ' ';
        while (line.size() + word.size() > width) {
            const std::size_t part = width - line.size();
            line += word.substr(0, part);
            word.erase(0, part);
            end_line();
        }
        line += word;
    }
    lines.push_back(line);
    return lines;
}

Colour colour_of(Verdict verdict) {
    return verdict == Verdict::kept ? Colour::green : verdict == Verdict::degraded ? Colour::yellow : Colour::red;
}

void paint(Fields& fields, const Cell& cell) {
    fields[of_verdict] = coloured(fields[of_verdict], colour_of(cell.verdict));
    if (fields[of_front].find_first_of("TB") != std::string::npos)
        fields[of_front] = coloured(fields[of_front], Colour::bold);
}

// The reasons of what failed, and which techniques were not made for this scene.
std::string below_rows(const LightResult& light, const TableStyle& style) {
    std::string failed, opaque;
    for (const Cell& cell : light.cells) {
        if (cell.status == CellStatus::failed)
            failed += "    failed: " + title(cell) + ": " + cell.reason + "\n";
        else if (cell.outside_promise)
            opaque += (opaque.empty() ? "    promised for opaque scenes only: " : ", ") + title(cell);
    }
    failed = base::wrapped(failed, style.width);
    if (style.colour && !failed.empty()) failed = coloured(failed, Colour::red);
    return failed + base::wrapped(opaque, style.width);
}

std::string rows_text(const LightResult& light, const TableStyle& style, Shown& shown) {
    std::vector<Fields> rows{
        {"technique", "bytes", "lookup ns", "95 %", "x floor", "error", "95 %", "front", "verdict"}};
    for (const Cell& cell : light.cells) rows.push_back(fields_of(cell, light));
    const Fitting fitting = fit(rows, style.width);
    for (const FittingColumn column : fitting.columns) shown[column] = true;
    const auto chosen = [&](const Fields& fields) {
        Fields some;
        for (const FittingColumn column : fitting.columns) some.push_back(fields[column]);
        return some;
    };
    base::Table table(chosen(rows[0]));
    for (std::size_t r = 1; r < rows.size(); ++r) {
        Fields& fields = rows[r];
        if (style.colour) paint(fields, light.cells[r - 1]);
        for (const std::string& name : lines_of_title(fields[of_name], fitting.name_width)) {
            fields[of_name] = name;
            table.add(chosen(fields));
            fields.assign(fields.size(), "");
        }
    }
    return table.text(std::string(rows_indent, ' '));
}

std::string warned(const std::string& text, const TableStyle& style) {
    const bool warning = text.find("WARNING") != std::string::npos || text.find("UNSETTLED") != std::string::npos;
    const std::string lines = base::wrapped(text, style.width);
    return style.colour && warning ? coloured(lines, Colour::yellow) : lines;
}

}  // namespace

std::string to_fitting_table(const Result& result, const TableStyle& asked) {
    const TableStyle style{std::max(asked.width, least_line), asked.colour};
    std::string text = base::wrapped(heading_text(result), style.width);
    bool marked = false;
    Shown shown{};
    for (const VariantResult& variant : result.variants) {
        text += base::wrapped(settings_lines(variant), style.width);
        for (const LightResult& light : variant.lights) {
            const Settling found = settling(light);
            marked = marked || !found.uncertain.empty();
            text += base::wrapped(text_above(light, result.times.threads), style.width) +
                    rows_text(light, style, shown) + below_rows(light, style) + warned(text_below(light, found), style);
        }
    }
    return text + base::wrapped(fitting_legend(shown), style.width) +
           (marked ? base::wrapped(uncertain_legend, style.width) : "");
}

}  // namespace shadowbench::results
