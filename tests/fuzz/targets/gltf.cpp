#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

// Text and binary files are told apart by their content. A buffer may name a file that is not there.
void shadowbench::fuzz::gltf(std::string_view bytes) {
    const InputFile file(bytes, ".gltf");
    attempt({base::ErrorCode::bad_input, base::ErrorCode::no_such_file},
            [&] { expect_sound(scene::read_mesh(file.path()).mesh); });
}
