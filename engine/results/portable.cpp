#include "results/portable.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "results/report.h"

namespace shadowbench::results {
namespace {

using json = nlohmann::ordered_json;

constexpr int probes = 4096;

bool asks_embree(const json& cell) {
    return cell.at("status") == "ok" && cell.at("curve_error").is_null();
}

void make_portable_light(json& light) {
    light.erase("capture");
    json& cells = light.at("cells");
    cells.erase(std::remove_if(cells.begin(), cells.end(), asks_embree), cells.end());
    for (json& cell : cells) {
        cell.erase("on_bytes_error_front");  // a removed cell may have been on it
        cell.at("nodes").erase("histogram");
        cell["times"] = nullptr;
    }
}

}  // namespace

void make_portable_document(nlohmann::json& document) {
    if (const auto receivers = document.find("receivers");
        receivers != document.end() && receivers->value("type", "") == "camera")
        *receivers = {{"type", "probes"}, {"count", probes}};
    document["timing"] = {{"repetitions", 1}, {"lookups", 64}};
}

void make_portable_result(json& result) {
    strip_times(result);
    result["times"] = {{"started", ""}};
    result["machine"] = {{"cpu", "any"}, {"logical_cores", 0}};
    for (const char* name : {"commit", "compiler", "build_type"}) result.at("program")[name] = "any";
    for (json& variant : result.at("variants"))
        for (json& light : variant.at("lights")) make_portable_light(light);
}

}  // namespace shadowbench::results
