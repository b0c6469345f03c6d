// The program of the kernels, as its users start it.
#pragma once

#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace shadowbench::kernels::testing {

struct Outcome {
    int code;
    std::string said;  // both outputs
};

// Runs it with these arguments, as a shell reads them.
Outcome run(const std::string& arguments);

std::string read(const std::string& file);
nlohmann::json read_json(const std::string& file);

}  // namespace shadowbench::kernels::testing
