// Shared by the tests of scene: temporary files, the data outside the project, and errors.
#pragma once

#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/scene.h"

namespace shadowbench::scene::test {

// A path in the temporary folder that no other test uses; the file does not exist yet.
std::filesystem::path fresh_path(const std::string& name);

std::filesystem::path write_file(const std::string& name, const std::string& bytes);
std::string read_bytes(const std::filesystem::path& file);

// $SHADOWBENCH_DATA, or ../shared/data beside the source; empty if neither holds the file.
std::filesystem::path data_file(const std::string& name);

// The area of all triangles together.
double area(const Mesh& mesh);

// The Error that `action` throws; the test fails if it throws none or something else.
base::Error error_of(const std::function<void()>& action);

// Calls `read` on the file cut at every one of `cuts` lengths below `least`, which must all be refused as bad input.
void expect_cuts_refused(const std::string& bytes, const std::string& name, std::size_t least,
                         const std::function<void(const std::filesystem::path&)>& read);

// Calls `read` on the file with every byte changed in several ways, one at a time. It must give a volume whose
// densities are in [0, 1] and as many as its size says, or refuse the file as bad input.
void expect_changes_survived(const std::string& bytes, const std::string& name,
                             const std::function<GridVolume(const std::filesystem::path&)>& read);

// Appends the bytes of values as they are in memory.
template <typename... T>
std::string bytes_of(T... values) {
    std::string bytes;
    (bytes.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
    return bytes;
}

}  // namespace shadowbench::scene::test

#define SHADOWBENCH_NEED_DATA(variable, name)                                           \
    const std::filesystem::path variable = ::shadowbench::scene::test::data_file(name); \
    if (variable.empty()) GTEST_SKIP() << name << " is not there: set SHADOWBENCH_DATA"
