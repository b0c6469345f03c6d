// The kernels as a program. It takes Google Benchmark's options, and
//   --exact=FILE               counts only: no clock, the same file on every machine
//   --inject=FAULT:REGEX:AMOUNT  puts in a fault (inject.h); may be repeated
// Exit codes: 0 ok; 2 a kernel gave wrong answers; 64 wrong usage; 70 internal fault.
#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "kernels/exact.h"
#include "kernels/inject.h"
#include "kernels/kernel.h"
#include "kernels/runner.h"
#include "results/machine.h"
#include "results/program.h"

namespace shadowbench::kernels {
namespace {

struct Arguments {
    std::string exact;
    std::vector<Injection> injections;
};

// Takes out the options that Google Benchmark does not know.
Arguments read_arguments(std::vector<char*>& argv) {
    Arguments arguments;
    std::erase_if(argv, [&](const char* text) {
        const std::string_view argument = text;
        const auto value = [&](std::string_view option) { return std::string(argument.substr(option.size())); };
        if (argument.starts_with("--exact=")) {
            arguments.exact = value("--exact=");
            return true;
        }
        if (!argument.starts_with("--inject=")) return false;
        arguments.injections.push_back(read_injection(value("--inject=")));
        return true;
    });
    return arguments;
}

// Refuses a fault that matches no kernel: it would change nothing.
void check_hits(const Kernels& kernels, const std::vector<Injection>& injections) {
    for (const Injection& injection : injections)
        if (std::none_of(kernels.begin(), kernels.end(),
                         [&](const Kernel& kernel) { return std::regex_search(kernel.name, injection.names); }))
            throw std::invalid_argument("--inject=" + injection.text + ": no kernel has such a name");
}

void describe(const std::vector<Injection>& injections) {
    const results::Program build = results::this_program();
    benchmark::AddCustomContext("program", "shadowbench kernels");
    benchmark::AddCustomContext("version", build.version);
    benchmark::AddCustomContext("commit", build.commit);
    benchmark::AddCustomContext("compiler", build.compiler);
    benchmark::AddCustomContext("build_type", build.build_type);
    benchmark::AddCustomContext("cpu", results::this_machine().cpu);
    std::string injected;
    for (const Injection& injection : injections) injected += (injected.empty() ? "" : " ") + injection.text;
    if (!injected.empty()) benchmark::AddCustomContext("injected", injected);
}

int run(int argc, char** argv) {
    std::vector<char*> rest(argv, argv + argc);
    const Arguments arguments = read_arguments(rest);
    const Kernels kernels = all_kernels();
    check_hits(kernels, arguments.injections);
    describe(arguments.injections);
    int count = static_cast<int>(rest.size());
    rest.push_back(nullptr);
    benchmark::Initialize(&count, rest.data());
    if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 64;

    const base::ThreadLimit one_thread(1);
    if (!arguments.exact.empty()) {
        const std::string filter = benchmark::GetBenchmarkFilter();
        return write_exact(kernels, filter == "all" ? "" : filter, arguments.injections, arguments.exact) == 0 ? 0 : 2;
    }
    const Runner runner(kernels, arguments.injections);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return runner.wrong() ? 2 : 0;
}

}  // namespace
}  // namespace shadowbench::kernels

int main(int argc, char** argv) {
    try {
        return shadowbench::kernels::run(argc, argv);
    } catch (const std::invalid_argument& error) {
        std::cerr << "kernels: " << error.what() << "\n";
        return 64;
    } catch (const std::exception& error) {
        std::cerr << "kernels: " << error.what() << "\n";
        return 70;
    }
}
