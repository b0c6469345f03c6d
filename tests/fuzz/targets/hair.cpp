#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/load.h"
#include "scene/readers/files.h"

void shadowbench::fuzz::hair(std::string_view bytes) {
    const InputFile file(bytes, ".hair");
    for (const float radius : {0.0f, 0.01f})
        attempt({base::ErrorCode::bad_input}, [&] {
            scene::Hair hair = scene::read_hair(file.path(), radius);
            expect_sound(hair);
            scene::merge_equal_points(hair);
            expect_sound(hair);
        });
}
