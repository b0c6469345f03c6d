#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/grid_files.h"

void shadowbench::fuzz::slc(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 22;
    const InputFile file(bytes, ".slc");
    attempt({base::ErrorCode::bad_input}, [&] {
        scene::GridVolume volume = scene::read_slc(file.path(), most_voxels).volume;
        expect_sound(volume);
        expect_in(volume.density, 0.0f, 1.0f, "densities are in [0, 1]");
        volume.step = 1.0;
        expect_box(volume);
    });
}
