#include "service/jobs/record.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/read_text.h"
#include "base/write_files.h"
#include "results/fields.h"
#include "results/report.h"
#include "service/jobs/folders.h"
#include "service/jobs/utc.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using nlohmann::json;
using results::Field;

constexpr int record_version = 1;
constexpr int deepest = 200;  // levels of a JSON text; results have fewer, and json::dump() recurses

// Nothing where there is no file, or a folder or a link. Throws Error{io} when it cannot be read.
std::optional<std::string> read_file(const fs::path& file) {
    if (type_of(file) != fs::file_type::regular) return std::nullopt;
    return base::read_bytes(file);
}

// Nothing for text that is not JSON.
std::optional<json> parse(const std::string& text) {
    bool too_deep = false;
    json read = json::parse(
        text, [&](int depth, json::parse_event_t, const json&) { return !(too_deep = too_deep || depth > deepest); },
        false);
    return read.is_discarded() || too_deep ? std::nullopt : std::optional(std::move(read));
}

// Reads contents of a file, which throws Error{bad_input} where they are damaged; `damaged` then makes the answer.
template <class Read, class Damaged>
auto read_unless_damaged(const Read& read, const Damaged& damaged) {
    try {
        return read();
    } catch (const Error& error) {
        if (error.code() != ErrorCode::bad_input) throw;
        return damaged(error);
    }
}

std::vector<std::string> labels_of(const Field& field) {
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < field.array().size(); ++i) {
        const Field label = field.item(i);
        if (label.text().find('\n') != std::string::npos) results::refuse(label.where, "must be one line");
        labels.push_back(label.text());
    }
    return labels;
}

// The size and the hash of each file of a folder of results, but the record itself.
json sums_of(const fs::path& folder) {
    json sums = json::object();
    for (const std::string& name : list_files(folder)) {
        const std::string bytes = base::read_bytes(folder / name);
        sums[name] = {{"bytes", bytes.size()}, {"hash", base::hash_text(bytes)}};
    }
    return sums;
}

std::string text_of(const json& record) {
    return record.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

KeptJob from_record(const Field& record, const std::string& id) {
    KeptJob kept;
    kept.job.id = id;
    kept.job.name = record.at("name").text();
    kept.job.key.hash = record.at("scenario_hash").text();
    kept.job.key.seed = record.at("seed").count();
    kept.job.key.program = record.at("program").text();
    kept.job.key.pictures = record.at("pictures").truth();
    if (record.has("recommend")) kept.job.key.recommend = record.at("recommend").text();
    kept.job.cached = record.at("cached").truth();
    kept.job.created = record.at("created").text();
    kept.job.started = record.at("started").text();
    kept.job.ended = record.at("ended").text();
    const Field attempts = record.at("attempts");
    if (attempts.count() > std::numeric_limits<int>::max()) results::refuse(attempts.where, "must be below 2^31");
    kept.job.attempts = static_cast<int>(attempts.count());
    kept.job.kept = record.at("promises_kept").truth();
    kept.scenario = record.at("scenario").text();
    if (record.has("owner")) {  // as records of earlier versions do not
        kept.job.owner = record.at("owner").text();
        kept.job.labels = labels_of(record.at("labels"));
        kept.job.priority = static_cast<int>(std::clamp(record.at("priority").number(), -1000.0, 1000.0));
        kept.job.pinned = record.at("pinned").truth();
    }
    if (record.at("id").text() == id) {
        kept.idempotency_key = record.at("idempotency_key").text();
        kept.request = record.at("request").text();
    }
    return kept;
}

// Nothing without a record, or when it is damaged.
std::optional<KeptJob> read_record(const fs::path& folder, const std::string& id) {
    const fs::path file = folder / record_name;
    const std::optional<std::string> text = read_file(file);
    const std::optional<json> record = text ? parse(*text) : std::nullopt;
    if (!record) return std::nullopt;
    return read_unless_damaged([&] { return std::optional(from_record(results::top(*record, file.string()), id)); },
                               [](const Error&) { return std::optional<KeptJob>(); });
}

std::string time_of(const fs::path& file) {
    struct stat status {};
    return ::stat(file.c_str(), &status) == 0 ? utc_text(status.st_mtim) : now_utc();
}

// What a recommendation was asked; the command line does not note it. Empty for the result of a run.
std::string request_of(const json& document) {
    const auto recommendation = document.find("recommendation");
    if (recommendation == document.end()) return "";
    return recommendation->is_object() ? recommendation->value("request", json::object()).dump() : "{}";
}

// Whether a technique from outside was measured.
bool has_library(const results::Result& result) {
    for (const results::VariantResult& variant : result.variants)
        for (const results::LightResult& light : variant.lights)
            for (const results::Cell& cell : light.cells)
                if (cell.library) return true;
    return false;
}

KeptJob from_result(const results::Result& result, const json& document, const fs::path& folder,
                    const std::string& id) {
    const Field scenario = results::top(document, "").at("scenario");
    KeptJob kept;
    kept.job.id = id;
    kept.job.name = result.name;
    kept.job.key.hash = result.hash;
    const bool has_seed = scenario.has("rays") && scenario.at("rays").has("seed");
    kept.job.key.seed = has_seed ? scenario.at("rays").at("seed").count() : std::uint64_t{1};
    kept.job.key.program = result.program.version + " " + result.program.commit;
    // It answers no later request: which libraries were loaded is not known.
    if (has_library(result)) kept.job.key.program += " with a technique from outside";
    kept.job.key.recommend = request_of(document);
    // A scene without objects has no pictures, whether they were wanted or not.
    kept.job.key.pictures = type_of(folder / "images") != fs::file_type::not_found ||
                            (kept.job.key.recommend.empty() && !scenario.at("scene").has("objects"));
    kept.job.ended = time_of(folder / "result.json");
    kept.job.created = kept.job.started = result.times.started.empty() ? kept.job.ended : result.times.started;
    kept.job.attempts = 1;
    kept.job.kept = !results::any_failed(result);
    kept.scenario = result.document;
    return kept;
}

}  // namespace

bool is_job_id(const std::string& text) {
    return text.size() == 18 && text.starts_with("j-") &&
           text.find_first_not_of("0123456789abcdef", 2) == std::string::npos;
}

void write_record(const fs::path& folder, const KeptJob& kept) {
    const StoredJob& job = kept.job;
    const json record = {{"record_version", record_version},
                         {"id", job.id},
                         {"name", job.name},
                         {"scenario_hash", job.key.hash},
                         {"seed", job.key.seed},
                         {"program", job.key.program},
                         {"pictures", job.key.pictures},
                         {"recommend", job.key.recommend},
                         {"cached", job.cached},
                         {"created", job.created},
                         {"started", job.started},
                         {"ended", job.ended},
                         {"attempts", job.attempts},
                         {"promises_kept", job.kept.value_or(true)},
                         {"idempotency_key", kept.idempotency_key},
                         {"request", kept.request},
                         {"owner", job.owner},
                         {"labels", job.labels},
                         {"priority", job.priority},
                         {"pinned", job.pinned},
                         {"files", sums_of(folder)},
                         {"scenario", kept.scenario}};
    base::write_files({{folder / record_name, text_of(record)}});
}

void pin_in_record(const fs::path& folder, bool pinned) {
    const std::optional<std::string> text = read_file(folder / record_name);
    std::optional<json> record = text ? parse(*text) : std::nullopt;
    if (!record || !record->is_object()) return;
    (*record)["pinned"] = pinned;
    base::write_files({{folder / record_name, text_of(*record)}});
}

std::vector<std::string> check_files(const fs::path& folder) {
    const std::optional<std::string> text = read_file(folder / record_name);
    if (!text) return {};
    const std::optional<json> record = parse(*text);
    if (!record || !record->is_object()) return {(folder / record_name).string() + ": the record is damaged"};
    const json kept = record->value("files", json::object()), found = sums_of(folder);
    std::vector<std::string> faults;
    for (const auto& [name, sum] : kept.items()) {
        const std::string file = (folder / name).string();
        if (!found.contains(name))
            faults.push_back(file + ": is missing");
        else if (found[name] != sum)
            faults.push_back(file + ": is damaged: its checksum differs");
    }
    return faults;
}

FoundResults read_results(const fs::path& folder, const std::string& id) {
    if (type_of(folder) != fs::file_type::directory) return {{}, "not a folder of results"};
    const std::optional<std::string> text = read_file(folder / "result.json");
    if (!text) return {{}, "it has no result.json"};
    const std::optional<json> document = parse(*text);
    if (!document) return {{}, "its result.json is damaged: it is not JSON"};
    return read_unless_damaged(
        [&]() -> FoundResults {
            const results::Result result = results::from_json(*document, "");
            if (auto kept = read_record(folder, id)) return {std::move(kept), ""};
            return {from_result(result, *document, folder, id), ""};
        },
        [](const Error& error) -> FoundResults {
            return {{}, fmt::format("its result.json is not a result that this program reads: {}", error.what())};
        });
}

bool has_record_of(const fs::path& folder, const std::string& id) {
    if (type_of(folder) != fs::file_type::directory) return false;
    const std::optional<std::string> text = read_file(folder / record_name);
    const std::optional<json> record = text ? parse(*text) : std::nullopt;
    return record && record->is_object() && record->value("id", json()) == id;
}

}  // namespace shadowbench::service
