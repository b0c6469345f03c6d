#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::deep_image(std::string_view bytes) {
    const InputFile file(bytes, ".exr");
    const auto read = [&](const scene::DeepChoice& choice) {
        attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_deep_image(file.path(), choice)); });
    };
    read({});
    read({"rgba", 0});
}
