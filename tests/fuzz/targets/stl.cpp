#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::stl(std::string_view bytes) {
    const InputFile file(bytes, ".stl");
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_mesh(file.path()).mesh); });
}
