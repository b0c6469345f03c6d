#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

// The first byte selects the file name, whose extension need not fit the content.
void shadowbench::fuzz::alpha(std::string_view bytes) {
    constexpr const char* extensions[] = {".png", ".tga", ".dds", ".tif", ".exr", ".jpg", ".bmp", ".xyz"};
    const char* extension = extensions[take<unsigned char>(bytes) % std::size(extensions)];
    const InputFile file(bytes, extension);
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_alpha(file.path())); });
}
