// Tables for Markdown reports.
#pragma once

#include <string>
#include <vector>

namespace shadowbench::base {

// With a blank line behind it. Bars inside of fields are escaped. Rows have as many fields as the header.
std::string markdown_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

}  // namespace shadowbench::base
