#include "kernels/test/program.h"

#include <sys/wait.h>

#include <cstdio>
#include <iterator>
#include <stdexcept>

namespace shadowbench::kernels::testing {

Outcome run(const std::string& arguments) {
    std::FILE* pipe = popen(("'" SHADOWBENCH_KERNELS "' " + arguments + " 2>&1").c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot start " SHADOWBENCH_KERNELS);
    Outcome outcome{0, ""};
    char buffer[4096];
    for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.said.append(buffer, n);
    outcome.code = WEXITSTATUS(pclose(pipe));
    return outcome;
}

std::string read(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

nlohmann::json read_json(const std::string& file) {
    return nlohmann::json::parse(read(file));
}

}  // namespace shadowbench::kernels::testing
