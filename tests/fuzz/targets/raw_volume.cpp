#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

// The first bytes give what a scenario states about the file: type and size.
void shadowbench::fuzz::raw_volume(std::string_view bytes) {
    constexpr const char* types[] = {"uint8", "float32", "float64"};
    const char* type = types[take<unsigned char>(bytes) % std::size(types)];
    scene::Vec3i size(0, 0, 0);
    for (int axis = 0; axis < 3; ++axis) size[axis] = take<std::int32_t>(bytes);
    const InputFile file(bytes, ".raw");
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_raw_volume(file.path(), size, type)); });
}
