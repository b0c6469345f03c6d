#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"
#include "scene/readers/kinds.h"
#include "scene/readers/point_files.h"

// As a mesh, and as a point cloud whose points have radii of their own or one that is given.
void shadowbench::fuzz::ply(std::string_view bytes) {
    const InputFile file(bytes, ".ply");
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_mesh(file.path()).mesh); });
    scene::is_point_cloud(file.path());
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_points(file.path(), 0.5f).points); });
    attempt({base::ErrorCode::bad_input}, [&] {
        const scene::PointFile points = scene::read_points(file.path(), 0.0f);
        if (points.has_radii) expect_sound(points.points);
    });
}
