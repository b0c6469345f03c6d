#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::pvm(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 22;
    const InputFile file(bytes, ".pvm");
    attempt({base::ErrorCode::bad_input}, [&] {
        const scene::GridVolume volume = scene::read_pvm(file.path(), most_voxels);
        expect_sound(volume);
        expect_in(volume.density, 0.0f, 1.0f, "densities are in [0, 1]");
    });
}
