// Compression of given functions within a tolerance, one function after the other.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "curves/compress.h"
#include "curves/compress_published.h"
#include "curves/fewest.h"
#include "curves/norms.h"
#include "kernels/inputs.h"
#include "kernels/kernel.h"

namespace shadowbench::kernels {
namespace {

constexpr int map = 32, samples = 16;
constexpr double rounding = 1e-6;  // of stored floats

std::size_t compress_to_fewest(curves::CurveView curve, float tolerance, curves::Vertex* out) {
    thread_local curves::FewestScratch scratch;
    return curves::compress_to_fewest(curve, tolerance, scratch, out);
}

using Compress = std::size_t (*)(curves::CurveView curve, float tolerance, curves::Vertex* out);

struct Functions {
    std::vector<curves::Curve> functions;
    curves::Curve out;
};

Subject prepare(Kind kind, Compress compress, float tolerance) {
    const auto input = std::make_shared<Functions>();
    input->functions = functions_of(kind, map, samples);
    std::size_t longest = 0, before = 0, after = 0;
    for (const curves::Curve& function : input->functions) {
        longest = std::max(longest, function.size());
        before += function.size();
    }
    input->out.resize(longest);
    double error = 0.0;
    for (const curves::Curve& function : input->functions) {
        const std::size_t count = compress(function, tolerance, input->out.data());
        after += count;
        error = std::max(error, curves::distance({input->out.data(), count}, function, 0.0, 0.0).max);
    }
    check(error <= tolerance + rounding, fmt::format("a function differs from its input by {}", error));

    Subject subject;
    subject.exact = {static_cast<double>(after * sizeof(curves::Vertex)), static_cast<double>(after), error, {}};
    subject.vertices = static_cast<double>(before);
    subject.pass = [input, compress, tolerance] {
        for (const curves::Curve& function : input->functions)
            benchmark::DoNotOptimize(compress(function, tolerance, input->out.data()));
        benchmark::ClobberMemory();
    };
    std::vector<const void*> lines;
    for (const curves::Curve& function : input->functions) append_lines(function, lines);
    subject.floor = floor_of(std::move(lines));
    return subject;
}

void add(Kernels& kernels, const char* family, Kind kind, Compress compress, double tolerance) {
    kernels.push_back({fmt::format("{}/{}/tolerance:{}", family, name_of(kind), tolerance),
                       [=] { return prepare(kind, compress, static_cast<float>(tolerance)); }});
}

}  // namespace

void add_compression_kernels(Kernels& kernels) {
    for (const Kind kind : {Kind::smoke, Kind::hair, Kind::mixed}) {
        for (const double tolerance : {0.002, 0.02, 0.1}) add(kernels, "compress", kind, curves::compress, tolerance);
        add(kernels, "compress_published", kind, curves::compress_published, 0.02);
        add(kernels, "fewest", kind, compress_to_fewest, 0.02);
    }
}

}  // namespace shadowbench::kernels
