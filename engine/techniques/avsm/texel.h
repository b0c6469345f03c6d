// Evaluates a texel (section 3.3): finds the two nodes around a depth and samples the curve between them.
#pragma once

#include "techniques/avsm/sampling.h"

namespace shadowbench::techniques {

// Returns the value at z of `nodes` sorted depths followed by as many values.
using TexelEvaluator = float (*)(const float* texel, int nodes, float z);

// The fastest evaluator for this number of nodes on this machine; all evaluators give the same values.
TexelEvaluator texel_evaluator(int nodes, Sampling sampling);

}  // namespace shadowbench::techniques
