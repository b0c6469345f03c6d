#include "results/machine.h"

#include <fstream>
#include <string>
#include <thread>

namespace shadowbench::results {

Machine this_machine() {
    Machine machine;
    machine.logical_cores = static_cast<int>(std::thread::hardware_concurrency());
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) != 0 || colon == std::string::npos) continue;
        machine.cpu = line.substr(colon + 2);
        break;
    }
    return machine;
}

}  // namespace shadowbench::results
