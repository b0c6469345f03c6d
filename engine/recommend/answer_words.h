// The words of answers.
#pragma once

#include <cstddef>
#include <string>

namespace shadowbench::recommend {

// A cost with its unit: "10.5 ns", "128 KiB", "24.1 ms".
std::string cost_text(double value, std::size_t cost);

}  // namespace shadowbench::recommend
