#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/describe_file.h"
#include "scene/json_text.h"
#include "scene/new_scenario.h"
#include "service/cli/deep_file_text.h"
#include "service/cli/file_commands.h"
#include "service/cli/progress_bar.h"
#include "service/cli/terminal.h"
#include "techniques/deep/deep_file.h"

namespace shadowbench::service {
namespace {

using techniques::DeepFile;
using techniques::DeepTiling;

struct LevelFacts {
    std::uint64_t bytes = 0, nodes = 0, coloured = 0, empty = 0;
    std::size_t largest_tile = 0;
    std::uint32_t most_nodes = 0;
};

LevelFacts facts_of(const DeepFile& file, const DeepTiling& tiling) {
    LevelFacts facts;
    std::vector<std::byte> memory;
    for (std::size_t tile = tiling.first; tile < tiling.first + tiling.tiles(); ++tile) {
        const std::size_t bytes = file.tile_bytes(tile), pixels = file.tile_pixels(tile);
        memory.resize(std::max(memory.size(), bytes));
        file.read_tile(tile, memory.data());
        facts.bytes += bytes;
        facts.largest_tile = std::max(facts.largest_tile, bytes);
        for (std::size_t p = 0; p < pixels; ++p) {
            const auto function = techniques::function_of(memory.data(), pixels, file.channels(), p);
            facts.nodes += function.nodes;
            facts.most_nodes = std::max(facts.most_nodes, function.nodes);
            facts.coloured += function.channels == 3;
            facts.empty += function.nodes == 0;
        }
    }
    return facts;
}

std::string describe_level(const DeepTiling& t, const LevelFacts& facts, int channels) {
    const double pixels = static_cast<double>(t.width) * t.height;
    std::string text = fmt::format(
        "{} x {} pixels, {} empty; {} tile{} of {} bytes, the largest {}; {} nodes, {:.2f} a pixel, at most {}",
        t.width, t.height, facts.empty, t.tiles(), t.tiles() == 1 ? "" : "s", facts.bytes, facts.largest_tile,
        facts.nodes, static_cast<double>(facts.nodes) / pixels, facts.most_nodes);
    if (channels == 3) text += fmt::format("; {} pixels coloured", facts.coloured);
    return text;
}

bool is_deep_map(const std::string& file) {
    const std::filesystem::path extension = std::filesystem::path(file).extension();
    return extension == ".dsm" || extension == ".DSM";
}

// What loads the file in a scenario, in whole lines to copy; empty if it holds nothing to load.
std::string objects_text(const scene::DataFile& data, const std::string& name) {
    std::string text;
    if (!scene::casts_shadow(data)) return text;
    for (const auto& object : scene::scene_objects(data, name))
        text += fmt::format("  {}: {}\n", data.scene.deep_image ? "deep_image" : "object", scene::in_one_line(object));
    return text;
}

}  // namespace

std::string describe(const DeepFile& file, const std::string& name) {
    const techniques::DeepFileNotes& notes = file.notes();
    std::string text = fmt::format("{}: deep shadow map of {} bytes, all checksums right\n", name, file.file_bytes());
    if (!notes.text.empty()) text += fmt::format("  of: {}\n", notes.text);
    text += fmt::format("  {} channel{}, tolerance {:g}, depths {:g} to {:g}\n", file.channels(),
                        file.channels() == 1 ? "" : "s", notes.tolerance, notes.z_min, notes.z_max);
    text += fmt::format("  {} level{}, {} tile{} of {} x {} pixels\n", file.levels().size(),
                        file.levels().size() == 1 ? "" : "s", file.tiles(), file.tiles() == 1 ? "" : "s",
                        file.tile_size(), file.tile_size());
    for (std::size_t i = 0; i < file.levels().size(); ++i) {
        const DeepTiling& tiling = file.levels()[i];
        text += fmt::format("  level {}: {}\n", i, describe_level(tiling, facts_of(file, tiling), file.channels()));
    }
    return text;
}

void inspect_command(const FileArguments& arguments, std::ostream& out, std::ostream& err) {
    for (const std::string& file : arguments.files) {
        if (is_deep_map(file)) {
            out << terminal_lines(describe(DeepFile(file), file), out);
            continue;
        }
        const scene::DataFile data = read_data(arguments, file, err);
        ProgressBar bar(err);
        bar.show({std::filesystem::path(file).filename().string(), "look over", 0, 0});
        const std::string facts = scene::describe_file(data), objects = objects_text(data, file);
        bar.end();
        out << terminal_lines(facts, out) << objects;
    }
}

}  // namespace shadowbench::service
