#include "scene/support.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "temporary_folder.h"

namespace shadowbench::scene::test {

namespace fs = std::filesystem;

fs::path fresh_path(const std::string& name) {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    static const TemporaryFolder all;
    const fs::path folder = all.path() / (std::string(info->test_suite_name()) + "." + info->name());
    fs::create_directories(folder);
    fs::remove(folder / name);
    return folder / name;
}

fs::path write_file(const std::string& name, const std::string& bytes) {
    const fs::path file = fresh_path(name);
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

std::string read_bytes(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

fs::path data_file(const std::string& name) {
    const char* folder = std::getenv("SHADOWBENCH_DATA");
    for (const fs::path& base : {fs::path(folder ? folder : ""), fs::path(SHADOWBENCH_SOURCE_DIR) / "../shared/data"})
        if (!base.empty() && fs::exists(base / name)) return base / name;
    return {};
}

double area(const Mesh& mesh) {
    double sum = 0.0;
    const auto at = [&](int index) { return Vec3d(mesh.positions.at(static_cast<std::size_t>(index))); };
    for (const Vec3i& t : mesh.triangles) sum += (at(t.y) - at(t.x)).cross(at(t.z) - at(t.x)).length() / 2.0;
    return sum;
}

base::Error error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const base::Error& error) {
        return error;
    } catch (const std::exception& error) {
        ADD_FAILURE() << "not an Error: " << error.what();
        return base::Error(base::ErrorCode::internal, "", "");
    }
    ADD_FAILURE() << "no Error was thrown";
    return base::Error(base::ErrorCode::internal, "", "");
}

void expect_cuts_refused(const std::string& bytes, const std::string& name, std::size_t least,
                         const std::function<void(const fs::path&)>& read) {
    constexpr std::size_t most_cuts = 200;
    const std::size_t stride = std::max<std::size_t>(1, least / most_cuts);
    for (std::size_t length = 0; length < least; length += stride) {
        const fs::path file = write_file(name, bytes.substr(0, length));
        const base::Error error = error_of([&] { read(file); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << "cut at " << length;
        EXPECT_TRUE(error.where().starts_with(file.string())) << error.what();
    }
}

void expect_changes_survived(const std::string& bytes, const std::string& name,
                             const std::function<GridVolume(const fs::path&)>& read) {
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const int change : {0x01, 0x08, 0x10, 0x80, 0xff}) {
            std::string changed = bytes;
            changed[i] = static_cast<char>(changed[i] ^ change);
            const fs::path file = write_file(name, changed);
            try {
                const GridVolume volume = read(file);
                const Vec3i size = volume.size;
                EXPECT_EQ(volume.density.size(), static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                                                     static_cast<std::size_t>(size.z));
                for (const float density : volume.density)
                    EXPECT_TRUE(density >= 0.0f && density <= 1.0f) << density << ", byte " << i;
            } catch (const base::Error& error) {
                EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << error.what() << ", byte " << i;
            }
        }
}

}  // namespace shadowbench::scene::test
