// The layers of the engine, read off the include lines of its sources.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
    std::string file;  // from the top of the sources, as engine/rays/capture.cpp
    std::string path;  // as written
    bool system;       // in angle brackets
};

// The name in an include line, and whether it stands in angle brackets; nothing of other lines.
bool parse_include(std::string line, std::string& path, bool& system) {
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t'; });
    const std::string start = "#include";
    if (line.rfind(start, 0) != 0 || line.size() < start.size() + 2) return false;
    const char open = line[start.size()];
    const std::size_t end = line.find(open == '<' ? '>' : '"', start.size() + 1);
    if ((open != '<' && open != '"') || end == std::string::npos) return false;
    path = line.substr(start.size() + 1, end - start.size() - 1);
    system = open == '<';
    return true;
}

std::vector<Include> read_includes() {
    std::vector<Include> result;
    const fs::path top = SHADOWBENCH_SOURCE_DIR;
    for (const char* folder : {"engine", "service"})
        for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            std::ifstream in(entry.path());
            Include include{fs::relative(entry.path(), top).generic_string(), {}, false};
            for (std::string line; std::getline(in, line);)
                if (parse_include(line, include.path, include.system)) result.push_back(include);
        }
    return result;
}

const std::vector<Include>& includes() {
    static const std::vector<Include> all = read_includes();
    return all;
}

bool starts_with(const std::string& text, const std::string& start) {
    return text.rfind(start, 0) == 0;
}

// "engine/techniques/deep/deep.cpp" -> "techniques/deep"; "engine/rays/capture.cpp" -> "rays"; "service/cli/cli.cpp" ->
// "service/cli", as includes name it. Files directly in engine/techniques are the contract ("techniques"), except the
// registry.
std::string layer_of_file(const std::string& file) {
    if (file == "engine/techniques/registry.cpp") return "registry";
    fs::path path = file;
    std::vector<std::string> parts;
    for (const auto& part : path.parent_path()) parts.push_back(part.string());
    if (parts[0] == "service") return parts.size() > 1 ? "service/" + parts[1] : "service";
    return parts.size() > 2 ? parts[1] + "/" + parts[2] : parts[1];
}

std::string layer_of_include(const std::string& path) {
    const fs::path parent = fs::path(path).parent_path();
    return parent.generic_string();
}

TEST(Layers, TheSourcesAreFound) {
    EXPECT_GT(includes().size(), 200u);
}

TEST(Layers, EachLayerIncludesOnlyThoseBelowIt) {
    const std::map<std::string, std::set<std::string>> allowed = {
        {"base", {"base"}},
        {"scene", {"base", "scene", "scene/readers"}},
        {"scene/readers", {"base", "scene", "scene/readers", "scene/polygon"}},
        {"scene/polygon", {"base", "scene", "scene/polygon"}},
        {"rays", {"base", "scene", "rays"}},
        {"curves", {"base", "rays", "curves"}},
        {"techniques", {"base", "rays", "curves", "techniques"}},
        {"techniques/store", {"base", "rays", "curves", "techniques", "techniques/store"}},
        {"metrics", {"base", "metrics"}},
        {"document", {"base", "scene", "techniques", "document"}},
        {"results", {"base", "document", "metrics", "results"}},
        {"compare", {"base", "document", "metrics", "results", "compare"}},
        {"bench", {"base", "scene", "rays", "curves", "techniques", "metrics", "document", "results", "bench"}},
        {"recommend", {"base", "scene", "rays", "techniques", "metrics", "document", "results", "bench", "recommend"}},
        {"render",
         {"base", "scene", "rays", "curves", "techniques", "metrics", "document", "results", "bench", "render"}},
        // The claims also measure the levels and tiles of deep shadow maps by themselves.
        {"claims",
         {"base", "scene", "rays", "curves", "techniques", "techniques/deep", "metrics", "document", "results", "bench",
          "render", "claims"}},
        {"service/log", {"service/log"}},
        {"service/privacy", {"base", "service/privacy"}},
        {"service/process", {"base", "service/process"}},
        {"service/isolation",
         {"base", "rays", "curves", "techniques", "techniques/external", "service/process", "service/isolation"}},
        {"service/store", {"base", "service/store"}},
        {"service/jobs",
         {"base", "bench", "results", "service/log", "service/privacy", "service/process", "service/store",
          "service/jobs"}},
        {"service/web", {"base", "service/web"}},
        {"service/api",
         {"base", "scene", "techniques", "document", "results", "bench", "recommend", "render", "compare",
          "service/log", "service/privacy", "service/process", "service/jobs", "service/web", "service/api"}},
        {"service/http", {"base", "service/log", "service/api", "service/http"}},
        // The command line also reads and writes deep shadow map files, and loads techniques from outside.
        {"service/cli", {"base",
                         "scene",
                         "curves",
                         "techniques",
                         "techniques/deep",
                         "techniques/external",
                         "document",
                         "results",
                         "compare",
                         "bench",
                         "recommend",
                         "render",
                         "claims",
                         "service/log",
                         "service/privacy",
                         "service/process",
                         "service/isolation",
                         "service/jobs",
                         "service/api",
                         "service/http",
                         "service/web",
                         "service/cli"}},
        // The library that reads and writes images holds their readers.
        {"service/images", {"base", "scene", "scene/readers", "render", "results", "service/images"}},
        {"service", {"service/cli", "service/images"}},
    };
    for (const Include& include : includes()) {
        if (include.system) continue;
        const std::string from = layer_of_file(include.file);
        const std::string to = layer_of_include(include.path);
        if (from == "registry") {
            EXPECT_TRUE(to == "base" || starts_with(to, "techniques")) << include.file << " includes " << include.path;
        } else if (starts_with(from, "techniques/") && from != "techniques/store") {
            // A technique sees light rays, so it cannot cheat: no scene, no metrics, no other technique.
            const std::set<std::string> own = {"base", "rays", "curves", "techniques", "techniques/store", from};
            EXPECT_TRUE(own.count(to)) << include.file << " includes " << include.path;
        } else {
            ASSERT_TRUE(allowed.count(from)) << "a layer without rules: " << include.file;
            EXPECT_TRUE(allowed.at(from).count(to)) << include.file << " includes " << include.path;
        }
    }
}

// Two classes of one name and namespace link without a word, and the linker keeps one of each inline function that they
// share, as their constructors: the other class is then made by the wrong one.
TEST(Layers, HeadersOfANamespaceGiveEachNameToOneClass) {
    const fs::path top = SHADOWBENCH_SOURCE_DIR;
    std::map<std::string, std::string> headers;  // by the name of the class
    for (const char* folder : {"engine", "service"})
        for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
            if (entry.path().extension() != ".h") continue;
            const std::string file = fs::relative(entry.path(), top).generic_string();
            std::ifstream in(entry.path());
            std::string space;
            for (std::string line; std::getline(in, line);) {
                std::istringstream words(line);
                std::string word, name;
                words >> word >> name;
                if (word == "enum" && name == "class") words >> name;
                if (word == "namespace") space = name;
                // Those at the start of a line; a declaration ends in a semicolon.
                if (line[0] != word[0] || (word != "struct" && word != "class" && word != "enum") || name.empty() ||
                    name.back() == ';')
                    continue;
                const auto [first, is_new] = headers.try_emplace(space + "::" + name, file);
                EXPECT_TRUE(is_new || first->second == file)
                    << file << " and " << first->second << " have a class " << first->first;
            }
        }
    EXPECT_GT(headers.size(), 300u);
}

// Readers fill in the plain structs of a scene; how scenarios are read and checked is nothing to them. JSON is a format
// of data, too, and data files name others that lie beside them.
TEST(Layers, ReadersKnowOnlyTheStructsOfAScene) {
    const std::set<std::string> structs = {"scene/scene.h", "scene/limits.h", "scene/read_notes.h",
                                           "scene/parse_json.h", "scene/beside.h"};
    for (const Include& include : includes())
        if (starts_with(layer_of_file(include.file), "scene/") && layer_of_include(include.path) == "scene") {
            EXPECT_TRUE(structs.count(include.path)) << include.file << " includes " << include.path;
        }
}

// results/ uses the plain struct of document/setting.h, and nothing that is compiled there.
TEST(Layers, ResultsKnowOnlySettingsOfDocuments) {
    for (const Include& include : includes())
        if (layer_of_file(include.file) == "results" && starts_with(include.path, "document/")) {
            EXPECT_EQ(include.path, "document/setting.h") << include.file;
        }
}

TEST(Layers, OnlyTheHttpFrontKnowsSockets) {
    for (const Include& include : includes())
        if (include.path.find("httplib") != std::string::npos) {
            EXPECT_TRUE(starts_with(include.file, "service/http")) << include.file;
        }
}

TEST(Layers, TheApiHasNoSockets) {
    for (const Include& include : includes()) {
        if (!include.system || !starts_with(include.file, "service/api")) continue;
        for (const char* header : {"sys/socket.h", "netinet/", "arpa/", "netdb.h"})
            EXPECT_FALSE(starts_with(include.path, header)) << include.file << " includes " << include.path;
    }
}

// One set of rules for all children: service/process/child_process.h.
TEST(Layers, OnlyTheProcessLayerStartsAndAwaitsProcesses) {
    for (const Include& include : includes())
        for (const char* header : {"sys/wait.h", "spawn.h"})
            if (include.path == header) {
                EXPECT_TRUE(starts_with(include.file, "service/process")) << include.file << " includes " << header;
            }
}

TEST(Layers, OnlyTheStoreKnowsTheDatabase) {
    for (const Include& include : includes())
        if (include.path.find("sqlite") != std::string::npos || include.path == "service/store/database.h") {
            EXPECT_TRUE(starts_with(include.file, "service/store")) << include.file;
        }
}

TEST(Layers, HeavyLibrariesStayOutOfHeaders) {
    for (const Include& include : includes()) {
        if (!include.file.ends_with(".h") || !include.system) continue;
        if (include.file == "engine/scene/readers/read_image.h")
            continue;  // what the two readers of images share, and nobody else
        for (const char* heavy : {"nlohmann/json.hpp", "valijson", "CLI/", "openvdb", "OpenImageIO", "embree", "fmt/",
                                  "tbb/", "sqlite3", "httplib", "prometheus/", "spdlog/"})
            EXPECT_EQ(include.path.find(heavy), std::string::npos) << include.file << " includes " << include.path;
    }
}

TEST(Layers, TheSlowestHeadersAreCompiledOnce) {
    std::map<std::string, std::set<std::string>> users;
    for (const Include& include : includes())
        for (const char* heavy : {"valijson", "openvdb", "tiny_obj_loader", "httplib", "sqlite3"})
            if (include.system && starts_with(include.path, heavy)) users[heavy].insert(include.file);
    for (const auto& [library, files] : users)
        EXPECT_EQ(files.size(), 1u) << library << " is included by " << *files.begin();
    for (const Include& include : includes())
        if (include.system && starts_with(include.path, "CLI/")) {
            EXPECT_TRUE(include.file == "service/cli/cli.cpp" || starts_with(include.file, "service/cli/options"))
                << include.file;
        }
}

}  // namespace
