#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/load.h"
#include "scene/readers/hair_files.h"

// Text and binary strands are told apart by their content.
void shadowbench::fuzz::mitsuba_hair(std::string_view bytes) {
    const InputFile file(bytes, ".txt");
    for (const auto basis : {scene::CurveBasis::linear, scene::CurveBasis::bspline})
        attempt({base::ErrorCode::bad_input}, [&] {
            scene::Hair hair = scene::read_mitsuba_hair(file.path(), 0.0f, basis).hair;
            expect_sound(hair);
            scene::merge_equal_points(hair);
            expect_sound(hair);
        });
    attempt({base::ErrorCode::bad_input}, [&] { scene::is_mitsuba_hair(file.path()); });
}
