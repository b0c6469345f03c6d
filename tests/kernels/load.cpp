// Loading: reads files that were written before, from the page cache into the engine's structures.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "kernels/folder.h"
#include "kernels/inputs.h"
#include "kernels/judged.h"
#include "kernels/kernel.h"
#include "scene/readers/files.h"
#include "scene/scenario.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/deep_file.h"

namespace shadowbench::kernels {
namespace {

namespace fs = std::filesystem;

// Reads the file's bytes at once, and uses one byte of each cache line.
std::function<unsigned()> file_floor(const fs::path& file) {
    const auto buffer = std::make_shared<std::vector<char>>(fs::file_size(file));
    std::vector<const void*> lines;
    append_lines(*buffer, lines);
    return [file, buffer, read = floor_of(std::move(lines))] {
        std::ifstream(file, std::ios::binary).read(buffer->data(), static_cast<std::streamsize>(buffer->size()));
        return read();
    };
}

Subject subject_of(const fs::path& file, std::size_t elements, std::function<void()> pass) {
    Subject subject;
    subject.exact.bytes = static_cast<double>(fs::file_size(file));
    subject.exact.nodes = static_cast<double>(elements);
    subject.vertices = *subject.exact.nodes;
    subject.pass = std::move(pass);
    subject.floor = file_floor(file);
    return subject;
}

fs::path write(const std::string& name, const std::string& bytes) {
    const fs::path file = scratch_folder() / name;
    std::ofstream stream(file, std::ios::binary);
    stream << bytes;
    check(static_cast<bool>(stream.flush()), file.string() + ": cannot write");
    return file;
}

template <class T>
void append(std::string& bytes, const T* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string obj_of(const scene::Mesh& mesh) {
    std::string text;
    for (const base::Vec3f& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const base::Vec3i& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t.x + 1, t.y + 1, t.z + 1);
    return text;
}

std::string ply_of(const scene::Mesh& mesh) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.size(), mesh.triangles.size());
    append(bytes, mesh.positions.data(), mesh.positions.size());
    for (const base::Vec3i& t : mesh.triangles) {
        bytes += '\3';
        append(bytes, &t, 1);
    }
    return bytes;
}

// See read_hair.cpp: segments, points and thickness, which is twice the radius.
std::string hair_of(const scene::Hair& hair) {
    std::string bytes = "HAIR";
    const std::uint32_t counts[] = {static_cast<std::uint32_t>(hair.strand_begin.size() - 1),
                                    static_cast<std::uint32_t>(hair.points.size()), 1 | 2 | 4, 0};
    append(bytes, counts, std::size(counts));
    bytes.resize(128, '\0');
    for (std::size_t s = 0; s + 1 < hair.strand_begin.size(); ++s) {
        const auto segments = static_cast<std::uint16_t>(hair.strand_begin[s + 1] - hair.strand_begin[s] - 1);
        append(bytes, &segments, 1);
    }
    append(bytes, hair.points.data(), hair.points.size());
    for (const float radius : hair.radii) {
        const float thickness = 2.0f * radius;
        append(bytes, &thickness, 1);
    }
    return bytes;
}

Subject load_mesh(const char* name, std::string (*write_mesh)(const scene::Mesh& mesh)) {
    const scene::Mesh mesh = make_mesh(48);
    const fs::path file = write(name, write_mesh(mesh));
    const scene::Mesh read = scene::read_mesh(file).mesh;
    check(read.positions == mesh.positions && read.triangles == mesh.triangles,
          "the mesh read differs from the one written");
    return subject_of(file, mesh.triangles.size(),
                      [file] { benchmark::DoNotOptimize(scene::read_mesh(file).mesh.triangles.data()); });
}

Subject load_hair() {
    const scene::Hair hair = make_hair();
    const fs::path file = write("hair.hair", hair_of(hair));
    const scene::Hair read = scene::read_hair(file, 0.0f);
    check(read.points == hair.points && read.radii == hair.radii && read.strand_begin == hair.strand_begin,
          "the hair read differs from the one written");
    return subject_of(file, hair.points.size(),
                      [file] { benchmark::DoNotOptimize(scene::read_hair(file, 0.0f).points.data()); });
}

// A scenario with an inline mesh, a mesh file and a procedural object.
Subject load_scenario() {
    const scene::Mesh mesh = make_mesh(16);
    const fs::path obj = write("scenario_mesh.obj", obj_of(mesh));
    nlohmann::json positions = nlohmann::json::array(), triangles = nlohmann::json::array();
    for (const base::Vec3f& p : mesh.positions) positions.push_back({p.x, p.y, p.z});
    for (const base::Vec3i& t : mesh.triangles) triangles.push_back({t.x, t.y, t.z});
    const nlohmann::json document = {{"name", "kernel"},
                                     {"scene",
                                      {{"objects",
                                        {{{"type", "mesh"}, {"vertices", positions}, {"triangles", triangles}},
                                         {{"type", "mesh"}, {"file", obj.filename().string()}},
                                         {{"type", "hair_ball"}, {"strands", 200}, {"segments", 8}}}}}},
                                     {"lights", {{{"type", "directional"}, {"direction", {0, -1, 0}}}}},
                                     {"techniques", {{{"type", "deep"}}}}};
    const fs::path file = write("scenario.json", document.dump());
    const auto load = [file] {
        const std::string text = base::read_text(file);
        return scene::load_scenario(scene::parse_json(text, file.string()), {file.parent_path()});
    };
    const scene::Scenario scenario = load();
    check(scenario.scene.objects.size() == 3, "the scenario does not have three objects");
    for (const int object : {0, 1}) {
        const auto& read = std::get<scene::Mesh>(scenario.scene.objects[static_cast<std::size_t>(object)].shape);
        check(read.positions == mesh.positions && read.triangles == mesh.triangles,
              "a mesh read differs from the one written");
    }
    return subject_of(file, 2 * mesh.triangles.size(), [load] { benchmark::DoNotOptimize(load().lights.data()); });
}

bool equal(const techniques::DeepLevel& a, const techniques::DeepLevel& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels && a.offsets == b.offsets &&
           a.floats == b.floats;
}

Subject load_deep(int map) {
    const Judged judged({&techniques::find("deep", ""), {}, {}, map, 16});
    const auto levels = techniques::levels(*judged.maps().parts[0]);
    const fs::path file = scratch_folder() / fmt::format("map{}.dsm", map);
    techniques::write_deep_file(file, levels, 16, {});
    const auto read = [file] { return techniques::read_levels(techniques::DeepFile(file)); };
    const std::vector<techniques::DeepLevel> back = read();
    check(std::equal(back.begin(), back.end(), levels.begin(), levels.end(), equal),
          "the map read differs from the one written");
    Subject subject = subject_of(file, static_cast<std::size_t>(judged.exact().nodes.value()),
                                 [read] { benchmark::DoNotOptimize(read().data()); });
    subject.exact.error = judged.exact().error;
    return subject;
}

}  // namespace

void add_load_kernels(Kernels& kernels) {
    kernels.push_back({"load/obj", [] { return load_mesh("mesh.obj", obj_of); }});
    kernels.push_back({"load/ply", [] { return load_mesh("mesh.ply", ply_of); }});
    kernels.push_back({"load/hair", load_hair});
    kernels.push_back({"load/scenario", load_scenario});
    for (const int map : {32, 64})
        kernels.push_back({fmt::format("load/deep_file/map:{}", map), [=] { return load_deep(map); }});
}

}  // namespace shadowbench::kernels
