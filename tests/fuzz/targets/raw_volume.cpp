#include <cstdint>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/grid_files.h"

// The first bytes give what a scenario states about the file: packing, byte order and type, skip and size.
void shadowbench::fuzz::raw_volume(std::string_view bytes) {
    constexpr unsigned char packed = 0x80, big = 0x40, types = 9;
    const auto first = take<unsigned char>(bytes);
    scene::RawFormat format;
    format.type = static_cast<scene::ValueType>((first & 0x0f) % types);
    format.order = first & big ? scene::ByteOrder::big : scene::ByteOrder::little;
    format.skip = take<unsigned char>(bytes);
    for (int axis = 0; axis < 3; ++axis) format.size[axis] = take<std::int32_t>(bytes);
    const InputFile file(bytes, first & packed ? ".gz" : ".raw");
    attempt({base::ErrorCode::bad_input},
            [&] { expect_sound(scene::read_raw_values(file.path(), format, scene::Negative::clamp)); });
}
