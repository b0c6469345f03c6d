#include "service/api/new_files.h"

#include <fstream>
#include <string>

#include "api/fixture.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

// A triangle above the origin.
void write_mesh(const fs::path& file) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "v 0 1 0\nv 1 1 0\nv 0 1 1\nf 1 2 3\n";
}

std::string asking(const std::string& files, const std::string& up = "") {
    return R"({"files": [)" + files + "]" + (up.empty() ? "" : R"(, "up": ")" + up + "\"") + "}";
}

TEST(DataFiles, AreThoseThatNewReadsByNameAndInsideTheFolders) {
    const TemporaryFolder temporary;
    const fs::path &top = temporary.path(), data = top / "data", second = top / "second";
    for (const char* name : {"b.obj", "deep/A.PLY", "deep/notes.md", "deep/.hidden.json", "deep/LICENSE.data.txt"})
        write_mesh(data / name);
    write_mesh(top / "outside.obj");
    write_mesh(second / "b.obj");
    write_mesh(second / "bad\xff.obj");
    fs::create_symlink(top / "outside.obj", data / "link.obj");
    fs::create_directory_symlink(top, data / "loop");
    fs::create_symlink(data / "b.obj", data / "inside.obj");
    const DataFiles found = data_files({data, top / "missing", second}, 10);
    ASSERT_EQ(found.files.size(), 3u) << "no link leads out, and a name means one file";
    EXPECT_EQ(found.files[0].name, "b.obj");
    EXPECT_EQ(found.files[0].bytes, fs::file_size(data / "b.obj"));
    EXPECT_EQ(found.files[1].name, "deep/A.PLY");
    EXPECT_EQ(found.files[2].name, "inside.obj");
    EXPECT_FALSE(found.more);
    EXPECT_EQ(data_files({data, second}, 2).files.size(), 2u);
    EXPECT_TRUE(data_files({data, second}, 2).more);
}

// Else the results of all jobs would be listed as data, and the data behind some thousand jobs not at all.
TEST(DataFiles, LeaveTheStateOfTheServerOut) {
    const TemporaryFolder temporary;
    const fs::path data = temporary.path() / "data", state = data / "state";
    write_mesh(data / "a.obj");
    write_mesh(state / "jobs" / "j-1" / "images" / "b.obj");
    write_mesh(data / "states" / "c.obj");
    fs::create_directory_symlink(state, temporary.path() / "link");
    EXPECT_EQ(data_files({data}, 10).files.size(), 3u) << "where no folder is apart";
    for (const fs::path& name : {state, state / "", data / ".." / "data" / "state", temporary.path() / "link"}) {
        const DataFiles found = data_files({data}, 10, name);
        ASSERT_EQ(found.files.size(), 2u) << name;
        EXPECT_EQ(found.files[0].name, "a.obj");
        EXPECT_EQ(found.files[1].name, "states/c.obj");
    }
    EXPECT_EQ(data_files({data}, 10, data / "not yet").files.size(), 3u);
}

class NewApi : public ApiTest {};

TEST_F(NewApi, ListsFilesAndMakesAScenarioAroundThem) {
    write_mesh(folder_ / "data" / "meshes" / "tri.obj");
    const nlohmann::json list = json(request("GET", "/v1/files"), 200);
    ASSERT_EQ(list["files"].size(), 1u);
    EXPECT_EQ(list["files"][0]["name"], "meshes/tri.obj");
    const ApiResponse made = answer(post("/v1/new", asking("\"meshes/tri.obj\"")));
    ASSERT_EQ(made.status, 200);
    EXPECT_LT(made.body.find("\"name\""), made.body.find("\"scene\"")) << "in the order that people write";
    const nlohmann::json scenario = nlohmann::json::parse(made.body);
    EXPECT_EQ(scenario["scene"]["objects"][0]["file"], "meshes/tri.obj") << "as the scenario finds it";
    const nlohmann::json facts = json(post("/v1/validate", scenario.dump()), 200);
    EXPECT_GT(facts["techniques"], 2) << "it runs as it is";
    const auto z = nlohmann::json::parse(answer(post("/v1/new", asking("\"meshes/tri.obj\"", "z"))).body);
    EXPECT_NE(z["lights"], scenario["lights"]) << "z is up";
}

TEST_F(NewApi, SaysWhatIsWrongWithARequestOrAFile) {
    std::ofstream(folder_ / "data" / "torn.vdb") << "no grid";
    write_mesh(folder_ / "secret.obj");
    refused(post("/v1/new", "{"), 400, "");
    EXPECT_EQ(refused(post("/v1/new", "[]"), 422, "must be an object")["errors"][0]["pointer"], "");
    EXPECT_EQ(refused(post("/v1/new", asking("")), 422, "1 to 16 names")["errors"][0]["pointer"], "/files");
    EXPECT_EQ(refused(post("/v1/new", asking("1")), 422, "must be a name")["errors"][0]["pointer"], "/files/0");
    EXPECT_EQ(refused(post("/v1/new", asking("\"a.obj\"", "x")), 422, "\"y\" or \"z\"")["errors"][0]["pointer"], "/up");
    EXPECT_EQ(
        refused(post("/v1/new", R"({"files": ["a.obj"], "out": "x"})"), 422, "unknown key")["errors"][0]["pointer"],
        "/out");
    for (const char* name : {"\"../secret.obj\"", "\"/etc/passwd\"", "\"none.obj\""})
        EXPECT_EQ(refused(post("/v1/new", asking(name)), 422, "")["errors"][0]["pointer"], "/files/0") << name;
    const nlohmann::json torn = refused(post("/v1/new", asking("\"torn.vdb\"")), 422, "torn.vdb");
    EXPECT_EQ(torn.dump().find(folder_.string()), std::string::npos) << "no folder of the server";
}

}  // namespace
}  // namespace shadowbench::service
