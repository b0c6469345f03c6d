// The verdict on a measured cell: the technique kept its promises; it kept them, but its error is large (degraded); or
// it broke one (failed). bench/verdict.h has the rule.
#pragma once

namespace shadowbench::results {

enum class Verdict { kept, degraded, failed };

const char* to_string(Verdict verdict);

}  // namespace shadowbench::results
