// Layout: the documentation of MetaIO, itk.org/Wiki/ITK/MetaIO/Documentation. Of its header's matrix, row i is the
// direction of the image's axis i, as ITK reads it; the offset is the centre of the first voxel.
#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

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
constexpr TypeName type_names[] = {{"met_char", ValueType::int8},     {"met_uchar", ValueType::uint8},
                                   {"met_short", ValueType::int16},   {"met_ushort", ValueType::uint16},
                                   {"met_int", ValueType::int32},     {"met_uint", ValueType::uint32},
                                   {"met_long", ValueType::int32},    {"met_ulong", ValueType::uint32},
                                   {"met_float", ValueType::float32}, {"met_double", ValueType::float64}};

// Reads up to the field that ends the header. Names are taken in lower case.
HeaderFields read_fields(FileReader& file) {
    HeaderFields fields(file);
    for (std::uint64_t at = file.position();; at = file.position()) {
        const std::optional<std::string> line = read_line(file);
        if (!line) return fields;
        if (trimmed(*line).empty()) continue;
        const std::size_t equals = line->find('=');
        if (equals == std::string::npos)
            file.fail(at, "not a line of a MetaImage header, which gives a field a value: \"NDims = 3\"");
        const std::string_view text = *line;
        const std::string name = lower_case(trimmed(text.substr(0, equals)));
        fields.add(name, trimmed(text.substr(equals + 1)), at);
        if (name == "elementdatafile") return fields;
    }
}

// The first of these fields that is there, since a field has had several names.
const HeaderField* find_first(const HeaderFields& fields, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        if (const HeaderField* field = fields.find(name)) return field;
    return nullptr;
}

bool is_true(const HeaderFields& fields, const HeaderField* field, bool absent) {
    if (!field) return absent;
    const std::string value = lower_case(field->value);
    if (value == "true" || value == "t" || value == "1") return true;
    if (value != "false" && value != "f" && value != "0") fields.fail(*field, "neither True nor False");
    return false;
}

void check_kind(const HeaderFields& fields) {
    if (const HeaderField* kind = fields.find("objecttype"); kind && lower_case(kind->value) != "image")
        fields.fail(*kind, "not an image");
    const HeaderField& dimensions = fields.need("ndims");
    if (const auto count = fields.integers(dimensions, 1)[0]; count != 3)
        fields.fail(dimensions, fmt::format("{} dimensions, where a volume has 3", count));
    if (fields.integer("elementnumberofchannels", 1, 1) != 1)
        fields.fail(fields.need("elementnumberofchannels"),
                    "several channels; a volume of one is read: save one alone");
    if (const HeaderField* binary = fields.find("binarydata"); !is_true(fields, binary, true))
        fields.fail(*binary, "values in text are not read: save them as binary data");
}

ValueType read_type(const HeaderFields& fields) {
    const HeaderField& field = fields.need("elementtype");
    const std::string name = lower_case(field.value);
    const auto* known = std::find_if(std::begin(type_names), std::end(type_names),
                                     [&](const TypeName& one) { return one.name == name; });
    if (known == std::end(type_names))
        fields.fail(field, fmt::format("values of the type \"{:.100}\"; integers of 8, 16 and 32 bits, MET_FLOAT and "
                                       "MET_DOUBLE are read: convert it in the program that wrote it",
                                       field.value));
    return known->type;
}

ByteOrder read_order(const HeaderFields& fields) {
    const HeaderField* field = find_first(fields, {"binarydatabyteordermsb", "elementbyteordermsb"});
    return is_true(fields, field, false) ? ByteOrder::big : ByteOrder::little;
}

Vec3d vector_at(const std::vector<double>& numbers, std::size_t begin) {
    return {numbers[begin], numbers[begin + 1], numbers[begin + 2]};
}

std::array<Vec3d, 3> read_steps(const HeaderFields& fields) {
    std::array<Vec3d, 3> steps{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
    const HeaderField* matrix = find_first(fields, {"transformmatrix", "rotation", "orientation"});
    if (matrix) {
        const std::vector<double> numbers = fields.numbers(*matrix, 9);
        for (std::size_t i = 0; i < 3; ++i) {
            steps[i] = vector_at(numbers, 3 * i);
            if (steps[i] == Vec3d(0, 0, 0)) fields.fail(*matrix, "a direction without length");
        }
    }
    if (const HeaderField* spacing = find_first(fields, {"elementspacing", "elementsize"})) {
        const std::vector<double> numbers = fields.numbers(*spacing, 3);
        for (std::size_t i = 0; i < 3; ++i) {
            if (!(numbers[i] > 0.0)) fields.fail(*spacing, "a spacing must be above 0");
            steps[i] *= numbers[i];
        }
    }
    return steps;
}

// The centre of the first voxel.
Vec3d read_offset(const HeaderFields& fields) {
    const HeaderField* offset = find_first(fields, {"offset", "position", "origin"});
    return offset ? vector_at(fields.numbers(*offset, 3), 0) : Vec3d(0, 0, 0);
}

// Sets where the values begin.
void read_begin(const FileReader& data, const HeaderFields& fields, VoxelLayout& layout, std::uint64_t voxels) {
    layout.begin = data.position();
    const std::int64_t bytes = fields.integer("headersize", -1, 0);
    if (bytes > 0) layout.begin = static_cast<std::uint64_t>(bytes);
    if (bytes >= 0) return;
    if (layout.packing != Packing::none)
        fields.fail(fields.need("headersize"), "-1, the end of the file, is for values without compression alone");
    const std::uint64_t length = voxels * bytes_of_value(layout.type);
    if (length > data.size())
        data.fail(data.size(), fmt::format("the file is too short: its voxels have {} bytes", length));
    layout.begin = data.size() - length;
}

}  // namespace

GridFile read_metaimage(const std::filesystem::path& file, Negative negative, std::uint64_t most_voxels) {
    FileReader reader(file);
    const HeaderFields fields = read_fields(reader);
    check_kind(fields);
    const HeaderField& size_field = fields.need("dimsize");
    VoxelLayout layout;
    layout.size = size_of(fields, size_field, fields.integers(size_field, 3));
    const std::uint64_t voxels = count_voxels(reader, size_field.at, layout.size, most_voxels);
    layout.type = read_type(fields);
    layout.order = read_order(fields);
    layout.packing = is_true(fields, fields.find("compresseddata"), false) ? Packing::deflate : Packing::none;
    const GridPlace place{read_steps(fields), read_offset(fields)};
    const std::optional<GridAxes> axes = find_axes(place.steps, layout.size);
    layout.axes = axes.value_or(GridAxes());

    const HeaderField& data_file = fields.need("elementdatafile");
    if (data_file.value.starts_with("LIST") || data_file.value.find('%') != std::string::npos)
        fields.fail(data_file, "the values are in several files: save them in one");
    std::optional<FileReader> other;
    if (lower_case(data_file.value) != "local") other.emplace(file_beside(file, fields, data_file));
    FileReader& data = other ? *other : reader;
    read_begin(data, fields, layout, voxels);

    GridFile result{read_voxels(data, layout, negative, Rest::noted), {text_of(layout)}};
    if (const std::string along = text_of(axes, place); !along.empty())
        result.facts.push_back("its axes run along " + along);
    if (const std::optional<std::string> fault = place_grid(result.volume, axes, place))
        fields.fail(axes ? size_field : *find_first(fields, {"transformmatrix", "rotation", "orientation"}), *fault);
    return result;
}

}  // namespace shadowbench::scene
