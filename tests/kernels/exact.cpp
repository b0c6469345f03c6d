#include "kernels/exact.h"

#include <fstream>
#include <regex>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "base/pending_file.h"

namespace shadowbench::kernels {
namespace {

using json = nlohmann::ordered_json;

void set(json& entry, const char* name, std::optional<double> value) {
    if (value) entry[name] = *value;
}

json entry_of(const Kernel& kernel, std::span<const Injection> injections, std::size_t& wrong) {
    json entry{{"name", kernel.name}, {"run_name", kernel.name}, {"run_type", "iteration"}};
    try {
        const Exact exact = with(kernel.prepare().exact, faults_of(kernel.name, injections));
        set(entry, "bytes", exact.bytes);
        set(entry, "nodes", exact.nodes);
        set(entry, "error", exact.error);
        set(entry, "lookup_error", exact.lookup_error);
    } catch (const std::exception& error) {
        entry["error_occurred"] = true;
        entry["error_message"] = error.what();
        ++wrong;
    }
    return entry;
}

std::regex read_filter(const std::string& filter) {
    try {
        return std::regex(filter);
    } catch (const std::regex_error&) {
        throw std::invalid_argument("--benchmark_filter=" + filter + ": the expression is not valid");
    }
}

}  // namespace

std::size_t write_exact(std::span<const Kernel> kernels, const std::string& filter,
                        std::span<const Injection> injections, const std::filesystem::path& file) {
    const std::regex wanted = read_filter(filter);
    std::size_t wrong = 0;
    json entries = json::array();
    for (const Kernel& kernel : kernels)
        if (std::regex_search(kernel.name, wanted)) entries.push_back(entry_of(kernel, injections, wrong));
    if (entries.empty()) throw std::invalid_argument("--benchmark_filter=" + filter + ": no kernel has such a name");
    base::PendingFile pending(file);
    {
        std::ofstream stream(pending.temporary());
        stream << json{{"context", {{"program", "shadowbench kernels"}, {"cpu", "any"}, {"num_cpus", 0}}},
                       {"benchmarks", std::move(entries)}}
                      .dump(2)
               << '\n';
        check(static_cast<bool>(stream.flush()), file.string() + ": cannot write");
    }
    pending.commit();
    return wrong;
}

}  // namespace shadowbench::kernels
