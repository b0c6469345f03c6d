#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/pbrt_files.h"

// A buffer may include itself, as its file is called input.pbrt, and files that are not there.
void shadowbench::fuzz::pbrt(std::string_view bytes) {
    const InputFile file(bytes, ".pbrt");
    scene::PbrtLimits limits;
    limits.elements = limits.voxels = 100'000;
    limits.files = 1000;
    attempt({base::ErrorCode::bad_input, base::ErrorCode::no_such_file}, [&] {
        const scene::PbrtFile scene = scene::read_pbrt(file.path(), limits);
        expect_sound(scene.mesh);
        expect_sound(scene.hair);
        expect_sound(scene.particles);
        for (const scene::PbrtMedium& medium : scene.media) expect_sound(medium.volume);
    });
}
