// Scenes in pbrt's text format: pbrt.org/fileformat-v4, and what version 3 has in common with it.
#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"
#include "base/utf8.h"
#include "scene/beside.h"
#include "scene/readers/extension.h"
#include "scene/readers/pbrt_files.h"
#include "scene/readers/pbrt_media.h"
#include "scene/readers/pbrt_shapes.h"
#include "scene/readers/pbrt_state.h"
#include "scene/readers/read_mesh.h"
#include "scene/readers/unpacked_bytes.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using Statement = PbrtStatement;

constexpr int most_nested_files = 32;
constexpr std::size_t most_media = 1000;
constexpr std::size_t longest_name = 256;  // of a medium, which is that of a grid in a scenario

// The shapes of an object that instances repeat.
struct Repeated {
    Mesh mesh;
    Hair hair;
};

class SceneReader {
public:
    SceneReader(const fs::path& file, const PbrtLimits& limits) : scene_file_(file), limits_(limits) {}

    PbrtFile read() {
        if (const std::optional<Statement> last = run(scene_file_)) act(*last);
        if (object_)
            throw Error(ErrorCode::bad_input, scene_file_.string(),
                        fmt::format("the file ends inside the object \"{}\": ObjectEnd is missing",
                                    object_name_.substr(0, 40)));
        file_.mesh = std::move(shapes_.mesh);
        file_.hair = std::move(shapes_.strands).finish();
        for (PbrtMediumSource& medium : media_) take_medium(medium);
        if (state_.late_transforms() > 0) pass("transforms when the shutter closes", state_.late_transforms());
        file_.passed_over = std::move(passed_over_.passed_over);
        return std::move(file_);
    }

private:
    struct Shapes {
        Mesh mesh;
        Strands strands;
    };

    void pass(std::string_view what, std::uint64_t count = 1) { pass_over(passed_over_, what, count); }

    // --- files ---

    std::string content(const fs::path& name) {
        count_file(name);
        return extension_of(name) == ".gz" ? unpacked_file(name) : base::read_text(name);
    }

    // A file that is not there is left to its reader.
    void count_file(const fs::path& name) {
        std::error_code fault;
        const std::uint64_t bytes = extension_of(name) == ".gz" ? gzip_bytes(name) : fs::file_size(name, fault);
        if (!fault) bytes_ += bytes;
        if (++files_ > limits_.files || bytes_ > limits_.bytes)
            throw Error(ErrorCode::bad_input, name.string(),
                        fmt::format("the scene reads over {} files or {} bytes, of all files together", limits_.files,
                                    limits_.bytes));
        if (!fault && !known_files_.insert(fs::canonical(name, fault)).second && (repeats_ += bytes) > limits_.repeats)
            throw Error(ErrorCode::bad_input, name.string(),
                        fmt::format("the scene reads over {} bytes again, of files that it has read before: repeat "
                                    "shapes by ObjectInstance",
                                    limits_.repeats));
    }

    fs::path find(const Statement& s, const std::string& name) const {
        const Beside beside = find_beside(scene_file_, name);
        if (beside.state == Beside::State::found) return beside.file;
        const bool missing = beside.state == Beside::State::missing;
        throw Error(missing ? ErrorCode::no_such_file : ErrorCode::bad_input, fmt::format("{}:{}", *s.file, s.line),
                    fmt::format("{} \"{}\"; what a pbrt scene names must lie in its own folder",
                                missing ? "there is no file" : "the name leads out of the folder:", name));
    }

    // Returns the last statement of a file without acting on it if its parameters may go on where the file is included,
    // as they do in public scenes.
    std::optional<Statement> run(const fs::path& name) {
        const std::string text = content(name);
        PbrtStatements statements(names_.emplace_back(name.string()), text);
        PbrtStatements* const before = std::exchange(reading_, &statements);
        std::optional<Statement> last;
        ++nested_;
        for (Statement statement; statements.next(statement);) {
            if (statement.takes_parameters && statements.at_end())
                last = std::move(statement);
            else
                act(statement);
        }
        --nested_;
        reading_ = before;
        return last;
    }

    void include(const Statement& s) {
        if (nested_ >= most_nested_files)
            s.fail(fmt::format("files include each other over {} deep, perhaps in a circle", most_nested_files));
        std::optional<Statement> last = run(find(s, s.texts[0]));
        if (!last) return;
        reading_->take_parameters(*last);
        act(*last);
    }

    // What an imported file sets ends with it.
    void import_file(const Statement& s) {
        const PbrtAttributes before = state_.now;
        include(s);
        state_.now = before;
    }

    // --- media ---

    PbrtMediumSource* medium(const std::string& name) {
        const auto known =
            std::find_if(media_.begin(), media_.end(), [&](const PbrtMediumSource& each) { return each.name == name; });
        return known == media_.end() ? nullptr : &*known;
    }

    void make_medium(const Statement& s) {
        if (s.texts[0].empty() || s.texts[0].size() > longest_name || !base::is_utf8(s.texts[0]))
            s.fail(fmt::format("a medium's name has 1 to {} bytes of UTF-8", longest_name));
        if (media_.size() >= most_media) s.fail(fmt::format("over {} media", most_media));
        if (medium(s.texts[0])) s.fail(fmt::format("a second medium \"{}\"", s.texts[0].substr(0, 40)));
        PbrtMediumSource made = read_pbrt_medium_source(s, state_.now.place, limits_.voxels - voxels_);
        if (made.grid) voxels_ += made.grid->density.size();
        media_.push_back(std::move(made));
    }

    void medium_interface(const Statement& s) {
        // Each saved state holds the name.
        if (s.texts[0].size() > longest_name) s.fail(fmt::format("a medium's name of over {} bytes", longest_name));
        state_.now.inside = s.texts[0];
        if (s.texts.size() > 1 && !s.texts[1].empty()) pass("media outside of shapes");
    }

    // What the shape has inside. `box`: it is a box; `sphere`: it is a sphere.
    void fill(const Statement& s, const std::optional<Box3d>& box, bool sphere) {
        if (state_.now.inside.empty()) return;
        PbrtMediumSource* const inside = medium(state_.now.inside);
        if (!inside) s.fail(fmt::format("there is no medium \"{}\"", state_.now.inside.substr(0, 40)));
        if (object_) return pass("media in objects of instances");
        if (!inside->lost.empty() || inside->grid) {
            inside->used = true;
            return;
        }
        if (!box && !sphere) return pass("homogeneous media in shapes other than spheres and boxes");
        inside->used = true;
        const auto density = static_cast<float>(inside->mean());
        if (sphere) {
            const double radius = s.number("radius", 1.0) * mean_scale(state_.now.place);
            const Vec3d centre = transform_point(state_.now.place, Vec3d(0, 0, 0));
            const double reach = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z), radius});
            if (!(radius >= min_length) || !(reach <= max_coordinate)) s.fail("the sphere is too small or too large");
            if (file_.particles.centres.size() >= limits_.elements)
                s.fail(fmt::format("over {} spheres of media", limits_.elements));
            file_.particles.centres.emplace_back(centre);
            file_.particles.radii.push_back(static_cast<float>(radius));
            file_.particles.density.push_back(density);
            return;
        }
        GridVolume volume;
        volume.size = Vec3i(1, 1, 1);
        volume.density = {density};
        volume.lower = box->min;
        volume.upper = box->max;
        if (file_.media.size() >= most_media) s.fail(fmt::format("over {} boxes of media", most_media));
        file_.media.push_back({inside->name, std::move(volume)});
    }

    void take_medium(PbrtMediumSource& medium) {
        if (!medium.lost.empty()) return pass(medium.lost);
        if (!medium.used) return pass("media that no shape has inside");
        if (medium.is_coloured())
            file_.facts.push_back(fmt::format("medium \"{}\": extinction [{:.6g}, {:.6g}, {:.6g}]; its mean is taken",
                                              medium.name, medium.extinction.x, medium.extinction.y,
                                              medium.extinction.z));
        if (medium.grid) file_.media.push_back({medium.name, std::move(*medium.grid)});
    }

    // --- shapes ---

    Shapes& shapes() { return object_ ? object_shapes_ : shapes_; }

    void check_elements(const Statement& s, std::uint64_t vertices, std::uint64_t triangles, std::uint64_t points) {
        const Shapes& to = shapes();
        const std::uint64_t most = limits_.elements;
        if (vertices + to.mesh.positions.size() > most || triangles + to.mesh.triangles.size() > most ||
            points + to.strands.points() > most)
            s.fail(fmt::format("over {} vertices, triangles or points of hair", most));
    }

    void add_triangles(const Statement& s, const Mesh& mesh) {
        Mesh placed;  // if it may be a box
        if (!state_.now.inside.empty() && mesh.triangles.size() == box_triangles)
            add_placed(mesh, state_.now.place, s, placed);
        fill(s, box_of(placed), false);
        if (!state_.now.is_surface) return;
        check_elements(s, mesh.positions.size(), mesh.triangles.size(), 0);
        add_placed(mesh, state_.now.place, s, shapes().mesh);
    }

    void add_ply(const Statement& s) {
        const fs::path name = find(s, s.text("filename", ""));
        count_file(name);
        const MeshFile ply = read_ply(name);
        for (const PassedOver& each : ply.passed_over) pass(each.what, each.count);
        if (s.find("displacement")) pass("displacements");
        add_triangles(s, ply.mesh);
    }

    void add_sphere(const Statement& s) {
        const double radius = s.number("radius", 1.0);
        const bool whole = s.number("zmin", -radius) <= -radius && s.number("zmax", radius) >= radius &&
                           s.number("phimax", 360.0) >= 360.0 && radius > 0.0;
        fill(s, std::nullopt, whole && is_uniform(state_.now.place));
        if (state_.now.is_surface) pass("shapes of the type sphere");
    }

    void shape(const Statement& s) {
        const std::string& type = s.texts[0];
        const PbrtParameter* const alpha = s.find("alpha");
        if (alpha && alpha->numbers.size() == 1 && alpha->numbers[0] == 0.0) return pass("shapes of alpha 0");
        if (alpha) pass("values of alpha");
        if (type == "trianglemesh") return add_triangles(s, pbrt_triangles(s));
        if (type == "plymesh") return add_ply(s);
        if (type == "sphere") return add_sphere(s);
        fill(s, std::nullopt, false);
        if (!state_.now.is_surface) return;
        if (type != "curve")
            return pass(is_word(type) ? fmt::format("shapes of the type {}", type) : "shapes of another type");
        if (s.text("type", "flat") == "ribbon") pass("directions of ribbons");
        add_pbrt_curve(s, state_.now.place, limits_.elements, shapes().strands);
    }

    void object_begin(const Statement& s) {
        if (object_) s.fail("an object inside an object");
        state_.save(s);
        object_ = true;
        object_name_ = s.texts[0];
        object_shapes_ = {};
    }

    void object_end(const Statement& s) {
        state_.restore(s);
        object_ = false;
        Repeated made{std::move(object_shapes_.mesh), std::move(object_shapes_.strands).finish()};
        repeated_ += made.mesh.positions.size() + made.mesh.triangles.size() + made.hair.points.size();
        const std::uint64_t most = 3 * limits_.elements;
        if (repeated_ > most)
            s.fail(fmt::format("over {} vertices, triangles and points of hair in all objects", most));
        if (!objects_.emplace(object_name_, std::move(made)).second)
            s.fail(fmt::format("a second object \"{}\"", object_name_.substr(0, 40)));
    }

    void instance(const Statement& s) {
        if (object_) s.fail("an instance inside an object");
        const auto known = objects_.find(s.texts[0]);
        if (known == objects_.end()) s.fail(fmt::format("there is no object \"{}\"", s.texts[0].substr(0, 40)));
        const Repeated& from = known->second;
        check_elements(s, from.mesh.positions.size(), from.mesh.triangles.size(), from.hair.points.size());
        add_placed(from.mesh, state_.now.place, s, shapes_.mesh);
        add_placed(from.hair, state_.now.place, s, shapes_.strands);
    }

    void attribute(const Statement& s) {
        if (s.texts[0] == "shape") pass("attributes of shapes");
    }

    void act(const Statement& s);

    const fs::path& scene_file_;
    const PbrtLimits limits_;
    std::uint64_t bytes_ = 0, files_ = 0, voxels_ = 0, repeats_ = 0;
    std::set<fs::path> known_files_;
    std::uint64_t repeated_ = 0;  // elements of all objects
    int nested_ = 0;
    PbrtStatements* reading_ = nullptr;  // the innermost file
    std::deque<std::string> names_;      // of all files, for messages

    PbrtState state_;
    std::vector<PbrtMediumSource> media_;

    Shapes shapes_, object_shapes_;
    bool object_ = false;  // whether shapes belong to an object
    std::string object_name_;
    std::map<std::string, Repeated> objects_;

    MeshFile passed_over_;  // for pass_over()
    PbrtFile file_;
};

// Statements that are not here say nothing of shapes: lights, settings.
void SceneReader::act(const Statement& s) {
    struct Row {
        std::string_view word;
        void (SceneReader::*act)(const Statement& s);
    };
    static constexpr std::array rows{Row{"Shape", &SceneReader::shape},
                                     Row{"Attribute", &SceneReader::attribute},
                                     Row{"Import", &SceneReader::import_file},
                                     Row{"Include", &SceneReader::include},
                                     Row{"MakeNamedMedium", &SceneReader::make_medium},
                                     Row{"MediumInterface", &SceneReader::medium_interface},
                                     Row{"ObjectBegin", &SceneReader::object_begin},
                                     Row{"ObjectEnd", &SceneReader::object_end},
                                     Row{"ObjectInstance", &SceneReader::instance}};
    if (state_.take(s)) return;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& each) { return each.word == s.word; });
    if (row != rows.end()) (this->*row->act)(s);
}

}  // namespace

PbrtFile read_pbrt(const fs::path& file, const PbrtLimits& limits) {
    return SceneReader(file, limits).read();
}

}  // namespace shadowbench::scene
