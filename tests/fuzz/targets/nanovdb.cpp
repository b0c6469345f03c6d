#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::nanovdb(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 20;
    const InputFile file(bytes, ".nvdb");
    const auto read = [&](const scene::GridChoice& grid, scene::Negative negative) {
        attempt({base::ErrorCode::bad_input},
                [&] { expect_sound(scene::read_nanovdb(file.path(), grid, negative, most_voxels)); });
    };
    read({}, scene::Negative::clamp);
    read(1, scene::Negative::refuse);
}
