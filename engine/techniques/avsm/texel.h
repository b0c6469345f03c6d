// Evaluates texels (section 3.3): finds the two nodes around a depth and samples the curve between them.
#pragma once

#include <array>

#include "techniques/avsm/sampling.h"
#include "techniques/store/reads.h"

namespace shadowbench::techniques {

// Returns the value at z of `nodes` sorted depths followed by as many values.
using TexelEvaluator = float (*)(const float* texel, int nodes, float z);
// Sets the values of all reads; read r is at depths[reads.query[r]].
using ReadsEvaluator = void (*)(Reads& reads, const std::array<float, block_queries>& depths, int nodes);

// The fastest evaluator for this number of nodes on this machine; all evaluators give the same values.
TexelEvaluator texel_evaluator(int nodes, Sampling sampling);
ReadsEvaluator reads_evaluator(int nodes, Sampling sampling);

}  // namespace shadowbench::techniques
