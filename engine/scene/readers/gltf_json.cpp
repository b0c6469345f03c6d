#include "scene/readers/gltf_json.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/limits.h"

namespace shadowbench::scene {

void GltfJson::refuse_at(const std::string& at, const std::string& message) const {
    throw base::Error(base::ErrorCode::bad_input, fmt::format("{}: {}", file_.string(), at.empty() ? "/" : at),
                      message);
}

const GltfJson::Json* GltfJson::find(const Json& from, const char* key) const {
    const auto found = from.find(key);
    return found == from.end() ? nullptr : &*found;
}

const GltfJson::Json* GltfJson::find_object(const Json& from, const std::string& at, const char* key) const {
    const Json* value = find(from, key);
    if (value && !value->is_object()) refuse_at(at + "/" + key, "must be a JSON object");
    return value;
}

const GltfJson::Json* GltfJson::find_array(const Json& from, const std::string& at, const char* key) const {
    const Json* value = find(from, key);
    if (value && !value->is_array()) refuse_at(at + "/" + key, "must be a JSON array");
    return value;
}

const GltfJson::Json* GltfJson::find_extension(const Json& from, const std::string& at, const char* name) const {
    const Json* all = find_object(from, at, "extensions");
    return all ? find_object(*all, at + "/extensions", name) : nullptr;
}

void GltfJson::each(const Json& from, const std::string& at, const char* key,
                    const std::function<void(const Json& object, const std::string& where)>& take) const {
    const Json* all = find_array(from, at, key);
    for (std::size_t i = 0; all && i < all->size(); ++i) {
        const std::string where = fmt::format("{}/{}/{}", at, key, i);
        if (!(*all)[i].is_object()) refuse_at(where, "must be a JSON object");
        take((*all)[i], where);
    }
}

const GltfJson::Json& GltfJson::object_of(const char* array, std::size_t number) const {
    const Json& object = root_.at(array).at(number);
    if (!object.is_object()) refuse_at(fmt::format("/{}/{}", array, number), "must be a JSON object");
    return object;
}

std::size_t GltfJson::count(const char* array) const {
    const Json* all = find_array(root_, "", array);
    return all ? all->size() : 0;
}

std::uint64_t GltfJson::as_size(const Json& value, const std::string& at) const {
    constexpr std::uint64_t largest = std::uint64_t{1} << 50;
    // Some programs write 3 as 3.0.
    const double given = value.is_number() ? value.get<double>() : -1.0;
    if (!(given >= 0.0 && given <= static_cast<double>(largest)) || given != std::floor(given))
        refuse_at(at, fmt::format("must be a whole number from 0 to {}", largest));
    return static_cast<std::uint64_t>(given);
}

std::uint64_t GltfJson::size(const Json& from, const std::string& at, const char* key, std::uint64_t absent) const {
    const Json* value = find(from, key);
    return value ? as_size(*value, at + "/" + key) : absent;
}

std::uint64_t GltfJson::needed_size(const Json& from, const std::string& at, const char* key) const {
    if (!find(from, key)) refuse_at(at, fmt::format("\"{}\" is missing", key));
    return size(from, at, key, 0);
}

std::size_t GltfJson::as_index(const Json& value, const std::string& at, const char* array) const {
    const std::uint64_t given = as_size(value, at);
    const std::size_t all = count(array);
    if (given >= all)
        refuse_at(at, fmt::format("names number {} of \"{}\", which has {}, counted from 0", given, array, all));
    return static_cast<std::size_t>(given);
}

std::optional<std::size_t> GltfJson::index(const Json& from, const std::string& at, const char* key,
                                           const char* array) const {
    const Json* value = find(from, key);
    if (!value) return std::nullopt;
    return as_index(*value, at + "/" + key, array);
}

std::size_t GltfJson::needed_index(const Json& from, const std::string& at, const char* key, const char* array) const {
    const std::optional<std::size_t> found = index(from, at, key, array);
    if (!found) refuse_at(at, fmt::format("\"{}\" is missing", key));
    return *found;
}

std::vector<std::size_t> GltfJson::indices(const Json& from, const std::string& at, const char* key,
                                           const char* array) const {
    std::vector<std::size_t> list;
    const Json* all = find_array(from, at, key);
    for (std::size_t i = 0; all && i < all->size(); ++i)
        list.push_back(as_index((*all)[i], fmt::format("{}/{}/{}", at, key, i), array));
    return list;
}

double GltfJson::as_number(const Json& value, const std::string& at) const {
    const double given = value.is_number() ? value.get<double>() : 2.0 * max_coordinate;
    if (!(std::abs(given) <= max_coordinate))
        refuse_at(at, fmt::format("must be a finite number below {}", max_coordinate));
    return given;
}

double GltfJson::number(const Json& from, const std::string& at, const char* key, double absent) const {
    const Json* value = find(from, key);
    return value ? as_number(*value, at + "/" + key) : absent;
}

std::vector<double> GltfJson::numbers(const Json& from, const std::string& at, const char* key,
                                      std::size_t expected) const {
    const Json* all = find_array(from, at, key);
    if (!all) return {};
    const std::string where = at + "/" + key;
    if (all->size() != expected) refuse_at(where, fmt::format("{} numbers; it needs {}", all->size(), expected));
    std::vector<double> list;
    for (const Json& value : *all) list.push_back(as_number(value, where));
    return list;
}

std::string GltfJson::text(const Json& from, const std::string& at, const char* key, const char* absent) const {
    const Json* value = find(from, key);
    if (!value) return absent;
    if (!value->is_string()) refuse_at(at + "/" + key, "must be a text");
    return value->get<std::string>();
}

bool GltfJson::flag(const Json& from, const std::string& at, const char* key) const {
    const Json* value = find(from, key);
    if (value && !value->is_boolean()) refuse_at(at + "/" + key, "must be true or false");
    return value && value->get<bool>();
}

}  // namespace shadowbench::scene
