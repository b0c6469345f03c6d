#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/grid_files.h"

void shadowbench::fuzz::mitsuba_volume(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 22;
    const InputFile file(bytes, ".vol");
    for (const scene::Negative negative : {scene::Negative::clamp, scene::Negative::refuse})
        attempt({base::ErrorCode::bad_input}, [&] {
            scene::GridVolume volume = scene::read_mitsuba_volume(file.path(), negative, most_voxels).volume;
            expect_sound(volume);
            volume.step = 1.0;
            expect_box(volume);
        });
}
