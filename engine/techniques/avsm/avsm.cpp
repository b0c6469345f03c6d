// Adaptive volumetric shadow maps: Salvi, Vidimce, Lauritzen, Lefohn, Adaptive Volumetric Shadow Maps, 2010.
#include "base/error.h"
#include "techniques/avsm/filling.h"
#include "techniques/avsm/order.h"
#include "techniques/avsm/stream.h"
#include "techniques/avsm/texel.h"
#include "techniques/store/texel_map.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"nodes", ParameterKind::integer, "nodes per texel", 8, 2, 64},
    {.name = "order",
     .kind = ParameterKind::choice,
     .doc = "the order in which a ray's segments are inserted: by depth, as they were submitted, or at random",
     .standard_word = "sorted",
     .words = {"sorted", "captured", "shuffled"}},
    {"seed", ParameterKind::integer, "seed of the random order", 1, 0, 1e9},
    {.name = "sampling",
     .kind = ParameterKind::choice,
     .doc = "how transmittance falls between two nodes: linearly or exponentially",
     .standard_word = "linear",
     .words = {"linear", "exponential"}},
    filter_parameter,
    averaged_cells_parameter,
};

Order read_order(const ParameterValues& values) {
    const std::string& word = values.word("order");
    return word == "sorted" ? Order::sorted : word == "captured" ? Order::captured : Order::shuffled;
}
Sampling read_sampling(const ParameterValues& values) {
    return values.word("sampling") == "linear" ? Sampling::linear : Sampling::exponential;
}

// A texel is 2 * nodes floats: depths, then values. Each is made by streaming its ray's segments through one curve of a
// fixed size and is written once: besides the map, no memory grows with the scene.
class Avsm final : public TexelMap<Avsm> {
public:
    explicit Avsm(const ParameterValues& values)
        : TexelMap(values),
          nodes_(values.integer("nodes")),
          order_(read_order(values)),
          seed_(static_cast<std::uint64_t>(values.integer("seed"))),
          sampling_(read_sampling(values)),
          evaluate_(texel_evaluator(nodes_, sampling_)),
          evaluate_all_(reads_evaluator(nodes_, sampling_)) {}
    static int floats_a_texel(const ParameterValues& values) { return 2 * values.integer("nodes"); }

    Avsm(const ParameterValues& values, std::span<const curves::Curve> functions) : Avsm(values) {
        texels_.kind = Cells::centre;
        float far_plane = 0.0f;
        for (const curves::Curve& f : functions)
            if (!f.empty()) far_plane = std::max(far_plane, f.back().z);
        far_plane = std::nextafter(far_plane, std::numeric_limits<float>::infinity());
        rays::MapLayout layout;
        layout.width = static_cast<int>(functions.size());
        layout.z_max = far_plane;
        allocate(layout);
        with_stream([&](auto& stream) {
            for (std::size_t f = 0; f < functions.size(); ++f) {
                stream.clear(far_plane);
                for (const curves::Vertex& v : functions[f]) stream.append(v.z, v.value);
                store(stream, texels_.at(f));
            }
        });
    }

    RayNeeds needs() const override {
        RayNeeds needs = TexelMap::needs();
        needs.submission = order_ == Order::captured;
        return needs;
    }

    void fill(const rays::LightRays& rays) {
        if (order_ == Order::captured && rays.submission.size() != rays.segments())
            throw base::Error(base::ErrorCode::internal, "/techniques",
                              "avsm: the light rays do not hold the order of their segments");
        switch (sampling_ == Sampling::linear ? nodes_ : 0) {
            case 4:
                return fill_side_by_side<4>(rays);
            case 8:
                return fill_side_by_side<8>(rays);
            case 16:
                return fill_side_by_side<16>(rays);
            default:
                return fill_one_by_one(rays);
        }
    }

    float prepare(float z) const { return z; }
    float evaluate(const float* texel, float z) const { return evaluate_(texel, nodes_, z); }
    void evaluate_all(Reads& reads, const std::array<float, block_queries>& depths) const {
        evaluate_all_(reads, depths, nodes_);
    }
    // The number of nodes, except those that repeat the one at the far plane.
    int nodes_of(const float* t) const {
        int n = nodes_;
        while (n > 1 && t[n - 2] == t[n - 1] && t[nodes_ + n - 2] == t[nodes_ + n - 1]) --n;
        return n == 1 ? 0 : n;
    }
    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        const float* t = texels_.at(texels_.grid.index(x, y));
        const int n = nodes_of(t);
        out.clear();
        const bool sampled = sampling_ == Sampling::exponential;
        std::size_t k = 0;
        for (int i = 0; i < n; ++i) {
            for (; k < depths.size() && depths[k] <= t[i]; ++k)
                if (sampled && i > 0 && depths[k] < t[i]) out.push_back({depths[k], evaluate_(t, nodes_, depths[k])});
            out.push_back({t[i], t[nodes_ + i]});
        }
    }

private:
    template <int nodes>
    void fill_side_by_side(const rays::LightRays& rays) {
        Filling<nodes> filling(rays, order_, layout_.z_max);
        for_each_texel(rays, [&](float* texel, std::size_t cell, std::size_t ray) {
            if (rays.begin[ray] == rays.begin[ray + 1]) return store_empty(texel);
            filling.add(texel, ray, base::hash(seed_, cell));
        });
        filling.finish();
    }
    void fill_one_by_one(const rays::LightRays& rays) {
        with_stream([&](auto& stream) {
            SegmentOrder order;
            std::array<std::uint32_t, 64> segments;
            for_each_texel(rays, [&](float* texel, std::size_t cell, std::size_t ray) {
                if (rays.begin[ray] == rays.begin[ray + 1]) return store_empty(texel);
                stream.clear(layout_.z_max);
                order.begin(rays, ray, order_, base::hash(seed_, cell));
                while (order.left() > 0) {
                    const auto next = std::span(segments).first(std::min<std::size_t>(segments.size(), order.left()));
                    order.next(next);
                    for (const std::uint32_t s : next)
                        stream.insert(rays.z_front[s], rays.back(s), rays.transmittance[s]);
                }
                store(stream, texel);
            });
        });
    }

    void store_empty(float* t) const {
        std::fill_n(t, nodes_, layout_.z_max);
        std::fill_n(t + nodes_, nodes_, 1.0f);
    }

    // Unused nodes are at the far plane with the last value.
    template <class Stream>
    void store(const Stream& stream, float* t) const {
        int i = 0;
        stream.for_each([&](float depth, float value) {
            t[i] = depth;
            t[nodes_ + i] = value;
            ++i;
        });
        for (const int last = i - 1; i < nodes_; ++i) {
            t[i] = t[last];
            t[nodes_ + i] = t[nodes_ + last];
        }
    }

    // Calls work(stream) with a stream of the smallest sufficient size.
    template <class Work>
    void with_stream(const Work& work) {
        if (sampling_ == Sampling::linear)
            with_sampled_stream<Sampling::linear>(work);
        else
            with_sampled_stream<Sampling::exponential>(work);
    }
    template <Sampling sampling, class Work>
    void with_sampled_stream(const Work& work) {
        const auto run = [&]<int size>() {
            TransmittanceStream<size, sampling> stream(nodes_, layout_.z_max);
            work(stream);
        };
        if (nodes_ <= 4)
            run.template operator()<4>();
        else if (nodes_ <= 8)
            run.template operator()<8>();
        else if (nodes_ <= 16)
            run.template operator()<16>();
        else
            run.template operator()<64>();
    }

    int nodes_;
    Order order_;
    std::uint64_t seed_;
    Sampling sampling_;
    TexelEvaluator evaluate_;
    ReadsEvaluator evaluate_all_;
};

}  // namespace

// Not traded: `order` captured and shuffled, which lose accuracy at the same size; `cells`, since one function a sample
// is a finer map of one sample.
Technique avsm() {
    Traits traits = texel_traits();
    traits.trades = {{"nodes", Trade::Scale::logarithmic, 2, 64},
                     {.parameter = "sampling", .choices = {"linear", "exponential"}},
                     filter_trade};
    traits.segment_rounding = 0x1p-24;                           // see stream.h
    traits.order_free = {{"order", "sorted"}, {"nodes", 64.0}};  // once a node is dropped, the order counts
    return {.id = "avsm",
            .title = "adaptive volumetric shadow map: a fixed number of nodes a texel",
            .paper = "Salvi et al. 2010",
            .version = 3,
            .parameters = parameters,
            .create = create_map<Avsm>,
            .from_curves = [](const ParameterValues& values, std::span<const curves::Curve> functions)
                -> std::unique_ptr<Map> { return std::make_unique<Avsm>(values, functions); },
            .least_bytes = Avsm::least_bytes,
            .traits = traits};
}

}  // namespace shadowbench::techniques
