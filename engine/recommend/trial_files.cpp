#include "recommend/trial_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/durable_file.h"
#include "base/error.h"
#include "base/hash_text.h"
#include "base/read_text.h"
#include "results/fields.h"
#include "results/report.h"
#include "results/sweep_cell.h"
#include "scene/parse_json.h"

namespace shadowbench::recommend {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using nlohmann::json;

constexpr std::uint64_t files_layout = 1;  // increased when a key of the files changes its name or meaning

// Of a file without its checksum.
std::string checksum_of(json file) {
    file.erase("checksum");
    return base::hash_text(file.dump());
}

json key_of(const results::Result& of, const json& question) {
    const json whole(results::to_json(of));
    return {{"scenario_hash", of.hash},       {"files", of.files},
            {"question", question},           {"program", whole.at("program")},
            {"machine", whole.at("machine")}, {"node", results::this_node()},
            {"threads", of.times.threads}};
}

[[noreturn]] void refuse_folder(const fs::path& folder, const std::error_code& why) {
    throw Error(ErrorCode::io, folder.string(), "the folder of the trials cannot be read or made: " + why.message());
}

FiledTrial read_filed(const results::Field& whole) {
    FiledTrial filed;
    const results::Field trial = whole.at("trial"), effort = whole.at("effort");
    filed.trial.failed = trial.at("failed").text();
    filed.trial.error = trial.at("error").number_or_infinity();
    const results::Field cost = trial.at("cost");
    if (cost.array().size() != costs) results::refuse(cost.where, "must hold a number for each cost");
    for (std::size_t k = 0; k < costs; ++k) filed.trial.cost[k] = cost.item(k).at_least_zero();
    filed.seconds = effort.at("seconds").at_least_zero();
    filed.rays = effort.at("rays").at_least_zero();
    const results::Field result = whole.at("result");
    results::Result read = results::from_json(result.value, result.where);
    if (read.variants.size() != 1 || read.variants[0].lights.size() != 1 ||
        read.variants[0].lights[0].cells.size() != 1)
        results::refuse(result.where, "must hold one variant with one light and one cell");
    filed.variant = std::move(read.variants[0]);
    return filed;
}

}  // namespace

TrialFiles::TrialFiles(fs::path folder, results::Result of, const json& question)
    : folder_(std::move(folder)), of_(std::move(of)), key_(key_of(of_, question).dump()) {
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) refuse_folder(folder_, failed);
    std::vector<fs::path> files;
    fs::directory_iterator entry(folder_, failed), end;
    for (; !failed && entry != end; entry.increment(failed)) {
        const fs::path& path = entry->path();
        if (path.filename().string().front() != '.' && path.extension() == ".json") files.push_back(path);
    }
    if (failed) refuse_folder(folder_, failed);
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) read(file);
}

void TrialFiles::read(const fs::path& file) {
    try {
        const json document = scene::parse_json(base::read_text(file.string()), file.string());
        const results::Field whole = results::top(document, file.string()), checksum = whole.at("checksum");
        if (checksum.text() != checksum_of(document))
            results::refuse(checksum.where, "is not that of the file: a value was changed after it was written");
        if (whole.at("layout").count() != files_layout || whole.at("of").value.dump() != key_) {
            ++others_;
            return;
        }
        filed_.insert_or_assign(whole.at("setting").text(), read_filed(whole));
    } catch (const Error& error) {
        if (error.code() != ErrorCode::bad_input) throw;
        throw Error(error.code(), error.where(),
                    error.message() + "; the file of this trial is damaged: remove it, and it is measured again");
    }
}

const FiledTrial* TrialFiles::find(const std::string& setting) const {
    const auto found = filed_.find(setting);
    return found == filed_.end() ? nullptr : &found->second;
}

void TrialFiles::write(const std::string& setting, const FiledTrial& filed) const {
    results::Result result = of_;
    result.variants = {filed.variant};
    const Trial& trial = filed.trial;
    const json key = json::parse(key_);
    json file{{"layout", files_layout},
              {"of", key},
              {"setting", setting},
              {"trial",
               {{"failed", trial.failed},
                {"error", std::isfinite(trial.error) ? json(trial.error) : json(nullptr)},
                {"cost", trial.cost}}},
              {"effort", {{"seconds", filed.seconds}, {"rays", filed.rays}}},
              {"result", results::to_json(result)}};
    file["checksum"] = checksum_of(file);
    const std::string name = base::hash_text(json::array({key, setting}).dump());
    base::write_durable(folder_ / (name + ".json"), file.dump(1) + "\n");
}

}  // namespace shadowbench::recommend
