// Version and build of the program that measured a result.
#pragma once

#include <string>

namespace shadowbench::results {

struct Program {
    std::string version;
    std::string commit;  // short hash, with "+changes" appended if the sources differed from it
    std::string compiler;
    std::string build_type;
};

// The version and build of the running program.
Program this_program();

}  // namespace shadowbench::results
