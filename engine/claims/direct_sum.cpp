#include "claims/direct_sum.h"

#include <algorithm>

namespace shadowbench::claims {

void direct_sum(std::span<const curves::WeightedCurve> terms, std::vector<float>& depths, curves::Curve& out) {
    depths.clear();
    for (const curves::WeightedCurve& term : terms)
        for (const curves::Vertex& vertex : term.curve) depths.push_back(vertex.z);
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    out.clear();
    for (const float z : depths) {
        double before = 0.0, behind = 0.0;
        for (const curves::WeightedCurve& term : terms) {
            before += term.weight * curves::evaluate(term.curve, z);
            behind += term.weight * curves::evaluate_behind(term.curve, z);
        }
        const auto front = static_cast<float>(before), back = static_cast<float>(behind);
        if (front != back) out.push_back({z, front});
        out.push_back({z, back});
    }
}

}  // namespace shadowbench::claims
