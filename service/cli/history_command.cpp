#include <filesystem>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/write_result.h"
#include "compare/history.h"
#include "service/cli/gate_commands.h"

namespace shadowbench::service {

void history_command(const HistoryArguments& arguments, std::ostream& out) {
    compare::HistoryOptions options;
    options.last = static_cast<std::size_t>(arguments.last);
    options.effect = arguments.effect / 100.0;
    const nlohmann::ordered_json history = compare::history_json(arguments.folder, options);
    const std::filesystem::path file =
        std::filesystem::path(arguments.out.empty() ? "results/history" : arguments.out) / "history.json";
    bench::write_files({{file, history.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"}});
    out << compare::history_text(history) << fmt::format("written: {}\n", file.string());
}

}  // namespace shadowbench::service
