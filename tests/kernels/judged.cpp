#include "kernels/judged.h"

#include <array>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/random.h"
#include "bench/contender.h"
#include "bench/memory.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
#include "kernels/inputs.h"
#include "rays/capture.h"
#include "rays/tracer.h"

namespace shadowbench::kernels {
namespace {

constexpr std::size_t judged_side = 24;  // side of the grid of queries that are compared with the truth
constexpr int truth_samples = 64;

scene::TechniqueRequest request_of(const Setting& setting) {
    scene::TechniqueRequest request;
    request.type = setting.row->id;
    request.parameters =
        setting.parameter.empty() ? "{}" : fmt::format("{{\"{}\": {}}}", setting.parameter, *setting.value);
    return request;
}

}  // namespace

// The scene as one light sees it, and the light rays that a contender is built from.
struct Judged::State {
    SharedInput input;
    rays::MapLayout layout;
    rays::Tracer tracer;
    std::vector<rays::LightRays> tiles;
    std::array<bench::Contender, 1> contender;
    Exact exact;

    explicit State(const Setting& setting)
        : input(make_input(Kind::mixed, setting.map, setting.samples)),
          layout(input->layout),
          tracer(input->scene, true),
          contender{bench::make_contender(request_of(setting), "")} {
        bench::ask_for_needs(contender, layout);
    }
    techniques::BuildInput build_input() const { return {layout, input->view, &tracer}; }
    const results::Cell& cell() const { return contender[0].cell; }
    void check_ok() const { check(contender[0].ok(), cell().reason); }
};

Judged::Judged(const Setting& setting) : state_(std::make_unique<State>(setting)) {
    State& s = *state_;
    const rays::Capture capture(s.input->scene, s.input->view, s.layout);
    const bench::RaySource source(capture, s.layout, std::numeric_limits<std::size_t>::max(), {});
    const int apron = s.contender[0].needs.apron;
    source.for_each_batch(apron, [&](bench::RaySource::Batch batch) { s.tiles.assign(batch.begin(), batch.end()); });

    bench::build_all(s.contender, source, s.build_input(), bench::MemoryLimits{}.all, {});
    bench::check_functions(s.contender, source, s.layout, {});
    s.check_ok();
    scene::RaySettings settings = s.input->settings;
    settings.samples_per_pixel = truth_samples;
    settings.seed = 2;
    const std::vector<techniques::Query> judged = queries(judged_side, 5);
    bench::check_lookups(s.contender, judged,
                         bench::reference_visibility(s.input->scene, s.input->view, settings, judged, {}));
    s.check_ok();

    s.exact.bytes = static_cast<double>(s.cell().bytes);
    s.exact.nodes = static_cast<double>(s.cell().nodes.total);
    if (!s.cell().curve) return;  // shadow rays: Embree's answers, which differ between processors
    s.exact.error = s.cell().curve->norms.max;
    s.exact.lookup_error = s.cell().lookup->norms.rms;
}

Judged::~Judged() = default;

const Exact& Judged::exact() const {
    return state_->exact;
}

const bench::Maps& Judged::maps() const {
    return state_->contender[0].maps;
}

const std::vector<rays::LightRays>& Judged::tiles() const {
    return state_->tiles;
}

bench::Maps Judged::build() const {
    const bench::Contender& contender = state_->contender[0];
    bench::Maps maps = bench::begin_maps(*contender.row, contender.values, state_->build_input());
    for (const rays::LightRays& tile : state_->tiles) bench::add(maps, tile);
    bench::finish(maps);
    return maps;
}

std::vector<techniques::Query> Judged::queries(std::size_t side, std::uint64_t seed) const {
    const rays::MapLayout& layout = state_->layout;
    const double depth = 1.1 * (layout.z_max - layout.z_min);  // also a little behind everything
    base::Random random(seed);
    const auto place = [&](std::size_t cell, int size) {
        return static_cast<float>((static_cast<double>(cell) + random.uniform()) * size / static_cast<double>(side));
    };
    std::vector<techniques::Query> queries;
    for (std::size_t row = 0; row < side; ++row)
        for (std::size_t column = 0; column < side; ++column) {
            const float x = place(column, layout.width), y = place(row, layout.height);
            queries.push_back({x, y, static_cast<float>(layout.z_min + depth * random.uniform()), 1.0f});
        }
    return queries;
}

void Judged::check_answers(const std::vector<techniques::Query>& queries, const std::function<void()>& pass,
                           const std::vector<float>& answers) const {
    pass();
    const std::vector<float> first = answers;
    pass();
    check(first == answers, "two passes over the same lookups give different answers");
    bench::Contender answering;
    answering.promises = state_->contender[0].promises;
    bench::check_answers(answering, queries, answers);
    check(answering.ok(), answering.cell.reason);
}

std::string name_of(const Setting& setting) {
    std::string name = setting.row->id;
    if (!setting.parameter.empty()) name += argument(setting.parameter.c_str(), *setting.value);
    return name + argument("map", setting.map) + argument("samples", setting.samples);
}

SharedJudged judge(const Setting& setting) {
    static std::pair<std::string, SharedJudged> last;
    const std::string name = name_of(setting);
    if (last.first != name || !last.second) {
        last = {name, nullptr};
        last.second = std::make_shared<const Judged>(setting);
    }
    return last.second;
}

}  // namespace shadowbench::kernels
