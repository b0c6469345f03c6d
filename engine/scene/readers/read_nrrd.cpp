// Layout: the definition of the NRRD file format, teem.sourceforge.net/nrrd/format.html.
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/grid_files.h"
#include "scene/readers/header_fields.h"
#include "scene/readers/place_grid.h"
#include "scene/readers/text_lines.h"

namespace shadowbench::scene {
namespace {

struct TypeName {
    std::string_view name;
    ValueType type;
};
constexpr TypeName type_names[] = {
    {"signed char", ValueType::int8},
    {"int8", ValueType::int8},
    {"int8_t", ValueType::int8},
    {"uchar", ValueType::uint8},
    {"unsigned char", ValueType::uint8},
    {"uint8", ValueType::uint8},
    {"uint8_t", ValueType::uint8},
    {"short", ValueType::int16},
    {"short int", ValueType::int16},
    {"signed short", ValueType::int16},
    {"signed short int", ValueType::int16},
    {"int16", ValueType::int16},
    {"int16_t", ValueType::int16},
    {"ushort", ValueType::uint16},
    {"unsigned short", ValueType::uint16},
    {"unsigned short int", ValueType::uint16},
    {"uint16", ValueType::uint16},
    {"uint16_t", ValueType::uint16},
    {"int", ValueType::int32},
    {"signed int", ValueType::int32},
    {"int32", ValueType::int32},
    {"int32_t", ValueType::int32},
    {"uint", ValueType::uint32},
    {"unsigned int", ValueType::uint32},
    {"uint32", ValueType::uint32},
    {"uint32_t", ValueType::uint32},
    {"float", ValueType::float32},
    {"double", ValueType::float64},
};

constexpr int most_dimensions = 16;
constexpr std::string_view kinds_of_places[] = {"domain", "space", "time", "list", "none", "???", "stub", "scalar"};
constexpr const char* three_numbers = "vectors of three numbers are needed, as (1,0,0)";

// The axes of the file that are the volume's.
using Kept = std::array<std::size_t, 3>;

void check_magic(FileReader& file) {
    const std::string line = read_line(file).value_or("");
    constexpr std::string_view magic = "NRRD000";
    const bool known =
        line.size() == magic.size() + 1 && line.starts_with(magic) && line.back() >= '1' && line.back() <= '6';
    if (!known) file.fail(0, "not an NRRD file of a known version: its first line is not NRRD0001 to NRRD0006");
}

// Names of fields are the same with and without blanks ("data file", "datafile").
std::string field_name(std::string_view text) {
    std::string name = lower_case(text);
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    return name;
}

// Reads up to the empty line, or the end of the file.
HeaderFields read_fields(FileReader& file) {
    check_magic(file);
    HeaderFields fields(file);
    for (std::uint64_t at = file.position();; at = file.position()) {
        const std::optional<std::string> line = read_line(file);
        if (!line || line->empty()) return fields;
        if (line->starts_with('#')) continue;
        const std::size_t colon = line->find(':');
        if (colon == std::string::npos) file.fail(at, "a line of the header that gives no field a value");
        const std::string_view text = *line, value = text.substr(colon + 1);
        if (value.starts_with('=')) continue;  // a key with a value, for those who know it
        const std::string name = field_name(text.substr(0, colon));
        fields.add(name, trimmed(value), at);
        // A list of names follows, or a pattern of names is given.
        if (name == "datafile" && (trimmed(value).starts_with("LIST") || value.find('%') != std::string_view::npos))
            file.fail(at, "the values are in several files; unu save writes them into one");
    }
}

ValueType read_type(const HeaderFields& fields) {
    const HeaderField& field = fields.need("type");
    const std::string name = lower_case(field.value);
    const auto* known = std::find_if(std::begin(type_names), std::end(type_names),
                                     [&](const TypeName& one) { return one.name == name; });
    if (known == std::end(type_names))
        fields.fail(field,
                    fmt::format("values of the type \"{:.100}\"; integers of 8, 16 and 32 bits, float and double "
                                "are read: unu convert makes them",
                                name));
    return known->type;
}

Packing read_packing(const HeaderFields& fields) {
    const HeaderField& field = fields.need("encoding");
    const std::string name = lower_case(field.value);
    if (name == "raw") return Packing::none;
    if (name == "gzip" || name == "gz") return Packing::deflate;
    fields.fail(field,
                fmt::format("the encoding \"{:.100}\"; raw and gzip are read: unu save -f nrrd -e gzip writes it "
                            "so",
                            name));
}

ByteOrder read_order(const HeaderFields& fields, ValueType type) {
    if (bytes_of_value(type) == 1) return ByteOrder::little;
    const HeaderField& field = fields.need("endian");
    const std::string name = lower_case(field.value);
    if (name != "little" && name != "big") fields.fail(field, "neither little nor big");
    return name == "big" ? ByteOrder::big : ByteOrder::little;
}

// Numbers in parentheses, as "(1,0,0)"; empty for "none". Takes them off the front of the text.
std::vector<double> take_vector(const HeaderFields& fields, const HeaderField& field, std::string_view& text) {
    text = trimmed(text);
    if (text.starts_with("none")) {
        text.remove_prefix(4);
        return {};
    }
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == std::string_view::npos) fields.fail(field, three_numbers);
    std::vector<double> numbers;
    std::string_view rest = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    for (bool more = true; more;) {
        const std::size_t comma = rest.find(',');
        std::string_view word = trimmed(rest.substr(0, comma));
        const std::optional<double> number = coordinate(word);
        if (!number || numbers.size() == 3) fields.fail(field, three_numbers);
        numbers.push_back(*number);
        more = comma != std::string_view::npos;
        if (more) rest.remove_prefix(comma + 1);
    }
    if (numbers.size() != 3) fields.fail(field, three_numbers);
    return numbers;
}

Vec3d as_vector(const std::vector<double>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

using Directions = std::vector<std::vector<double>>;  // one for each axis, which may be empty

Directions read_directions(const HeaderFields& fields, std::size_t dimensions) {
    Directions directions;
    const HeaderField* field = fields.find("spacedirections");
    if (!field) return directions;
    std::string_view text = field->value;
    for (std::size_t i = 0; i < dimensions; ++i) directions.push_back(take_vector(fields, *field, text));
    if (!trimmed(text).empty()) fields.fail(*field, fmt::format("more than {} vectors", dimensions));
    return directions;
}

// Of more than three axes, leaves out those of one value, and those without a direction first.
Kept keep_axes(const HeaderFields& fields, const std::vector<std::int64_t>& sizes, const Directions& directions) {
    std::vector<std::size_t> axes(sizes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = i;
    const auto directed = [&](std::size_t i) { return directions.empty() || !directions[i].empty(); };
    while (axes.size() > 3) {
        auto leave = std::find_if(axes.begin(), axes.end(), [&](auto i) { return sizes[i] == 1 && !directed(i); });
        if (leave == axes.end()) leave = std::find_if(axes.begin(), axes.end(), [&](auto i) { return sizes[i] == 1; });
        if (leave == axes.end())
            fields.fail(fields.need("sizes"),
                        fmt::format("{} axes of more than one value, where 3 are read: save one of several channels or "
                                    "times, as unu slice does",
                                    axes.size()));
        axes.erase(leave);
    }
    return {axes[0], axes[1], axes[2]};
}

// A picture of three colours, say, has three axes too. Axes whose kind is not given may be anything.
void check_kinds(const HeaderFields& fields, const Kept& kept) {
    const HeaderField* field = fields.find("kinds");
    if (!field) return;
    std::string_view rest = field->value;
    std::size_t axis = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++axis) {
        const std::string kind = lower_case(word);
        const bool places =
            std::find(std::begin(kinds_of_places), std::end(kinds_of_places), kind) != std::end(kinds_of_places);
        if (!places && std::find(kept.begin(), kept.end(), axis) != kept.end())
            fields.fail(*field,
                        fmt::format("axis {} of the file has the kind \"{:.100}\", which is not one of places: save one "
                                    "of its values, as unu slice does",
                                    axis, kind));
    }
}

// Per axis; those that the file leaves open ("nan", or no field) are 1.
double spacing_of(const HeaderFields& fields, std::size_t axis) {
    const HeaderField* field = fields.find("spacings");
    if (!field) return 1.0;
    std::string_view rest = field->value, word = next_word(rest);
    for (std::size_t i = 0; i < axis; ++i) word = next_word(rest);
    if (lower_case(word) == "nan") return 1.0;
    const std::optional<double> spacing = coordinate(word);
    if (!spacing || !(*spacing > 0.0))
        fields.fail(*field,
                    fmt::format("axis {} of the file needs a spacing above 0, and at most {}", axis, max_coordinate));
    return *spacing;
}

std::array<Vec3d, 3> read_steps(const HeaderFields& fields, const Directions& directions, const Kept& kept) {
    std::array<Vec3d, 3> steps;
    steps.fill(Vec3d(0, 0, 0));
    for (std::size_t i = 0; i < 3; ++i) {
        if (directions.empty()) {
            steps[i][static_cast<int>(i)] = spacing_of(fields, kept[i]);
            continue;
        }
        if (directions[kept[i]].empty())
            fields.fail(fields.need("spacedirections"), "an axis of the volume has no direction");
        steps[i] = as_vector(directions[kept[i]]);
        if (steps[i] == Vec3d(0, 0, 0)) fields.fail(fields.need("spacedirections"), "a direction without length");
    }
    return steps;
}

std::optional<Vec3d> read_origin(const HeaderFields& fields) {
    const HeaderField* field = fields.find("spaceorigin");
    if (!field) return std::nullopt;
    std::string_view text = field->value;
    const std::vector<double> origin = take_vector(fields, *field, text);
    if (origin.empty()) return std::nullopt;
    return as_vector(origin);
}

// Passes the lines and bytes that stand in front of the values.
void read_begin(FileReader& data, const HeaderFields& fields, VoxelLayout& layout, std::uint64_t voxels) {
    const std::int64_t lines = fields.integer("lineskip", 0, 0), bytes = fields.integer("byteskip", -1, 0);
    for (std::int64_t i = 0; i < lines; ++i)
        if (!read_line(data))
            data.fail(data.position(), fmt::format("the file has fewer than {} lines to skip", lines));
    layout.begin = data.position();
    if (bytes >= 0) {
        layout.skip = static_cast<std::uint64_t>(bytes);
        return;
    }
    if (layout.packing != Packing::none)
        fields.fail(*fields.find("byteskip"), "-1, the end of the file, is for raw values alone");
    const std::uint64_t length = voxels * bytes_of_value(layout.type);
    data.need(length, 1, "voxels");
    layout.begin = data.size() - length;
}

std::vector<std::string> facts_of(const HeaderFields& fields, const VoxelLayout& layout, const std::string& axes) {
    std::vector<std::string> facts{text_of(layout)};
    if (!axes.empty()) facts.push_back("its axes run along " + axes);
    for (const char* name : {"space", "spaceunits", "units"})
        if (const HeaderField* field = fields.find(name))
            facts.push_back(fmt::format("{}: {:.100}", name == std::string_view("spaceunits") ? "space units" : name,
                                        field->value));
    return facts;
}

}  // namespace

GridFile read_nrrd(const std::filesystem::path& file, Negative negative, std::uint64_t most_voxels) {
    FileReader reader(file);
    const HeaderFields fields = read_fields(reader);
    const std::int64_t dimensions = fields.integer("dimension", 1, 0);
    if (dimensions < 3 || dimensions > most_dimensions)
        fields.fail(fields.need("dimension"),
                    fmt::format("{} dimensions, where a volume has 3 or, with some of one value, up to {}", dimensions,
                                most_dimensions));
    const HeaderField& sizes_field = fields.need("sizes");
    const std::vector<std::int64_t> sizes = fields.integers(sizes_field, static_cast<std::size_t>(dimensions));
    const Directions directions = read_directions(fields, sizes.size());
    const Kept kept = keep_axes(fields, sizes, directions);
    check_kinds(fields, kept);

    VoxelLayout layout;
    layout.size = size_of(fields, sizes_field, {sizes[kept[0]], sizes[kept[1]], sizes[kept[2]]});
    const std::uint64_t voxels = count_voxels(reader, sizes_field.at, layout.size, most_voxels);
    layout.type = read_type(fields);
    layout.packing = read_packing(fields);
    layout.order = read_order(fields, layout.type);
    const GridPlace place{read_steps(fields, directions, kept), read_origin(fields)};
    const std::optional<GridAxes> axes = find_axes(place.steps, layout.size);
    layout.axes = axes.value_or(GridAxes());

    const HeaderField* other_file = fields.find("datafile");
    std::optional<FileReader> other;
    if (other_file) other.emplace(file_beside(file, fields, *other_file));
    FileReader& data = other ? *other : reader;
    read_begin(data, fields, layout, voxels);
    GridFile result{read_voxels(data, layout, negative, Rest::noted), facts_of(fields, layout, text_of(axes, place))};
    if (fields.find("axismins") || fields.find("axismaxs"))
        result.volume.notes.lines.push_back(
            "its axis mins and maxs are passed over: spacings or directions give the box");
    if (const std::optional<std::string> fault = place_grid(result.volume, axes, place))
        fields.fail(axes ? sizes_field : fields.need("spacedirections"), *fault);
    return result;
}

}  // namespace shadowbench::scene
