// Writes glTF files for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/scene.h"
#include "scene/support.h"

namespace shadowbench::scene::test {

// Each function that adds something returns its number.
class GltfMaker {
public:
    using Json = nlohmann::json;

    Json document = {{"asset", {{"version", "2.0"}}}};
    std::string bytes;  // of the only buffer

    int push(const char* array, const Json& each) {
        document[array].push_back(each);
        return static_cast<int>(document[array].size()) - 1;
    }

    int view(const std::string& content, const Json& more = Json::object()) {
        Json added = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", content.size()}};
        added.update(more);
        bytes += content;
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        return push("bufferViews", added);
    }

    int accessor(int view_number, int component, std::size_t count, const char* type,
                 const Json& more = Json::object()) {
        Json added = {{"componentType", component}, {"count", count}, {"type", type}};
        if (view_number >= 0) added["bufferView"] = view_number;
        added.update(more);
        return push("accessors", added);
    }

    int points(const std::vector<Vec3f>& list) {
        std::string content;
        for (const Vec3f& at : list) content += bytes_of(at.x, at.y, at.z);
        return accessor(view(content), 5126, list.size(), "VEC3");
    }

    int uvs(const std::vector<Vec2f>& list) {
        std::string content;
        for (const Vec2f& at : list) content += bytes_of(at.x, at.y);
        return accessor(view(content), 5126, list.size(), "VEC2");
    }

    template <typename Index>
    int indices(const std::vector<Index>& list) {
        std::string content;
        for (const Index index : list) content += bytes_of(index);
        return accessor(view(content),
                        sizeof(Index) == 1   ? 5121
                        : sizeof(Index) == 2 ? 5123
                                             : 5125,
                        list.size(), "SCALAR");
    }

    // A mesh of one primitive, at a node.
    int mesh(const Json& primitive) {
        Json primitives = Json::array();
        primitives.push_back(primitive);
        const int number = push("meshes", Json{{"primitives", primitives}});
        push("nodes", Json{{"mesh", number}});
        return number;
    }

    // The document with a buffer in a file, or in the binary chunk.
    std::string text(const std::string& uri) const {
        Json whole = document;
        if (!bytes.empty()) {
            Json buffer{{"byteLength", bytes.size()}};
            if (!uri.empty()) buffer["uri"] = uri;
            whole["buffers"] = Json::array();
            whole["buffers"].push_back(buffer);
        }
        return whole.dump();
    }

    std::string glb() const {
        std::string start = text("");
        start.resize((start.size() + 3) / 4 * 4, ' ');
        const auto size = [](const std::string& part) { return static_cast<std::uint32_t>(part.size()); };
        std::string chunks = bytes_of(size(start), std::uint32_t{0x4e4f534a}) + start;
        if (!bytes.empty()) chunks += bytes_of(size(bytes), std::uint32_t{0x004e4942}) + bytes;
        return "glTF" + bytes_of(std::uint32_t{2}, size(chunks) + 12) + chunks;
    }
};

}  // namespace shadowbench::scene::test
