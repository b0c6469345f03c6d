#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/grid_files.h"

// A header may name another file for the values, which is not there.
void shadowbench::fuzz::nrrd(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 22;
    const InputFile file(bytes, ".nrrd");
    for (const scene::Negative negative : {scene::Negative::clamp, scene::Negative::refuse})
        attempt({base::ErrorCode::bad_input, base::ErrorCode::no_such_file}, [&] {
            scene::GridVolume volume = scene::read_nrrd(file.path(), negative, most_voxels).volume;
            expect_sound(volume);
            volume.step = 1.0;
            expect_box(volume);
        });
}
