#include "scene/read_mesh.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/files.h"
#include "scene/limits.h"

namespace shadowbench::scene {

Mesh read_mesh(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".obj") return read_obj(file);
    if (extension == ".ply") return read_ply(file);
    throw base::Error(base::ErrorCode::bad_input, file.string(), "mesh files end in .obj or .ply");
}

void add_fan(Mesh& mesh, const std::vector<int>& corners, const std::vector<Vec2f>& uv) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
        mesh.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
        if (!uv.empty())
            for (const std::size_t corner : {std::size_t{0}, i - 1, i}) mesh.corner_uv.push_back(uv[corner]);
    }
}

}  // namespace shadowbench::scene
