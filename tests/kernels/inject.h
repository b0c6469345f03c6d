// Faults put into kernels on purpose, so that a gate can show that it catches them. The engine knows nothing of them.
#pragma once

#include <regex>
#include <span>
#include <string>
#include <vector>

#include "kernels/kernel.h"

namespace shadowbench::kernels {

enum class Fault { slow, node, byte, error };

// slow:REGEX:0.10 makes a tenth of a kernel's passes once more; node, byte and error:REGEX:AMOUNT add to what is
// counted. A kernel is meant when the expression is found anywhere in its name.
struct Injection {
    Fault fault;
    std::regex names;
    double amount;
    std::string text;  // as given
};

// Throws std::invalid_argument.
Injection read_injection(const std::string& text);

// Those of a kernel, all together.
struct Faults {
    double slow = 0.0, nodes = 0.0, bytes = 0.0, error = 0.0;
};
Faults faults_of(const std::string& kernel, std::span<const Injection> injections);

// Both errors grow. What a kernel does not count stays uncounted.
Exact with(Exact exact, const Faults& faults);

}  // namespace shadowbench::kernels
