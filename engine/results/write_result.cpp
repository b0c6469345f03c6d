#include "results/write_result.h"

#include <nlohmann/json.hpp>

#include "base/write_files.h"
#include "results/report.h"

namespace shadowbench::results {

void write_result(const std::filesystem::path& folder, const Result& result) {
    base::write_files(
        {{folder / "result.json", to_json(result).dump(1) + "\n"}, {folder / "result.csv", to_csv(result)}});
}

}  // namespace shadowbench::results
