#include "scene/json_read.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace shadowbench::scene {
namespace {

template <typename T>
void get(const json& object, const char* key, T& value) {
    if (const auto found = object.find(key); found != object.end()) value = found->get<T>();
}

template <typename T>
T triple(const json& value) {
    using Number = typename T::BaseType;
    return T(value[0].get<Number>(), value[1].get<Number>(), value[2].get<Number>());
}

template <typename T>
T pair(const json& value) {
    using Number = typename T::BaseType;
    return T(value[0].get<Number>(), value[1].get<Number>());
}

template <typename T, typename Convert>
void get_list(const json& object, const char* key, std::vector<T>& values, Convert convert) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    values.clear();
    values.reserve(found->size());
    for (const json& item : *found) values.push_back(convert(item));
}

}  // namespace

void read(const json& object, const char* key, bool& value) {
    get(object, key, value);
}
void read(const json& object, const char* key, int& value) {
    get(object, key, value);
}
void read(const json& object, const char* key, std::uint64_t& value) {
    get(object, key, value);
}
void read(const json& object, const char* key, double& value) {
    get(object, key, value);
}
void read(const json& object, const char* key, std::string& value) {
    get(object, key, value);
}

void read(const json& object, const char* key, base::Vec3d& value) {
    if (const auto found = object.find(key); found != object.end()) value = triple<base::Vec3d>(*found);
}

void read(const json& object, const char* key, base::Vec3i& value) {
    if (const auto found = object.find(key); found != object.end()) value = triple<base::Vec3i>(*found);
}

void read(const json& object, const char* key, base::Vec2i& value) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    value = found->is_array() ? pair<base::Vec2i>(*found) : base::Vec2i(found->get<int>());
}

void read(const json& object, const char* key, base::Vec3f& value) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    value = found->is_array() ? triple<base::Vec3f>(*found) : base::Vec3f(found->get<float>());
}

void read(const json& object, const char* key, std::optional<double>& value) {
    if (const auto found = object.find(key); found != object.end()) value = found->get<double>();
}

void read(const json& object, const char* key, std::optional<base::Vec2d>& value) {
    if (const auto found = object.find(key); found != object.end()) value = pair<base::Vec2d>(*found);
}

void read(const json& object, const char* key, std::optional<base::Vec3d>& value) {
    if (const auto found = object.find(key); found != object.end()) value = triple<base::Vec3d>(*found);
}

void read(const json& object, const char* key, std::vector<float>& values) {
    get_list(object, key, values, [](const json& item) { return item.get<float>(); });
}

void read(const json& object, const char* key, std::vector<base::Vec3f>& values) {
    get_list(object, key, values, triple<base::Vec3f>);
}

void read(const json& object, const char* key, std::vector<base::Vec3d>& values) {
    get_list(object, key, values, triple<base::Vec3d>);
}

void read(const json& object, const char* key, std::vector<base::Vec2f>& values) {
    get_list(object, key, values, pair<base::Vec2f>);
}

void read(const json& object, const char* key, std::vector<base::Vec3i>& values) {
    get_list(object, key, values, triple<base::Vec3i>);
}

void refuse(const std::string& where, const std::string& message) {
    throw base::Error(base::ErrorCode::bad_input, where, message);
}

void check_direction(const base::Vec3d& direction, const std::string& where) {
    if (!(direction.length() > 0.0)) refuse(where, "a direction needs a length above 0");
}

void check_not_parallel(const base::Vec3d& a, const base::Vec3d& b, const std::string& where,
                        const std::string& message) {
    // Closer to parallel than this, float precision would decide which way the plane of the two vectors faces.
    constexpr double least_sine = 1e-6;
    if (!(a.normalized().cross(b.normalized()).length() > least_sine)) refuse(where, message);
}

}  // namespace shadowbench::scene
