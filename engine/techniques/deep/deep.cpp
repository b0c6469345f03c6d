#include "techniques/deep/deep.h"

#include <cmath>

#include "curves/compress.h"
#include "techniques/deep/deep_map.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"tolerance",
     ParameterKind::number_or_word,
     "largest error of a stored function; \"noise\" is 0.25 / sqrt(samples a pixel), half of the rays' worst expected "
     "noise",
     0,
     0,
     1,
     "noise",
     {"noise"}},
    {"kernel",
     ParameterKind::choice,
     "how a lookup weighs the pixels of its footprint",
     0,
     0,
     0,
     "box",
     {"box", "tent"}},
};

double tolerance_of(const ParameterValues& values, int samples) {
    return values.is_word("tolerance") ? 0.25 / std::sqrt(static_cast<double>(samples)) : values.number("tolerance");
}

class Deep final : public Map {
public:
    explicit Deep(const ParameterValues& values) : values_(values) { map_.tent = values.word("kernel") == "tent"; }

    // A map of given functions, one pixel high.
    Deep(const ParameterValues& values, std::span<const curves::Curve> functions) : Deep(values) {
        const auto tolerance = static_cast<float>(tolerance_of(values, 1));
        map_.grid = {static_cast<int>(functions.size()), 1, 1.0f, 1.0f};
        DeepLevel& level = map_.levels[0];
        level.width = map_.grid.width;
        level.height = 1;
        level.offsets.assign(1, 0);
        curves::Curve kept;
        for (const curves::Curve& function : functions) {
            kept.resize(function.size());
            const std::size_t n = curves::compress(function, tolerance, kept.data());
            for (std::size_t i = 0; i < n; ++i) level.floats.push_back(kept[i].z);
            for (std::size_t i = 0; i < n; ++i) level.floats.push_back(kept[i].value);
            level.offsets.push_back(static_cast<std::uint32_t>(level.floats.size()));
        }
        level.floats.resize(level.floats.size() + DeepLevel::padding);
        level.floats.shrink_to_fit();
        level.offsets.shrink_to_fit();
        map_.peak_bytes = map_.bytes() + kept.capacity() * sizeof(curves::Vertex);
    }

    void begin(const BuildInput& input) override {
        map_.tolerance = static_cast<float>(tolerance_of(values_, input.layout.samples()));
        map_.begin(input.layout);
    }
    void add(const rays::LightRays& tile) override { map_.add(tile); }
    void finish() override { map_.finish(); }
    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        map_.lookup(queries, visibility);
    }
    void touched(const Query& query, std::vector<const void*>& lines) const override { map_.touched(query, lines); }
    std::size_t bytes() const override { return map_.bytes(); }
    std::size_t working_bytes() const override { return map_.peak_bytes; }
    NodeStats nodes() const override { return map_.stats(); }
    Cells cells() const override { return Cells::pixel; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        map_.stored(x, y, out);
    }

    std::span<const DeepLevel> levels() const { return map_.levels; }

private:
    ParameterValues values_;
    DeepMap map_;
};

}  // namespace

std::span<const DeepLevel> levels(const Map& map) {
    const auto* deep = dynamic_cast<const Deep*>(&map);
    return deep ? deep->levels() : std::span<const DeepLevel>();
}

Technique deep() {
    return {"deep",
            "deep shadow map: visibility functions compressed within a tolerance",
            "Lokovic, Veach 2000",
            1,
            {},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> { return std::make_unique<Deep>(values); },
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                const double tolerance = tolerance_of(values, layout.samples());
                return layout.media ? std::max(tolerance, linearisation_of(tolerance)) : tolerance;
            },
            [](const ParameterValues& values, std::span<const curves::Curve> functions) -> std::unique_ptr<Map> {
                return std::make_unique<Deep>(values, functions);
            },
            [](const ParameterValues&, const rays::MapLayout& layout) {
                return make_cells(layout, Cells::pixel).count() * sizeof(std::uint32_t);
            }};
}

}  // namespace shadowbench::techniques
