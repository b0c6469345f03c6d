// Reads values of the JSON document of a glTF file and checks their types and ranges. `at` is the JSON pointer of the
// object that holds the value. Every fault is Error{bad_input}, place "file: /accessors/3".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

class GltfJson {
public:
    using Json = nlohmann::json;

    // Both must live as long as this object.
    GltfJson(const std::filesystem::path& file, const Json& root) : file_(file), root_(root) {}

    const Json& root() const { return root_; }
    [[noreturn]] void refuse_at(const std::string& at, const std::string& message) const;

    // Null if they are absent.
    const Json* find(const Json& from, const char* key) const;
    const Json* find_object(const Json& from, const std::string& at, const char* key) const;
    const Json* find_array(const Json& from, const std::string& at, const char* key) const;
    const Json* find_extension(const Json& from, const std::string& at, const char* name) const;

    // Calls `take` with each object of an array, which may be absent, and its pointer.
    void each(const Json& from, const std::string& at, const char* key,
              const std::function<void(const Json& object, const std::string& where)>& take) const;

    // An object of an array at the top of the document.
    const Json& object_of(const char* array, std::size_t number) const;
    // The length of an array at the top of the document; 0 if it is absent.
    std::size_t count(const char* array) const;

    // Whole numbers up to 2^50.
    std::uint64_t size(const Json& from, const std::string& at, const char* key, std::uint64_t absent) const;
    std::uint64_t needed_size(const Json& from, const std::string& at, const char* key) const;

    // Numbers of elements of an array at the top of the document.
    std::size_t as_index(const Json& value, const std::string& at, const char* array) const;
    std::optional<std::size_t> index(const Json& from, const std::string& at, const char* key, const char* array) const;
    std::size_t needed_index(const Json& from, const std::string& at, const char* key, const char* array) const;
    std::vector<std::size_t> indices(const Json& from, const std::string& at, const char* key, const char* array) const;

    // Finite, and at most max_coordinate.
    double number(const Json& from, const std::string& at, const char* key, double absent) const;
    // As many as expected; none if they are absent.
    std::vector<double> numbers(const Json& from, const std::string& at, const char* key, std::size_t expected) const;

    std::string text(const Json& from, const std::string& at, const char* key, const char* absent) const;
    bool flag(const Json& from, const std::string& at, const char* key) const;  // false if it is absent

private:
    std::uint64_t as_size(const Json& value, const std::string& at) const;
    double as_number(const Json& value, const std::string& at) const;

    const std::filesystem::path& file_;
    const Json& root_;
};

}  // namespace shadowbench::scene
