#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::tressfx(std::string_view bytes) {
    const InputFile file(bytes, ".tfx");
    attempt({base::ErrorCode::bad_input}, [&] { expect_sound(scene::read_tressfx(file.path(), 0.01f)); });
}
