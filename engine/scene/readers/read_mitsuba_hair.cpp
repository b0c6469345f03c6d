// Strands for Mitsuba: the plugin "hair" of version 0.6 and its binary form; "linearcurve" and "bsplinecurve" of
// version 3, whose points have radii.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"
#include "scene/limits.h"
#include "scene/readers/extension.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"
#include "scene/readers/hair_files.h"
#include "scene/readers/pbrt_files.h"
#include "scene/readers/strands.h"
#include "scene/readers/text_lines.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

constexpr std::string_view binary_magic = "BINARY_HAIR";

// Draws strands through their points as these come.
class StrandPoints {
public:
    explicit StrandPoints(CurveBasis basis) : basis_(basis) {}

    void reserve(std::uint64_t points) { strands_.reserve(points); }
    void next_strand() { given_ = 0; }

    void add(const StrandPoint& point) {
        if (basis_ == CurveBasis::linear) {
            if (given_++ == 0)
                strands_.begin(point);
            else
                strands_.line_to(point);
            return;
        }
        control_ = {control_[1], control_[2], control_[3], point};
        if (++given_ < 4) return;
        const CubicCurve curve = bezier_of_spline(control_);
        if (given_ == 4) strands_.begin(curve[0]);
        strands_.curve_to(curve);
    }

    // Of the strand so far.
    std::size_t given() const { return given_; }
    std::uint64_t points() const { return strands_.points(); }
    Hair finish() && { return std::move(strands_).finish(); }

private:
    CurveBasis basis_;
    Strands strands_;
    CubicCurve control_{};
    std::size_t given_ = 0;
};

HairFile read_text_strands(const std::filesystem::path& file, float radius, CurveBasis basis) {
    const std::string text = base::read_text(file);
    std::size_t number = 0, columns = 0;
    const auto fail = [&](const std::string& message) {
        throw Error(ErrorCode::bad_input, fmt::format("{}:{}", file.string(), number), message);
    };
    StrandPoints strands(basis);
    std::uint64_t short_splines = 0;
    const auto end_strand = [&] {
        if (basis == CurveBasis::bspline && strands.given() > 0 && strands.given() < 4) ++short_splines;
        strands.next_strand();
    };
    for (std::string_view left = text; !left.empty();) {
        std::string_view line = next_line(left);
        ++number;
        std::array<double, 4> values{};
        std::size_t count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
            const std::optional<double> value = coordinate(word);
            if (!value || count == values.size())
                fail(
                    fmt::format("\"{}\" does not belong to a point: each line is three finite numbers below {}, and a "
                                "radius or none",
                                word.substr(0, 40), max_coordinate));
            values[count++] = *value;
        }
        if (count == 0) {
            end_strand();
            continue;
        }
        if (count < 3) fail(fmt::format("{} numbers; a point needs 3, and a radius or none", count));
        if (columns == 0) columns = count;
        if (count != columns) fail(fmt::format("{} numbers, but the points before have {}", count, columns));
        if (values[3] < 0.0) fail("a radius is below 0");
        strands.add({Vec3d(values[0], values[1], values[2]), radius > 0.0f ? static_cast<double>(radius) : values[3]});
        if (strands.points() > max_hair_points) fail(fmt::format("over {} points of hair", max_hair_points));
    }
    if (columns == 0) throw Error(ErrorCode::bad_input, file.string(), "the file holds no points");
    end_strand();
    HairFile result{std::move(strands).finish(), columns == 4};
    if (short_splines > 0) result.passed_over.push_back({"splines of fewer than 4 points", short_splines});
    return result;
}

// The floats of a file up to its end, a block at a time.
class Floats {
public:
    explicit Floats(FileReader& reader) : reader_(reader) {}

    bool at_end() {
        if (next_ < block_.size()) return false;
        constexpr std::uint64_t most_at_once = 1 << 16;
        const std::uint64_t left = (reader_.size() - reader_.position()) / sizeof(float);
        block_ = reader_.array<float>(std::min(left, most_at_once), "points");
        next_ = 0;
        return block_.empty();
    }
    float peek() const { return block_[next_]; }
    float take() { return block_[next_++]; }
    // Of the next one in the file.
    std::uint64_t position() const { return reader_.position() - (block_.size() - next_) * sizeof(float); }

private:
    FileReader& reader_;
    std::vector<float> block_;
    std::size_t next_ = 0;
};

// An infinite number stands in front of the first point of each strand but the first.
HairFile read_binary_strands(FileReader& reader, float radius, CurveBasis basis) {
    reader.seek(binary_magic.size(), "number of points");
    const auto count = reader.value<std::uint32_t>("number of points");
    if (count > max_hair_points)
        reader.fail(binary_magic.size(), fmt::format("{} points of hair; the limit is {}", count, max_hair_points));
    reader.need(count, 3 * sizeof(float), "points");
    const std::uint64_t begin = reader.position();
    Floats values(reader);
    StrandPoints strands(basis);
    if (basis == CurveBasis::linear) strands.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!values.at_end() && std::isinf(values.peek())) {
            strands.next_strand();
            values.take();
        }
        Vec3f point(0.0f);
        for (int axis = 0; axis < 3; ++axis) {
            if (values.at_end()) reader.fail(reader.size(), "the file ends inside its points");
            if (!(std::abs(values.peek()) <= static_cast<float>(max_coordinate)))
                reader.fail(values.position(), "a position is not finite");
            point[axis] = values.take();
        }
        strands.add({Vec3d(point), static_cast<double>(radius)});
        if (strands.points() > max_hair_points)
            reader.fail(begin, fmt::format("over {} points of hair", max_hair_points));
    }
    return {std::move(strands).finish()};
}

}  // namespace

// Text begins with a number, perhaps after empty lines.
bool is_mitsuba_hair(const std::filesystem::path& file) {
    FileReader reader(file);
    const std::vector<char> bytes = reader.array<char>(std::min<std::uint64_t>(reader.size(), 64), "first bytes");
    const std::string_view head(bytes.data(), bytes.size());
    if (head.starts_with(binary_magic)) return true;
    const std::size_t first = head.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos &&
           std::string_view("+-.0123456789").find(head[first]) != std::string_view::npos;
}

HairFile read_mitsuba_hair(const std::filesystem::path& file, float radius, CurveBasis basis) {
    FileReader reader(file);
    if (reader.size() >= binary_magic.size()) {
        const std::vector<char> head = reader.array<char>(binary_magic.size(), "first bytes");
        if (std::string_view(head.data(), head.size()) == binary_magic)
            return read_binary_strands(reader, radius, basis);
    }
    return read_text_strands(file, radius, basis);
}

HairFile read_strands(const std::filesystem::path& file, float radius, CurveBasis basis) {
    const std::string extension = extension_of(file);
    if (extension == ".tfx") return {read_tressfx(file, radius)};
    if (extension == ".pbrt") {
        PbrtFile scene = read_pbrt(file);
        if (radius > 0.0f) std::fill(scene.hair.radii.begin(), scene.hair.radii.end(), radius);
        return {std::move(scene.hair), true, std::move(scene.passed_over)};
    }
    if (extension == ".txt" || is_mitsuba_hair(file)) return read_mitsuba_hair(file, radius, basis);
    return {read_hair(file, radius), true};
}

}  // namespace shadowbench::scene
