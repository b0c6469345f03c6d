// The transforms and attributes that the statements of a pbrt scene set and save.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/pbrt_statement.h"
#include "scene/readers/pbrt_transforms.h"

namespace shadowbench::scene {

struct PbrtAttributes {
    Matrix place;
    std::string inside;      // the medium inside of shapes; empty: none
    bool is_surface = true;  // false: shapes only bound media
    bool at_begin = true;    // whether transforms hold when the shutter opens
};

class PbrtState {
public:
    PbrtAttributes now;

    // Takes a statement about transforms, materials or saved attributes; false for all others. A fault throws
    // Error{bad_input} at the statement.
    bool take(const PbrtStatement& statement);

    // For the statements with these words that end in Begin and End.
    void save(const PbrtStatement& statement);
    void restore(const PbrtStatement& statement);

    // Transforms that hold when the shutter closes only, which are passed over.
    std::uint64_t late_transforms() const { return late_transforms_; }

private:
    struct Saved {
        std::string_view by;  // the word without its end
        PbrtAttributes attributes;
    };

    void place(const PbrtStatement& statement, const Matrix& matrix);
    void multiply(const PbrtStatement& statement, const Matrix& by);
    void identity(const PbrtStatement& statement);
    void translate(const PbrtStatement& statement);
    void scale(const PbrtStatement& statement);
    void rotate(const PbrtStatement& statement);
    void look_at(const PbrtStatement& statement);
    void transform(const PbrtStatement& statement);
    void concat_transform(const PbrtStatement& statement);
    void active_transform(const PbrtStatement& statement);
    void coordinate_system(const PbrtStatement& statement);
    void use_system(const PbrtStatement& statement);
    void camera(const PbrtStatement& statement);
    void world(const PbrtStatement& statement);
    void material(const PbrtStatement& statement);
    void make_material(const PbrtStatement& statement);
    void named_material(const PbrtStatement& statement);

    std::vector<Saved> saved_;
    std::map<std::string, Matrix> systems_;
    std::set<std::string> boundaries_;  // named materials that are no surface
    std::uint64_t late_transforms_ = 0;
};

}  // namespace shadowbench::scene
