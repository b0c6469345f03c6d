// A command line run inside the test, and what came of it.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "service/cli/cli.h"

namespace shadowbench::service {

struct Outcome {
    int code;
    std::string out, err;
};

inline Outcome cli(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"shadowbench"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    std::ostringstream out, err;
    const int code = cli_main(static_cast<int>(argv.size()), argv.data(), out, err);
    return {code, out.str(), err.str()};
}

}  // namespace shadowbench::service
