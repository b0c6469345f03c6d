#include "service/jobs/progress_line.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

using nlohmann::json;

std::string dump(const nlohmann::ordered_json& line) {
    return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string text(const json& object, const char* key) {
    const auto value = object.find(key);
    if (value == object.end() || !value->is_string()) return {};
    return base::Error(base::ErrorCode::internal, "", value->get_ref<const std::string&>()).message();
}

std::uint64_t count(const json& object, const char* key) {
    const auto value = object.find(key);
    return value != object.end() && value->is_number_unsigned() ? value->get<std::uint64_t>() : 0;
}

JobProgress progress_of(const json& line) {
    JobProgress progress{text(line, "stage"), text(line, "place"), count(line, "done"), count(line, "total"), 0.0};
    const auto fraction = line.find("fraction");
    if (fraction != line.end() && fraction->is_number() && std::isfinite(fraction->get<double>()))
        progress.fraction = std::clamp(fraction->get<double>(), 0.0, 1.0);
    return progress;
}

// A code that is not a base::ErrorCode becomes `internal`.
JobFault fault_of(const json& error) {
    int code = 0;
    for (const base::ErrorCode known :
         {base::ErrorCode::usage, base::ErrorCode::bad_input, base::ErrorCode::no_such_file, base::ErrorCode::io})
        if (count(error, "code") == static_cast<std::uint64_t>(known)) code = static_cast<int>(known);
    return {code ? code : static_cast<int>(base::ErrorCode::internal), text(error, "where"), text(error, "message")};
}

}  // namespace

std::string progress_line(const bench::Progress& progress, double fraction) {
    return dump({{"stage", progress.stage},
                 {"place", progress.place},
                 {"done", progress.done},
                 {"total", progress.total},
                 {"fraction", fraction}});
}

std::string error_line(const base::Error& error) {
    return dump({{"error",
                  {{"code", static_cast<int>(error.code())}, {"where", error.where()}, {"message", error.message()}}}});
}

std::string storage_line(const StorageFault& fault) {
    return dump({{"storage", {{"message", fault.message}, {"bytes", fault.bytes}}}});
}

std::variant<std::monostate, JobProgress, JobFault, StorageFault> read_line(std::string_view line) {
    const json read = json::parse(line, nullptr, false);
    if (!read.is_object()) return {};
    if (read.contains("stage")) return progress_of(read);
    const auto storage = read.find("storage");
    if (storage != read.end() && storage->is_object())
        return StorageFault{text(*storage, "message"), count(*storage, "bytes")};
    const auto error = read.find("error");
    if (error != read.end() && error->is_object()) return fault_of(*error);
    return {};
}

}  // namespace shadowbench::service
