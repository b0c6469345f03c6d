// Evaluation of a texel (section 3.3): the two nodes around a depth, and what the curve does between them.
#pragma once

#include "techniques/avsm/sampling.h"

namespace shadowbench::techniques {

// Value at z of `nodes` sorted depths followed by as many values.
using TexelEvaluator = float (*)(const float* texel, int nodes, float z);

// The fastest way for this number of nodes on this machine; all ways give the same values.
TexelEvaluator texel_evaluator(int nodes, Sampling sampling);

}  // namespace shadowbench::techniques
