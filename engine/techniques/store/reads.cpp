#include "techniques/store/reads.h"

#include <algorithm>

#include "base/simd_path.h"

namespace shadowbench::techniques {
void Reads::begin(std::size_t number_of_slots) {
    // The numbers of slots stay until reads in any order overwrite them.
    if (number_of_slots > 0 && slots == 0)
        for (std::size_t r = 0; r < most; ++r) query[r] = static_cast<std::uint8_t>(r % block_queries);
    slots = number_of_slots;
    count = slots * block_queries;
}

void set_weights(const Cover& cover, double* weights) {
    base::on_simd_path([&cover, weights]() SHADOWBENCH_SIMD_LOOP {
        double* __restrict weight = weights;
        for (std::size_t k = 0; k < block_queries; ++k) {
            const double second_x = cover.across.end[k] - cover.across.begin[k] == 2 ? cover.across.last[k] : 0.0;
            const double second_y = cover.down.end[k] - cover.down.begin[k] == 2 ? cover.down.last[k] : 0.0;
            weight[k] = cover.down.first[k] * cover.across.first[k];
            weight[block_queries + k] = cover.down.first[k] * second_x;
            weight[2 * block_queries + k] = second_y * cover.across.first[k];
            weight[3 * block_queries + k] = second_y * second_x;
        }
    });
}

void average(const Reads& reads, const std::array<bool, block_queries>& inside, float highest,
             std::span<float> answers) {
    if (reads.slots == 1) {
        for (std::size_t k = 0; k < answers.size(); ++k)
            answers[k] = inside[k] ? std::min(reads.value[k], highest) : 1.0f;
        return;
    }
    std::array<float, block_queries> mean;
    base::on_simd_path([&reads, highest, means = mean.data()]() SHADOWBENCH_SIMD_LOOP {
        for (std::size_t k = 0; k < block_queries; ++k) {
            double sum = 0.0, weights = 0.0;
            for (std::size_t s = 0; s < Reads::most_slots; ++s) {
                const double weight = reads.weight[s * block_queries + k];
                sum += weight * reads.value[s * block_queries + k];
                weights += weight;
            }
            means[k] = std::min(static_cast<float>(sum / weights), highest);
        }
    });
    for (std::size_t k = 0; k < answers.size(); ++k) answers[k] = inside[k] ? mean[k] : 1.0f;
}

}  // namespace shadowbench::techniques
