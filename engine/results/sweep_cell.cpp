#include "results/sweep_cell.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "results/fields.h"
#include "results/report.h"

namespace shadowbench::results {
namespace {

// Of a cell's file without its checksum, whatever the order of its keys.
std::string checksum_of(nlohmann::json file) {
    file.at("cell").erase("checksum");
    return base::hash_text(file.dump());
}

}  // namespace

std::string cell_hash(const std::string& scenario_hash, std::span<const std::string> only, const CellPlace& place) {
    const std::vector<std::string> ids(only.begin(), only.end());
    return base::hash_text(nlohmann::json::array({scenario_hash, ids, place.variant, place.light}).dump());
}

std::string cell_hash(const SweepCell& cell) {
    return cell_hash(cell.result.hash, cell.result.only, cell.place);
}

std::string this_node() {
    if (const char* slurm = std::getenv("SLURMD_NODENAME"); slurm && *slurm) return slurm;
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string machine_text(const Machine& machine) {
    return fmt::format("{}{}{} core{}", machine.cpu, machine.cpu.empty() ? "" : ", ", machine.logical_cores,
                       machine.logical_cores == 1 ? "" : "s");
}

std::string machine_text(const SweepCell& cell) {
    return (cell.node.empty() ? "" : cell.node + ", ") + machine_text(cell.result.machine);
}

nlohmann::ordered_json to_json(const SweepCell& cell) {
    nlohmann::ordered_json file = to_json(cell.result);
    file["cell"] = {{"variant", cell.place.variant}, {"light", cell.place.light}, {"node", cell.node}};
    file["cell"]["checksum"] = checksum_of(nlohmann::json(file));
    return file;
}

SweepCell cell_from_json(const nlohmann::json& document, const std::string& origin) {
    const Field whole = top(document, origin), cell = whole.at("cell"), checksum = cell.at("checksum");
    if (checksum.text() != checksum_of(document))
        refuse(checksum.where, "is not that of the file: a value was changed after the file was written");
    SweepCell read;
    read.place = {cell.at("variant").count(), cell.at("light").count()};
    read.node = cell.at("node").text();
    read.result = from_json(document, origin);
    const Field variants = whole.at("variants");
    if (variants.array().size() != 1 || variants.item(0).at("lights").array().size() != 1)
        refuse(variants.where, "must hold one variant with one light");
    if (base::hash_text(read.result.document) != read.result.hash)
        refuse(whole.at("scenario_hash").where, "is not that of the scenario in this file");
    return read;
}

}  // namespace shadowbench::results
