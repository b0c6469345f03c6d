#include <filesystem>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/write_files.h"
#include "compare/history.h"
#include "results/write_result.h"
#include "service/cli/gate_commands.h"
#include "service/web/history_page.h"

namespace shadowbench::service {

void history_command(const HistoryArguments& arguments, std::ostream& out) {
    compare::HistoryOptions options;
    options.last = static_cast<std::size_t>(arguments.last);
    options.effect = arguments.effect / 100.0;
    const nlohmann::ordered_json history = compare::history_json(arguments.folder, options);
    const std::filesystem::path folder = arguments.out.empty() ? "results/history" : arguments.out;
    const std::filesystem::path numbers = folder / "history.json", page = folder / "history.html";
    base::write_files({{numbers, history.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"},
                       {page, history_html(nlohmann::json(history))}});
    out << compare::history_text(history) << fmt::format("written: {}, {}\n", numbers.string(), page.string());
}

}  // namespace shadowbench::service
