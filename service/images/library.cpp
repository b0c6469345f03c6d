// The shared library: its functions are the engine's own.
#include "render/colour_map.h"
#include "render/deep_exr.h"
#include "render/image_file.h"
#include "service/images/images.h"

extern "C" [[gnu::visibility("default")]] const shadowbench::service::Images* shadowbench_images() {
    namespace render = shadowbench::render;
    namespace scene = shadowbench::scene;
    static const shadowbench::service::Images images{shadowbench::results::this_program(),
                                                     scene::is_deep_image,
                                                     scene::read_deep_image,
                                                     scene::read_alpha,
                                                     scene::read_alpha_channel,
                                                     render::encode_exr,
                                                     render::encode_png,
                                                     render::colour_map,
                                                     render::write_deep_exr};
    return &images;
}
