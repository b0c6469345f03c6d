#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>

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

// The environment of the program that is counted. The C library chooses its functions by the features of the processor;
// hiding these features makes the counts of different processors comparable. Symbols are bound before counting starts.
constexpr const char* environment[] = {
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512BW,-AVX2,-AVX,-FMA,-ERMS", "LD_BIND_NOW=1"};

// The last line that the program itself wrote: valgrind's lines begin with "==".
std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last = "it wrote nothing";
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line.rfind("==", 0) != 0) last = line;
    return last;
}

std::vector<std::string> arguments_of(const InstructionArguments& given, const std::string& program,
                                      const std::string& valgrind, const fs::path& folder) {
    std::vector<std::string> arguments(std::begin(environment), std::end(environment));
    arguments.insert(arguments.end(),
                     {valgrind, "--tool=callgrind", "--instr-atstart=no",
                      "--callgrind-out-file=" + (folder / "counts").string(), program, "--benchmark_min_time=0",
                      "--benchmark_out_format=json", "--benchmark_out=" + (folder / "kernels.json").string()});
    if (!given.filter.empty()) arguments.push_back("--benchmark_filter=" + given.filter);
    arguments.insert(arguments.end(), given.arguments.begin(), given.arguments.end());
    return arguments;
}

json read_kernels(const fs::path& file, const std::string& log) {
    try {
        return json::parse(base::read_text(file));
    } catch (const std::exception&) {
        throw Error(ErrorCode::bad_input, "--filter", "no kernel was run: " + last_line(log));
    }
}

// Puts the counts in the place of the times, which mean nothing under callgrind.
void put_counts(const std::map<std::string, std::uint64_t>& counts, json& kernels) {
    for (json& kernel : kernels.at("benchmarks")) {
        for (const char* time : {"iterations", "real_time", "cpu_time", "time_unit"}) kernel.erase(time);
        if (kernel.contains("error_occurred")) continue;
        const auto count = counts.find(kernel.at("name").get<std::string>());
        if (count == counts.end())
            throw Error(ErrorCode::internal, kernel.at("name").get<std::string>(),
                        "callgrind did not count this kernel; build the program with valgrind/callgrind.h");
        kernel["instructions"] = count->second;
    }
}

// Returns the exit code of the program that is counted.
int count(const std::string& valgrind, const std::vector<std::string>& arguments, const fs::path& log) {
    try {
        return run_child("/usr/bin/env", arguments, log);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::internal) throw;
        throw Error(ErrorCode::internal, valgrind,
                    error.message() + "; it may not know all instructions of this processor: install a newer valgrind");
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

std::string kernel_program(const std::string& given) {
    const std::string program = given.empty() ? (fs::path(this_program()).parent_path() / "kernels").string() : given;
    check_program(program);
    return program;
}

bool instructions_command(const InstructionArguments& arguments, std::ostream& out) {
    const std::string program = fs::absolute(kernel_program(arguments.kernels)).string();
    const EndingSignals signals;
    const base::TemporaryFolder folder;
    const fs::path log = folder.path() / "log";
    const std::string valgrind = find_program("valgrind", "install the package valgrind");
    const int code = count(valgrind, arguments_of(arguments, program, valgrind, folder.path()), log);
    const std::string output = base::read_text(log);
    if (code != 0 && code != wrong_answer)
        throw Error(ErrorCode::internal, program,
                    fmt::format("ended with exit code {} under callgrind: {}", code, last_line(output)));
    json kernels = read_kernels(folder.path() / "kernels.json", output);
    put_counts(callgrind_counts(folder.path() / "counts"), kernels);
    base::write_files({{arguments.out, kernels.dump(2) + "\n"}});
    print(kernels, out);
    out << fmt::format("written: {}\n", arguments.out);
    return code == 0;
}

}  // namespace shadowbench::service
