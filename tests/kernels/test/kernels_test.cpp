// All kernels, run as their users run them: once each, for their counters, not their times.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "kernels/exact.h"
#include "kernels/kernel.h"
#include "kernels/test/program.h"
#include "techniques/technique.h"
#include "temporary_folder.h"

namespace shadowbench::kernels {
namespace {

using nlohmann::json;

bool starts_with(const std::string& text, const std::string& start) {
    return text.rfind(start, 0) == 0;
}

TEST(Kernels, HaveDifferentNames) {
    std::set<std::string> names;
    for (const Kernel& kernel : all_kernels()) EXPECT_TRUE(names.insert(kernel.name).second) << kernel.name;
    for (const char* family :
         {"reference/", "capture/", "march/", "sweep/", "compress/", "insert/", "build/", "lookup/", "load/"}) {
        const auto first = names.lower_bound(family);
        EXPECT_TRUE(first != names.end() && starts_with(*first, family)) << family;
    }
}

TEST(Kernels, BuildAndLookUpEveryTechniqueOfTheRegistry) {
    std::map<std::string, int> builds, image, random;
    for (const Kernel& kernel : all_kernels())
        for (const techniques::Technique& row : techniques::all()) {
            const std::string id = row.id;
            builds[id] += starts_with(kernel.name, "build/" + id + "/");
            if (!starts_with(kernel.name, "lookup/" + id + "/")) continue;
            image[id] += kernel.name.ends_with("/image");
            random[id] += kernel.name.ends_with("/random");
        }
    for (const techniques::Technique& row : techniques::all()) {
        EXPECT_GE(builds[row.id], 2) << row.id;
        EXPECT_EQ(image[row.id], builds[row.id]) << row.id;
        EXPECT_EQ(random[row.id], builds[row.id]) << row.id;
    }
}

// The counters that a kernel of each family must have.
std::set<std::string> counters_of(const std::string& name) {
    std::set<std::string> counters{"real_time", "cpu_time"};
    if (!starts_with(name, "reference/")) counters.insert({"bytes", "nodes"});
    const auto& rows = techniques::all();
    const bool traced = std::any_of(rows.begin(), rows.end(), [&](const techniques::Technique& row) {
        return row.traits.traces && name.find(fmt::format("/{}/", row.id)) != std::string::npos;
    });
    if (starts_with(name, "lookup/")) counters.insert("ns_per_lookup");
    if (starts_with(name, "lookup/") && !traced) counters.insert({"lookup_error", "error", "floor_ratio"});
    if (starts_with(name, "build/") && !traced) counters.insert({"error", "ns_per_vertex", "floor_ratio"});
    if (starts_with(name, "sweep/") || starts_with(name, "compress"))
        counters.insert({"error", "ns_per_vertex", "floor_ratio"});
    if (starts_with(name, "march/")) counters.insert("ns_per_vertex");
    if (starts_with(name, "capture/") || starts_with(name, "insert/") || starts_with(name, "load/"))
        counters.insert({"ns_per_vertex", "floor_ratio"});
    return counters;
}

// Runs each kernel once, and compares its counters with the counts of another process without a clock.
TEST(Kernels, RunAndCountTheSameInEveryProcess) {
    const TemporaryFolder folder;
    const auto timed = testing::run("--benchmark_min_time=0 --benchmark_out=" + folder.path("timed.json"));
    ASSERT_EQ(timed.code, 0) << timed.said;
    const auto exact = testing::run("--exact=" + folder.path("exact.json"));
    ASSERT_EQ(exact.code, 0) << exact.said;
    const json runs = testing::read_json(folder.path("timed.json")).at("benchmarks");
    const json counts = testing::read_json(folder.path("exact.json")).at("benchmarks");
    const Kernels kernels = all_kernels();
    ASSERT_EQ(runs.size(), kernels.size());
    ASSERT_EQ(counts.size(), kernels.size());
    for (std::size_t k = 0; k < kernels.size(); ++k) {
        const std::string& name = kernels[k].name;
        EXPECT_EQ(runs[k].at("name"), name);
        EXPECT_EQ(counts[k].at("name"), name);
        EXPECT_FALSE(runs[k].contains("error_occurred")) << name << runs[k];
        for (const std::string& counter : counters_of(name)) {
            ASSERT_TRUE(runs[k].contains(counter)) << name << " lacks " << counter;
            EXPECT_GE(runs[k].at(counter).get<double>(), 0.0) << name << " " << counter;
        }
        for (const char* count : {"bytes", "nodes", "error", "lookup_error"}) {
            ASSERT_EQ(runs[k].contains(count), counts[k].contains(count)) << name << " " << count;
            if (counts[k].contains(count)) {
                EXPECT_EQ(runs[k].at(count).get<double>(), counts[k].at(count).get<double>()) << name << " " << count;
            }
        }
    }
    // In this process on all threads; in the other on one.
    EXPECT_EQ(write_exact(kernels, "", {}, folder.path("again.json")), 0u);
    EXPECT_EQ(testing::read(folder.path("again.json")), testing::read(folder.path("exact.json")));
}

TEST(Kernels, RefuseWrongUsageWithAMessage) {
    for (const auto& [arguments, says] :
         std::map<std::string, std::string>{{"--inject=slow", "not FAULT:REGEX:AMOUNT"},
                                            {"--inject=fast:x:1", "no fault \"fast\""},
                                            {"--inject=slow:x:much", "\"much\" is not an amount"},
                                            {"--inject=slow:x:-1", "\"-1\" is not an amount"},
                                            {"'--inject=slow:(:1'", "the expression is not valid"},
                                            {"--inject=slow:no_such_kernel:1", "no kernel has such a name"},
                                            {"--frobnicate", "--frobnicate"}}) {
        const auto outcome = testing::run(arguments);
        EXPECT_EQ(outcome.code, 64) << arguments;
        EXPECT_NE(outcome.said.find(says), std::string::npos) << outcome.said;
    }
}

}  // namespace
}  // namespace shadowbench::kernels
