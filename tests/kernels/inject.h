// Puts faults into kernels, so that tests can show that a gate finds them. The engine does not know about them.
#pragma once

#include <regex>
#include <span>
#include <string>
#include <vector>

#include "kernels/kernel.h"

namespace shadowbench::kernels {

enum class Fault { slow, node, byte, error };

// slow:REGEX:0.10 repeats a tenth of a kernel's passes; node, byte and error:REGEX:AMOUNT add to its counts. A fault
// applies to every kernel in whose name the expression is found.
struct Injection {
    Fault fault;
    std::regex names;
    double amount;
    std::string text;  // as given
};

// Throws std::invalid_argument.
Injection read_injection(const std::string& text);

// The sum of all faults of one kernel.
struct Faults {
    double slow = 0.0, nodes = 0.0, bytes = 0.0, error = 0.0;
};
Faults faults_of(const std::string& kernel, std::span<const Injection> injections);

// Adds to the counts of a kernel; both errors grow. A count that the kernel does not have stays absent.
Exact with(Exact exact, const Faults& faults);

}  // namespace shadowbench::kernels
