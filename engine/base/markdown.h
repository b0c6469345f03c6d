// Tables and text for Markdown reports.
#pragma once

#include <string>
#include <vector>

namespace shadowbench::base {

// The table, followed by a blank line. Bars inside fields are escaped. Rows must have as many fields as the header.
std::string markdown_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

// The text with its markup characters escaped, also bars, which would end a field; line breaks become spaces.
std::string markdown_escaped(const std::string& text);

}  // namespace shadowbench::base
