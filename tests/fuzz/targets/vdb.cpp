#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::vdb(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 22;
    const InputFile file(bytes, ".vdb");
    const auto read = [&](const scene::GridChoice& grid, scene::Negative negative) {
        attempt({base::ErrorCode::bad_input},
                [&] { expect_sound(scene::read_vdb(file.path(), grid, negative, most_voxels)); });
    };
    read({}, scene::Negative::clamp);
    read(1, scene::Negative::refuse);
}
