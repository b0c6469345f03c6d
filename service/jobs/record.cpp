#include "service/jobs/record.h"

#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/write_files.h"
#include "service/jobs/folders.h"
#include "service/jobs/utc.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* record_name = ".job.json";
constexpr int record_version = 1;

json parse_file(const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_regular_file(fs::symlink_status(file, ignored))) return {};
    return json::parse(base::read_text(file), nullptr, false);
}

KeptJob from_record(const json& record, const std::string& id) {
    KeptJob kept;
    kept.job.id = id;
    record.at("name").get_to(kept.job.name);
    record.at("scenario_hash").get_to(kept.job.key.hash);
    record.at("seed").get_to(kept.job.key.seed);
    record.at("program").get_to(kept.job.key.program);
    record.at("pictures").get_to(kept.job.key.pictures);
    record.at("cached").get_to(kept.job.cached);
    record.at("created").get_to(kept.job.created);
    record.at("started").get_to(kept.job.started);
    record.at("ended").get_to(kept.job.ended);
    record.at("attempts").get_to(kept.job.attempts);
    kept.job.kept = record.at("promises_kept").get<bool>();
    record.at("scenario").get_to(kept.scenario);
    if (record.at("id") == id) {
        record.at("idempotency_key").get_to(kept.idempotency_key);
        record.at("request").get_to(kept.request);
    }
    return kept;
}

bool any_failed(const json& result) {
    for (const json& variant : result.at("variants"))
        for (const json& light : variant.at("lights"))
            for (const json& cell : light.at("cells"))
                if (cell.at("status") == "failed") return true;
    return false;
}

std::string time_of(const fs::path& file) {
    struct stat status {};
    return ::stat(file.c_str(), &status) == 0 ? utc_text(status.st_mtim) : now_utc();
}

KeptJob from_result(const json& result, const fs::path& folder, const std::string& id) {
    KeptJob kept;
    kept.job.id = id;
    result.at("name").get_to(kept.job.name);
    result.at("scenario_hash").get_to(kept.job.key.hash);
    const json& scenario = result.at("scenario");
    kept.job.key.seed = scenario.value(json::json_pointer("/rays/seed"), std::uint64_t{1});
    const json& program = result.at("program");
    kept.job.key.program = program.at("version").get<std::string>() + " " + program.at("commit").get<std::string>();
    // A scene without objects has no pictures, whether they were wanted or not.
    kept.job.key.pictures = fs::exists(folder / "images") || !scenario.at("scene").contains("objects");
    kept.job.ended = time_of(folder / "result.json");
    const std::string started = result.at("times").value("started", "");
    kept.job.created = kept.job.started = started.empty() ? kept.job.ended : started;
    kept.job.attempts = 1;
    kept.job.kept = !any_failed(result);
    kept.scenario = scenario.dump();
    return kept;
}

}  // namespace

bool is_job_id(const std::string& text) {
    return text.size() == 18 && text.starts_with("j-") &&
           text.find_first_not_of("0123456789abcdef", 2) == std::string::npos;
}

void write_record(const fs::path& folder, const KeptJob& kept) {
    const StoredJob& job = kept.job;
    const nlohmann::ordered_json record = {{"record_version", record_version},
                                           {"id", job.id},
                                           {"name", job.name},
                                           {"scenario_hash", job.key.hash},
                                           {"seed", job.key.seed},
                                           {"program", job.key.program},
                                           {"pictures", job.key.pictures},
                                           {"cached", job.cached},
                                           {"created", job.created},
                                           {"started", job.started},
                                           {"ended", job.ended},
                                           {"attempts", job.attempts},
                                           {"promises_kept", job.kept.value_or(true)},
                                           {"idempotency_key", kept.idempotency_key},
                                           {"request", kept.request},
                                           {"scenario", kept.scenario}};
    base::write_files(
        {{folder / record_name, record.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"}});
}

std::optional<KeptJob> read_record(const fs::path& folder, const std::string& id) {
    std::error_code ignored;
    if (!fs::is_directory(fs::symlink_status(folder, ignored)) || !find_file_in(folder, "result.json"))
        return std::nullopt;
    try {
        if (const json record = parse_file(folder / record_name); record.is_object()) return from_record(record, id);
    } catch (const json::exception&) {
        // Read from result.json instead.
    }
    try {
        return from_result(parse_file(folder / "result.json"), folder, id);
    } catch (const json::exception&) {
        return std::nullopt;
    }
}

bool has_record_of(const fs::path& folder, const std::string& id) {
    std::error_code ignored;
    if (!fs::is_directory(fs::symlink_status(folder, ignored))) return false;
    const json record = parse_file(folder / record_name);
    return record.is_object() && record.value("id", json()) == id;
}

}  // namespace shadowbench::service
