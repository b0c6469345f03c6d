#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/files.h"

void shadowbench::fuzz::vdb(std::string_view bytes) {
    constexpr std::uint64_t most_voxels = 1 << 22;
    const InputFile file(bytes, ".vdb");
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_vdb(file.path(), "density", most_voxels)); });
}
