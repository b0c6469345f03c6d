#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>

#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/temporary_folder.h"
#include "base/write_files.h"
#include "results/write_result.h"
#include "service/cli/callgrind_counts.h"
#include "service/cli/child.h"
#include "service/cli/kernel_commands.h"
#include "service/cli/this_program.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using json = nlohmann::ordered_json;

// The C library chooses its functions by what the processor can do: these features are hidden from it, so that as many
// processors as can be count alike, and symbols are bound before anything is counted.
constexpr const char* surroundings[] = {
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512BW,-AVX2,-AVX,-FMA,-ERMS", "LD_BIND_NOW=1"};

std::string find_valgrind() {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::path(folder) / "valgrind";
        if (access(program.c_str(), X_OK) == 0) return program.string();
    }
    throw Error(ErrorCode::no_such_file, "valgrind",
                "it is not installed, so no instructions are counted; install the package valgrind");
}

// What the program itself said last: valgrind's own lines begin with "==".
std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last = "it said nothing";
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line.rfind("==", 0) != 0) last = line;
    return last;
}

std::vector<std::string> arguments_of(const InstructionArguments& told, const std::string& program,
                                      const std::string& valgrind, const fs::path& folder) {
    std::vector<std::string> arguments(std::begin(surroundings), std::end(surroundings));
    arguments.insert(arguments.end(),
                     {valgrind, "--tool=callgrind", "--instr-atstart=no",
                      "--callgrind-out-file=" + (folder / "counts").string(), program, "--benchmark_min_time=0",
                      "--benchmark_out_format=json", "--benchmark_out=" + (folder / "kernels.json").string()});
    if (!told.filter.empty()) arguments.push_back("--benchmark_filter=" + told.filter);
    arguments.insert(arguments.end(), told.arguments.begin(), told.arguments.end());
    return arguments;
}

json read_kernels(const fs::path& file, const std::string& log) {
    try {
        return json::parse(base::read_text(file));
    } catch (const std::exception&) {
        throw Error(ErrorCode::bad_input, "--filter", "no kernel was run: " + last_line(log));
    }
}

// Times under callgrind say nothing: the counts stand in their place.
void put_in(const std::map<std::string, std::uint64_t>& counts, json& kernels) {
    for (json& kernel : kernels.at("benchmarks")) {
        for (const char* time : {"iterations", "real_time", "cpu_time", "time_unit"}) kernel.erase(time);
        if (kernel.contains("error_occurred")) continue;
        const auto count = counts.find(kernel.at("name").get<std::string>());
        if (count == counts.end())
            throw Error(ErrorCode::internal, kernel.at("name").get<std::string>(),
                        "callgrind has not counted this kernel; was the program built with valgrind/callgrind.h?");
        kernel["instructions"] = count->second;
    }
}

void print(const json& kernels, std::ostream& out) {
    for (const json& kernel : kernels.at("benchmarks")) {
        const std::string name = kernel.at("name").get<std::string>();
        if (kernel.contains("instructions"))
            out << fmt::format("{:>15}  {}\n", kernel.at("instructions").get<std::uint64_t>(), name);
        else
            out << fmt::format("{:>15}  {}: {}\n", "wrong", name, kernel.value("error_message", ""));
    }
}

}  // namespace

std::string kernel_program(const std::string& told) {
    const std::string program = told.empty() ? (fs::path(this_program()).parent_path() / "kernels").string() : told;
    check_program(program);
    return program;
}

bool instructions_command(const InstructionArguments& arguments, std::ostream& out) {
    const std::string program = fs::absolute(kernel_program(arguments.kernels)).string();
    const EndingSignals signals;
    const base::TemporaryFolder folder;
    const fs::path log = folder.path() / "log";
    const int code = run_child("/usr/bin/env", arguments_of(arguments, program, find_valgrind(), folder.path()), log);
    const std::string said = base::read_text(log);
    if (code != 0 && code != wrong_answer)
        throw Error(ErrorCode::internal, program,
                    fmt::format("ended with exit code {} under callgrind: {}", code, last_line(said)));
    json kernels = read_kernels(folder.path() / "kernels.json", said);
    put_in(callgrind_counts(folder.path() / "counts"), kernels);
    base::write_files({{arguments.out, kernels.dump(2) + "\n"}});
    print(kernels, out);
    out << fmt::format("written: {}\n", arguments.out);
    return code == 0;
}

}  // namespace shadowbench::service
