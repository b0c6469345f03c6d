#include "claims/volume_map.h"

#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "claims/first_light.h"
#include "claims/volume.h"
#include "render/image_file.h"

namespace shadowbench::claims::volume {

const scene::Object& volume_of(const scene::Scenario& scenario) {
    for (const scene::Object& object : scenario.scene.objects)
        if (std::holds_alternative<scene::GridVolume>(object.shape)) return object;
    throw base::Error(base::ErrorCode::internal, scenario.name, "the scene has no grid volume");
}

void with_map(const Context& context, const char* name, int resolution,
              const std::function<void(const VolumeMap&)>& use) {
    const nlohmann::json document = context.document(
        name, {fmt::format("rays.resolution={}", resolution),
               fmt::format(R"(techniques=[{{"type":"volume_deep","cells":"sample","filter":"point","steps":{}}}])",
                           map_steps)});
    note_document(context, name, document);
    const FirstLight first(document, context.data);
    const bench::Maps maps = first.build(first.contenders.front(), first.tiles());
    const scene::Object& object = volume_of(first.scenario);
    use({first.scenario, object, std::get<scene::GridVolume>(object.shape), first.light.view, maps});
}

Sheet sheet_of(const std::string& name, const std::string& caption, std::span<const render::Image> pictures,
               int columns) {
    constexpr int gap = 4;
    const base::Vec2i size(pictures[0].width, pictures[0].height);
    const int count = static_cast<int>(pictures.size()), rows = (count + columns - 1) / columns;
    render::Image sheet({columns * (size.x + gap) - gap, rows * (size.y + gap) - gap}, base::Vec3f(1.0f));
    for (int i = 0; i < count; ++i)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                sheet.at(i % columns * (size.x + gap) + x, i / columns * (size.y + gap) + y) =
                    pictures[static_cast<std::size_t>(i)].at(x, y);
    return {name, caption, render::encode_png(sheet)};
}

}  // namespace shadowbench::claims::volume
