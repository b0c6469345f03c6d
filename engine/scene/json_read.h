// Reads keys of a JSON object that has passed the schema, so types and ranges are right. If a key is absent, the value
// stays as it is: the structs hold the defaults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/vec.h"

namespace shadowbench::scene {

using nlohmann::json;

void read(const json& object, const char* key, bool& value);
void read(const json& object, const char* key, int& value);
void read(const json& object, const char* key, std::uint64_t& value);
void read(const json& object, const char* key, double& value);
void read(const json& object, const char* key, std::string& value);
void read(const json& object, const char* key, base::Vec3d& value);
void read(const json& object, const char* key, base::Vec3i& value);
void read(const json& object, const char* key, base::Vec2i& value);  // a number sets both
void read(const json& object, const char* key, base::Vec3f& value);  // a number sets all three
void read(const json& object, const char* key, std::optional<double>& value);
void read(const json& object, const char* key, std::optional<base::Vec2d>& value);
void read(const json& object, const char* key, std::optional<base::Vec3d>& value);
void read(const json& object, const char* key, std::vector<float>& values);
void read(const json& object, const char* key, std::vector<base::Vec3f>& values);
void read(const json& object, const char* key, std::vector<base::Vec3d>& values);
void read(const json& object, const char* key, std::vector<base::Vec2f>& values);
void read(const json& object, const char* key, std::vector<base::Vec3i>& values);

// Throws Error{bad_input}.
[[noreturn]] void refuse(const std::string& where, const std::string& message);

// Refuses a vector of length 0, or a pair of parallel vectors (which span no plane or frame).
void check_direction(const base::Vec3d& direction, const std::string& where);
void check_not_parallel(const base::Vec3d& a, const base::Vec3d& b, const std::string& where,
                        const std::string& message);

}  // namespace shadowbench::scene
