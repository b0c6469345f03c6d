// Runs the program of the kernels as its users do.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace shadowbench::kernels::testing {

// Removed with its contents when the test ends.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string path(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

struct Outcome {
    int code;
    std::string said;  // standard output and standard error
};

// Runs it with these arguments, which a shell interprets.
Outcome run(const std::string& arguments);

std::string read(const std::string& file);
nlohmann::json read_json(const std::string& file);

}  // namespace shadowbench::kernels::testing
