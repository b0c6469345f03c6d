#include "service/web/gallery.h"

#include <algorithm>
#include <map>

#include "service/web/document.h"

namespace shadowbench::service {
namespace {

constexpr const char* gallery_head = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Machines · shadowbench</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; margin: 1.5rem; }
div { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { border-bottom: 1px solid; padding: 0.3rem 0.8rem; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
</style>
</head>
<body>
<main>
<h1>Results of machines</h1>
<p>The median time of one lookup in random order, and its ratio to reading the same cache lines on that machine. Compare
techniques within a row. Times of different rows are of different machines: only the ratios carry over, and roughly.
~ marks a row whose machine was not quiet.</p>
)";

// The column of a technique, which is added if it is new.
std::vector<std::string> columns_of(const std::vector<const GalleryRow*>& rows) {
    std::vector<std::string> columns;
    for (const GalleryRow* row : rows)
        for (const auto& [title, text] : row->cells)
            if (std::find(columns.begin(), columns.end(), title) == columns.end()) columns.push_back(title);
    return columns;
}

std::string row_html(const GalleryRow& row, const std::vector<std::string>& columns) {
    const std::string where = row.name + ", " + row.machine + ", " + row.date + ", version " + row.version;
    std::string html = "<tr><th scope=\"row\">" + std::string(row.settled ? "" : "~ ") + escaped_html(where) + "</th>";
    for (const std::string& column : columns) {
        const auto cell = std::find_if(row.cells.begin(), row.cells.end(),
                                       [&](const auto& entry) { return entry.first == column; });
        html += "<td>" + (cell == row.cells.end() ? "" : escaped_html(cell->second)) + "</td>";
    }
    return html + "</tr>\n";
}

}  // namespace

std::string gallery_html(const std::vector<GalleryRow>& rows) {
    std::map<std::pair<std::string, std::string>, std::vector<const GalleryRow*>> tables;
    for (const GalleryRow& row : rows) tables[{row.scenario, row.light}].push_back(&row);
    std::string html = gallery_head;
    for (const auto& [of, measured] : tables) {
        const std::vector<std::string> columns = columns_of(measured);
        const std::string title = escaped_html(of.first + ", light " + of.second);
        html += "<h2>" + title + "</h2>\n<div role=\"region\" aria-label=\"" + title +
                "\" tabindex=\"0\">\n<table>\n<tr><th scope=\"col\">machine</th>";
        for (const std::string& column : columns) html += "<th scope=\"col\">" + escaped_html(column) + "</th>";
        html += "</tr>\n";
        for (const GalleryRow* row : measured) html += row_html(*row, columns);
        html += "</table>\n</div>\n";
    }
    return html + "</main>\n</body>\n</html>\n";
}

}  // namespace shadowbench::service
