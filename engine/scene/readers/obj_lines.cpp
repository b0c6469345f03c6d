#include "scene/readers/obj_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene/readers/read_mesh.h"
#include "scene/readers/text_lines.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

// The other words that may begin a line, with the name under which such a line is passed over; the name is empty if no
// surface is lost.
struct Keyword {
    std::string_view word, lost;
};
constexpr std::string_view free_form = "free-form curves and surfaces", other_files = "calls of other files";
constexpr std::array keywords{
    Keyword{"l", "lines"},
    Keyword{"p", "points"},
    Keyword{"curv", free_form},
    Keyword{"curv2", free_form},
    Keyword{"surf", free_form},
    Keyword{"bzp", free_form},
    Keyword{"bsp", free_form},
    Keyword{"cdc", free_form},
    Keyword{"cdp", free_form},
    Keyword{"call", other_files},
    Keyword{"csh", other_files},
    // Normals, parameters, names, materials, and display settings.
    Keyword{"vn", ""},
    Keyword{"vp", ""},
    Keyword{"g", ""},
    Keyword{"s", ""},
    Keyword{"o", ""},
    Keyword{"mg", ""},
    Keyword{"usemtl", ""},
    Keyword{"mtllib", ""},
    Keyword{"usemap", ""},
    Keyword{"maplib", ""},
    Keyword{"bevel", ""},
    Keyword{"c_interp", ""},
    Keyword{"d_interp", ""},
    Keyword{"lod", ""},
    Keyword{"shadow_obj", ""},
    Keyword{"trace_obj", ""},
    Keyword{"ctech", ""},
    Keyword{"stech", ""},
    // Parts of free-form curves and surfaces.
    Keyword{"cstype", ""},
    Keyword{"deg", ""},
    Keyword{"bmat", ""},
    Keyword{"step", ""},
    Keyword{"res", ""},
    Keyword{"parm", ""},
    Keyword{"trim", ""},
    Keyword{"hole", ""},
    Keyword{"scrv", ""},
    Keyword{"sp", ""},
    Keyword{"end", ""},
    Keyword{"con", ""},
};

std::string_view without_comment(std::string_view line) {
    return line.substr(0, line.find('#'));
}

// Whether the line continues in the next one; removes the mark of continuation and blanks after it. The comment has
// been removed, so comments do not continue.
bool take_continuation(std::string_view& line) {
    const std::size_t last = line.find_last_not_of(" \t");
    if (last == std::string_view::npos || line[last] != '\\') return false;
    line.remove_suffix(line.size() - last);
    return true;
}

class LineCheck {
public:
    LineCheck(const std::filesystem::path& name, MeshFile& file) : name_(name), file_(file) {}

    void check(std::string_view line, std::size_t number) {
        number_ = number;
        const std::string_view keyword = next_word(line);
        if (keyword.empty()) return;
        if (keyword == "v") {
            numbers(keyword, line, 3);
            count(vertices_, "vertices");
        } else if (keyword == "vt") {
            numbers(keyword, line, 1);
            count(uvs_, "texture coordinates");
        } else if (keyword == "f") {
            corners(line);
        } else {
            pass(keyword);
        }
    }

    // Those checked so far.
    ObjLines& lines() { return result_; }

    void finish() const {
        if (vertices_ == 0 && unknown_ > 0)
            throw Error(ErrorCode::bad_input, name_.string(),
                        fmt::format("not a Wavefront OBJ file: no line begins with v, and {} with words that OBJ does "
                                    "not know",
                                    unknown_));
        vertex_.check(vertices_, "vertex", *this);
        uv_.check(uvs_, "texture coordinate", *this);
    }

private:
    // The highest index that a face names, and the line of that face.
    struct Highest {
        std::int64_t index = 0;
        std::size_t line = 0;

        void see(std::int64_t named, std::size_t at) {
            if (named <= index) return;
            index = named;
            line = at;
        }
        void check(std::int64_t count, const char* what, const LineCheck& lines) const {
            if (index > count)
                lines.fail_at(line, fmt::format("a face names {} {}, but there are {}", what, index, count));
        }
    };

    [[noreturn]] void fail(const std::string& message) const { fail_at(number_, message); }

    [[noreturn]] void fail_at(std::size_t line, const std::string& message) const {
        throw Error(ErrorCode::bad_input, fmt::format("{}:{}", name_.string(), line), message);
    }

    void count(std::int64_t& one_more, const char* what) const {
        if (static_cast<std::uint64_t>(++one_more) > max_mesh_elements)
            fail(fmt::format("over {} {}", max_mesh_elements, what));
    }

    void pass(std::string_view keyword) {
        const auto known =
            std::find_if(keywords.begin(), keywords.end(), [&](const Keyword& each) { return each.word == keyword; });
        if (known != keywords.end()) {
            if (!known->lost.empty()) pass_over(file_, known->lost);
            return;
        }
        if (!is_word(keyword))
            fail(fmt::format("\"{}\" is not a keyword: the file is damaged, or not a Wavefront OBJ file",
                             keyword.substr(0, 40)));
        ++unknown_;
        pass_over(file_, fmt::format("lines of the unknown keyword \"{}\"", keyword));
    }

    void numbers(std::string_view keyword, std::string_view line, int least) {
        result_.kept += keyword;
        int count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
            if (!coordinate(word))
                fail(fmt::format("\"{}\" is not a finite number below {}", word.substr(0, 40), max_coordinate));
            result_.kept.append(1, ' ').append(word);
        }
        if (count < least) fail(fmt::format("the line has {} numbers; it needs {}", count, least));
        result_.kept += '\n';
    }

    void corners(std::string_view line) {
        const std::size_t before = result_.kept.size();
        const std::pair highest{vertex_, uv_};
        result_.kept += 'f';
        int count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) corner(word);
        result_.kept += '\n';
        if (count >= 3) {
            result_.line_of_face.push_back(number_);
            return;
        }
        result_.kept.resize(before);
        std::tie(vertex_, uv_) = highest;
        pass_over(file_, fewer_corners);
    }

    void corner(std::string_view word) {
        std::int64_t vertex = 0, uv = 0;
        const char* const last = word.data() + word.size();
        std::from_chars_result read = std::from_chars(word.data(), last, vertex);
        const bool has_uv = read.ec == std::errc() && last - read.ptr > 1 && read.ptr[0] == '/' && read.ptr[1] != '/';
        if (has_uv) read = std::from_chars(read.ptr + 1, last, uv);
        // The index of a normal may follow.
        if (read.ec != std::errc() || (read.ptr != last && *read.ptr != '/') ||
            word.find_first_not_of("0123456789-/") != std::string_view::npos)
            fail(fmt::format("\"{}\" is not a corner of a face", word.substr(0, 40)));
        // Negative numbers count back from the last one so far.
        check_back(vertex, vertices_, "vertex");
        if (has_uv) check_back(uv, uvs_, "texture coordinate");
        result_.kept += has_uv ? fmt::format(" {}/{}", vertex, uv) : fmt::format(" {}", vertex);
        vertex_.see(vertex, number_);
        uv_.see(uv, number_);
    }

    void check_back(std::int64_t index, std::int64_t count, const char* what) const {
        if (index == 0 || index < -count)
            fail(fmt::format("a face names {} {}, but there are {} so far", what, index, count));
    }

    const std::filesystem::path& name_;
    MeshFile& file_;
    ObjLines result_;
    std::size_t number_ = 0;
    std::int64_t vertices_ = 0, uvs_ = 0;
    Highest vertex_, uv_;
    std::uint64_t unknown_ = 0;
};

}  // namespace

void check_obj(const std::string& text, const std::filesystem::path& name, MeshFile& file,
               const std::function<void(ObjLines& lines)>& take) {
    constexpr std::size_t enough = 1 << 20;
    LineCheck check(name, file);
    const auto pass_on = [&] {
        take(check.lines());
        check.lines() = {};
    };
    std::string joined;
    std::size_t number = 0, first = 0;
    for (std::string_view left = text; !left.empty();) {
        std::string_view line = without_comment(next_line(left));
        ++number;
        if (joined.empty()) first = number;
        const bool goes_on = take_continuation(line);
        if (goes_on || !joined.empty()) joined.append(line).append(1, ' ');
        if (goes_on && !left.empty()) continue;
        check.check(joined.empty() ? line : std::string_view(joined), first);
        joined.clear();
        if (check.lines().kept.size() >= enough) pass_on();
    }
    pass_on();
    check.finish();
}

}  // namespace shadowbench::scene
