// The program that measures.
#pragma once

#include <string>

namespace shadowbench::results {

struct Program {
    std::string version;
    std::string commit;  // short hash; "+changes" behind it when the sources differed from it
    std::string compiler;
    std::string build_type;
};

// This one.
Program this_program();

}  // namespace shadowbench::results
