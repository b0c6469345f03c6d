// Runs the program of the kernels as its users do.
#pragma once

#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace shadowbench::kernels::testing {

struct Outcome {
    int code;
    std::string said;  // standard output and standard error
};

// Runs it with these arguments, which a shell interprets.
Outcome run(const std::string& arguments);

std::string read(const std::string& file);
nlohmann::json read_json(const std::string& file);

}  // namespace shadowbench::kernels::testing
