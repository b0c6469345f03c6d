// One word on a measured cell: whether the technique kept what it promises, did all that it states and yet strayed, or
// broke a promise. bench/verdict.h has the rule.
#pragma once

namespace shadowbench::results {

enum class Verdict { kept, degraded, failed };

const char* to_string(Verdict verdict);

}  // namespace shadowbench::results
