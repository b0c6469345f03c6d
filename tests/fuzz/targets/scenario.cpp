#include "scene/scenario.h"
#include "document/document.h"

#include <nlohmann/json.hpp>

#include "bench/load.h"
#include "bench/run.h"
#include "fuzz/expect.h"
#include "fuzz/few_variants.h"
#include "fuzz/target.h"

namespace shadowbench::fuzz {
namespace {

using nlohmann::json;

// Whether the procedural objects of a valid document are small.
bool small_scene(const json& document) {
    constexpr double most = 1 << 18;
    double values = 0.0;
    for (const json& object : document["scene"].value("objects", json::array())) {
        const std::string type = object["type"].get<std::string>();
        if (type == "hair_ball")
            values += object.value("strands", 50000.0) * (object.value("segments", 16.0) + 1.0);
        else if (type == "smoke_column")
            values += object.value("particles", 2000.0);
        else if (type == "cloud" || type == "density_box" || type == "crossed_rods") {
            double voxels = 1.0;
            for (const json& side : object.value("size", json::array({64, 64, 64}))) voxels *= side.get<double>();
            values += voxels * (type == "cloud" ? 8.0 : 1.0);
        }
    }
    return values <= most;
}

}  // namespace

// Does what `validate` does. Only files that a scenario names by an absolute path exist.
void scenario(std::string_view bytes) {
    attempt({base::ErrorCode::bad_input, base::ErrorCode::no_such_file}, [&] {
        const nlohmann::json document = scene::parse_json(std::string(bytes), "scenario.json");
        if (!few_variants(document)) return;
        for (const document::Variant& variant : document::expand(document)) {
            if (!small_scene(*variant.document)) return;
            bench::ScenarioLoader loader({});
            expect_sound(loader.load(variant));
        }
        bench::RunOptions options;
        options.threads = 1;
        const bench::Validated validated = bench::validate(document, options);
        expect(validated.variants > 0 && validated.lights > 0 && validated.techniques > 0, "there is something to run");
    });
}

}  // namespace shadowbench::fuzz
