// Capture: all light rays of a map, tile after tile; the scene is prepared before.
#include <memory>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/agreement.h"
#include "kernels/inputs.h"
#include "kernels/kernel.h"
#include "rays/capture.h"
#include "rays/tracer.h"

namespace shadowbench::kernels {
namespace {

constexpr std::size_t traced_rays = 2000;

Subject prepare(Kind kind, int map, int samples) {
    const SharedInput input = make_input(kind, map, samples);
    const auto capture = std::make_shared<rays::Capture>(input->scene, input->view, input->layout);
    const rays::Tracer tracer(input->scene, true);
    const results::Agreement agreement =
        bench::compare_with_tracer(*capture, input->layout, input->view, tracer, traced_rays);
    check(results::agrees(agreement),
          fmt::format("of {} rays {} differ from Embree's in crossings, {} in transmittance", agreement.rays,
                      agreement.other_crossings, agreement.other_transmittance));

    const auto tiles = std::make_shared<std::vector<rays::LightRays>>(capture_all(*input));
    Subject subject;
    subject.exact.nodes = static_cast<double>(segments_of(*tiles));
    std::size_t bytes = 0;
    for (const rays::LightRays& tile : *tiles) bytes += tile.bytes();
    subject.exact.bytes = static_cast<double>(bytes);
    subject.vertices = *subject.exact.nodes;
    subject.pass = [input, capture] {
        for (int t = 0; t < input->layout.tiles(); ++t) benchmark::DoNotOptimize(capture->tile(t).begin.data());
    };
    // The floor reads the rays of the output; each primitive of the scene is read only once for all rays it covers.
    std::vector<const void*> lines;
    append_lines(*tiles, lines);
    subject.floor = [tiles, read = floor_of(std::move(lines))] { return read(); };
    return subject;
}

void add(Kernels& kernels, Kind kind, int map, int samples) {
    kernels.push_back({fmt::format("capture/{}/map:{}/samples:{}", name_of(kind), map, samples),
                       [=] { return prepare(kind, map, samples); }});
}

}  // namespace

void add_capture_kernels(Kernels& kernels) {
    for (const Kind kind : {Kind::hair, Kind::mesh, Kind::smoke, Kind::cloud}) {
        add(kernels, kind, 32, 16);
        add(kernels, kind, 64, 9);
        add(kernels, kind, 64, 16);
    }
}

}  // namespace shadowbench::kernels
