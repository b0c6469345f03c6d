#include "techniques/deep/deep_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "base/read_text.h"
#include "techniques/deep_levels.h"
#include "techniques/live_bytes.h"

namespace shadowbench::techniques {
namespace {

using testing::curve_of;
using ::testing::HasSubstr;
using testing::random_levels;
using ::testing::StartsWith;
using testing::TestFile;
using testing::write_bytes;

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void expect_same(const std::vector<DeepLevel>& read, const std::vector<DeepLevel>& written) {
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].width, written[i].width);
        EXPECT_EQ(read[i].height, written[i].height);
        EXPECT_EQ(read[i].channels, written[i].channels);
        EXPECT_EQ(read[i].offsets, written[i].offsets);
        EXPECT_EQ(read[i].coloured, written[i].coloured);
        EXPECT_TRUE(same_bits(read[i].floats, written[i].floats));
    }
}

// The error of reading every tile of the file; an internal error if there is none.
base::Error fault(const std::filesystem::path& file) {
    try {
        read_levels(DeepFile(file));
    } catch (const base::Error& error) {
        return error;
    }
    return {base::ErrorCode::internal, "", "no error"};
}

// Expects bad input with the file and an offset inside it (or at its end) as place, and this text in the message.
void expect_refused(const std::filesystem::path& file, std::size_t length, const char* says = "") {
    const base::Error error = fault(file);
    ASSERT_EQ(error.code(), base::ErrorCode::bad_input) << error.what();
    EXPECT_THAT(error.message(), HasSubstr(says));
    ASSERT_THAT(error.where(), StartsWith(file.string() + ": byte "));
    EXPECT_LE(std::stoull(error.where().substr(file.string().size() + 7)), length) << error.what();
}

// Sets 32 bits of a file.
void poke(std::string& bytes, std::size_t offset, std::uint32_t value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
}
std::uint32_t peek(const std::string& bytes, std::size_t offset) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}
std::uint32_t crc(const std::string& bytes, std::size_t first, std::size_t count) {
    return static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + first), static_cast<uInt>(count)));
}

struct Shape {
    int width, height, tile;
};

TEST(DeepFile, BringsEveryLevelBackToTheBit) {
    const TestFile file;
    std::uint64_t seed = 1;
    for (const Shape shape : {Shape{1, 1, 1},
                              {1, 1, 64},
                              {7, 5, 3},
                              {16, 16, 16},
                              {16, 16, 4},
                              {33, 1, 8},
                              {1, 70, 16},
                              {65, 43, 32},
                              {64, 64, 1}})
        for (const int channels : {1, 3})
            for (const int count : {1, 99}) {
                const auto levels = random_levels(shape.width, shape.height, channels, seed++, count);
                write_deep_file(file.path, levels, shape.tile, {});
                expect_same(read_levels(DeepFile(file.path)), levels);
            }
}

// A search among depths that are out of order, or a NaN, would leave [0, 1] in some lookup.
TEST(DeepFile, RefusesNodesThatAreNoVisibility) {
    const TestFile file;
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> right = {1, 2, 2, 1, 0.5f, 0};
    std::vector<DeepLevel> levels = {{1, 1, 1, {0, 6}, right, {}}};
    levels[0].floats.resize(6 + DeepLevel::padding);
    write_deep_file(file.path, levels, 16, {});
    expect_same(read_levels(DeepFile(file.path)), levels);
    const std::string bytes = base::read_text(file.path);
    constexpr std::size_t directory = 64, tile = directory + 16 + 4;
    // Behind a checksum that is right. `index` is the float's position.
    const auto write = [&](std::size_t index, float value) {
        std::string changed = bytes;
        const std::size_t place = changed.size() - (6 - index) * sizeof(float);
        poke(changed, place, std::bit_cast<std::uint32_t>(value));
        poke(changed, directory + 12, crc(changed, tile, peek(changed, directory + 8) * 4));
        poke(changed, directory + 16, crc(changed, directory, 16));
        write_bytes(file.path, changed);
        return place;
    };
    for (const auto& [index, value] : {std::pair<std::size_t, float>{0, nan},
                                       {0, -infinity},
                                       {1, nan},
                                       {1, 0.5f},
                                       {2, infinity},
                                       {3, nan},
                                       {3, 1.5f},
                                       {4, infinity},
                                       {5, -0.25f}}) {
        const std::uint64_t place = write(index, value);
        const base::Error error = fault(file.path);
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << index << " " << value;
        EXPECT_EQ(error.where(), file.path.string() + ": byte " + std::to_string(place));
    }
}

// Published compression may leave such values. Files without them stay as readers of version 1 know them.
TEST(DeepFile, ValuesOutsideTheUnitRangeMakeAFileOfVersion2) {
    const TestFile file;
    for (const float value : {0.0f, 1.0f, -1e-6f, 1.0f + 1e-6f, -2.0f, 3.0f}) {
        std::vector<DeepLevel> levels = {{1, 1, 1, {0, 4}, {1, 2, 1, value}, {}}};
        levels[0].floats.resize(4 + DeepLevel::padding);
        write_deep_file(file.path, levels, 16, {});
        const bool inside = value >= 0.0f && value <= 1.0f;
        EXPECT_EQ(DeepFile(file.path).unit_range(), inside) << value;
        EXPECT_EQ(base::read_text(file.path)[12], inside ? 1 : 2) << value;
        expect_same(read_levels(DeepFile(file.path)), levels);
        if (inside) continue;
        std::string changed = base::read_text(file.path);  // says that it is of version 1
        poke(changed, 12, 1);
        poke(changed, 60, crc(changed, 0, 60));
        write_bytes(file.path, changed);
        expect_refused(file.path, changed.size(), "not in [0, 1]");
    }
}

// Nothing is written, rather than a file that nobody can read.
TEST(DeepFile, ValuesThatNoCompressionLeavesAreNotWritten) {
    const TestFile file;
    for (const float value :
         {-2.001f, 3.001f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        std::vector<DeepLevel> levels = {{1, 1, 1, {0, 4}, {1, 2, 1, value}, {}}};
        levels[0].floats.resize(4 + DeepLevel::padding);
        try {
            write_deep_file(file.path, levels, 16, {});
            ADD_FAILURE() << value << " was written";
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
            EXPECT_THAT(error.message(), HasSubstr("pixel 0"));
        }
        EXPECT_FALSE(std::filesystem::exists(file.path));
    }
}

TEST(DeepFile, RefusesNotesThatAreNotFinite) {
    const TestFile file;
    const auto levels = random_levels(2, 2, 1, 3);
    for (const DeepFileNotes& notes : {DeepFileNotes{std::numeric_limits<float>::quiet_NaN(), 0, 1, ""},
                                       DeepFileNotes{0, -std::numeric_limits<float>::infinity(), 1, ""}}) {
        write_deep_file(file.path, levels, 2, notes);
        expect_refused(file.path, 64, "tolerance or depth");
    }
}

TEST(DeepFile, HoldsItsDescription) {
    const TestFile file;
    const auto levels = random_levels(20, 9, 3, 1);
    write_deep_file(file.path, levels, 8, {0.25f, -3.5f, 1e9f, "hair, light key"});
    const DeepFile read(file.path);
    EXPECT_EQ(read.notes().tolerance, 0.25f);
    EXPECT_EQ(read.notes().z_min, -3.5f);
    EXPECT_EQ(read.notes().z_max, 1e9f);
    EXPECT_EQ(read.notes().text, "hair, light key");
    EXPECT_EQ(read.channels(), 3);
    EXPECT_EQ(read.tile_size(), 8);
    EXPECT_EQ(read.file_bytes(), std::filesystem::file_size(file.path));
    ASSERT_EQ(read.levels().size(), 6u);
    EXPECT_EQ(read.levels()[1].width, 10);
    EXPECT_EQ(read.levels()[1].height, 5);
    EXPECT_EQ(read.levels()[1].first, 6u);
    EXPECT_EQ(read.tiles(), 6u + 2 + 1 + 1 + 1 + 1);
    EXPECT_EQ(read.tile_pixels(5), 4u) << "the last column and row of tiles are smaller";
}

TEST(DeepFile, HoldsColourBitsForColouredMapsAlone) {
    const TestFile file;
    std::vector<DeepLevel> levels = random_levels(16, 16, 1, 5, 1);
    write_deep_file(file.path, levels, 16, {});
    const auto plain = std::filesystem::file_size(file.path);
    EXPECT_EQ(plain, 64u + 16 + 4 + 4 * (257 + levels[0].floats.size() - DeepLevel::padding));
    levels[0].channels = 3;  // every pixel monochrome
    write_deep_file(file.path, levels, 16, {});
    EXPECT_EQ(std::filesystem::file_size(file.path), plain + 256 / 8);
    EXPECT_EQ(read_levels(DeepFile(file.path))[0].coloured, (std::vector<std::uint64_t>(4, 0)));
}

TEST(DeepFile, SeesEveryByteThatIsFlipped) {
    const TestFile file;
    write_deep_file(file.path, random_levels(5, 3, 3, 3), 2, {0.1f, 0, 1, "text"});
    const std::string bytes = base::read_text(file.path);
    ASSERT_LT(bytes.size(), 4000u);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::string damaged = bytes;
            damaged[i] = static_cast<char>(damaged[i] ^ flip);
            write_bytes(file.path, damaged);
            expect_refused(file.path, bytes.size());
            ASSERT_FALSE(HasFailure()) << "byte " << i;
        }
}

TEST(DeepFile, SeesDamageAnywhereInALargeFile) {
    const TestFile file;
    write_deep_file(file.path, random_levels(120, 90, 1, 3), 16, {});
    const std::string bytes = base::read_text(file.path);
    ASSERT_GT(bytes.size(), 300'000u);
    base::Random random(8);
    for (int i = 0; i < 200; ++i) {
        std::string damaged = bytes;
        const std::size_t at = random.below(bytes.size());
        damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(1 + random.below(255)));
        write_bytes(file.path, damaged);
        expect_refused(file.path, bytes.size());
        ASSERT_FALSE(HasFailure()) << "byte " << at;
    }
}

TEST(DeepFile, SeesAFileCutAnywhereOrMadeLonger) {
    const TestFile file;
    write_deep_file(file.path, random_levels(5, 3, 3, 3), 2, {0.1f, 0, 1, "text"});
    const std::string bytes = base::read_text(file.path);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        write_bytes(file.path, bytes.substr(0, length));
        expect_refused(file.path, length);
        ASSERT_FALSE(HasFailure()) << "length " << length;
    }
    write_bytes(file.path, bytes + '\0');
    expect_refused(file.path, bytes.size() + 1, "appended");
}

// The file is mapped into memory, where a read behind its end would end the program.
TEST(DeepFile, SaysThatAnOpenFileWasCut) {
    const TestFile file;
    write_deep_file(file.path, random_levels(120, 90, 1, 3, 1), 16, {});
    const DeepFile open(file.path);
    std::size_t largest = 0;
    for (std::size_t tile = 0; tile < open.tiles(); ++tile) largest = std::max(largest, open.tile_bytes(tile));
    std::vector<float> memory(largest / sizeof(float));
    auto* const to = reinterpret_cast<std::byte*>(memory.data());
    const auto code = [&](std::size_t tile) {
        try {
            open.read_tile(tile, to);
        } catch (const base::Error& error) {
            EXPECT_THAT(error.where(), StartsWith(file.path.string() + ": byte "));
            return error.code();
        }
        return base::ErrorCode{};
    };
    const std::size_t last = open.tiles() - 1;
    EXPECT_EQ(code(last), base::ErrorCode{});
    std::filesystem::resize_file(file.path, open.file_bytes() / 2);
    EXPECT_EQ(code(last), base::ErrorCode::io);
    EXPECT_EQ(code(0), base::ErrorCode{}) << "what is still there can be read";
    std::filesystem::resize_file(file.path, 0);
    EXPECT_EQ(code(0), base::ErrorCode::io);
}

TEST(DeepFile, TakesNoMemoryForSizesThatTheFileCannotHave) {
    const TestFile file;
    write_deep_file(file.path, random_levels(5, 3, 1, 3, 1), 2, {});
    const std::string bytes = base::read_text(file.path);
    const auto with_header = [&](std::size_t offset, std::uint32_t value) {  // its checksum right
        std::string changed = bytes;
        poke(changed, offset, value);
        poke(changed, 60, crc(changed, 0, 60));
        write_bytes(file.path, changed);
    };
    for (const auto& [offset, value, says] :
         {std::tuple{24, 1u << 20, "directory"}, std::tuple{24, 0u, "0 x 3"}, std::tuple{28, 0xffffffffu, "pixels"},
          std::tuple{32, 2u, "2 channels"}, std::tuple{36, 0u, "0 levels"}, std::tuple{36, 0xffffffffu, "levels"},
          std::tuple{40, 0u, "tiles of 0"}, std::tuple{40, 1u << 31, "tiles of"}, std::tuple{44, 0xffffffffu, "text"},
          std::tuple{44, 60000u, "directory"}, std::tuple{40, 1024u, "damaged"}}) {
        with_header(static_cast<std::size_t>(offset), value);
        const std::size_t before = testing::live_bytes();
        expect_refused(file.path, bytes.size(), says);
        EXPECT_LE(testing::live_bytes(), before);
    }
}

TEST(DeepFile, ChecksTablesAndDirectoriesWhoseChecksumsAreRight) {
    const TestFile file;
    const auto levels = random_levels(4, 4, 1, 3, 1);
    write_deep_file(file.path, levels, 2, {});
    const std::string bytes = base::read_text(file.path);
    const std::size_t directory = 64, sum = directory + 4 * 16;
    const std::size_t tile = peek(bytes, directory), words = peek(bytes, directory + 8);
    for (const auto& [index, value] : {std::pair<std::size_t, std::uint32_t>{0, 2},
                                       {1, 0xfffffffe},
                                       {1, peek(bytes, tile + 4) + 1},
                                       {4, 0},
                                       {4, peek(bytes, tile + 16) + 2}}) {
        std::string changed = bytes;
        poke(changed, tile + index * 4, value);
        poke(changed, directory + 12, crc(changed, tile, words * 4));
        poke(changed, sum, crc(changed, directory, 4 * 16));
        write_bytes(file.path, changed);
        expect_refused(file.path, bytes.size(), "tile");
    }
    for (const auto& [offset, value] : {std::pair<std::size_t, std::uint32_t>{0, 8},
                                        {4, 0x7fffffff},
                                        {8, 0},
                                        {8, 0xffffffff},
                                        {8, static_cast<std::uint32_t>(words + 1)}}) {
        std::string changed = bytes;
        poke(changed, directory + offset, value);
        poke(changed, sum, crc(changed, directory, 4 * 16));
        write_bytes(file.path, changed);
        expect_refused(file.path, bytes.size(), "tile");
    }
}

TEST(DeepFile, RefusesOtherFilesVersionsAndByteOrders) {
    const TestFile file;
    write_deep_file(file.path, random_levels(2, 2, 1, 3), 2, {});
    const std::string bytes = base::read_text(file.path);
    std::string changed = bytes;
    changed[8] = 1, changed[9] = 2, changed[10] = 3, changed[11] = 4;
    write_bytes(file.path, changed);
    expect_refused(file.path, 8, "byte order");
    changed = bytes;
    changed[12] = 3;
    write_bytes(file.path, changed);
    expect_refused(file.path, 12, "version 3");
    write_bytes(file.path, std::string(200, 'x'));
    expect_refused(file.path, 0, "not a deep shadow map");
    EXPECT_EQ(fault(::testing::TempDir()).code(), base::ErrorCode::io);
    EXPECT_EQ(fault("/nowhere/a.dsm").code(), base::ErrorCode::no_such_file);
}

TEST(DeepFile, WritesAllOfAFileOrLeavesTheOldOne) {
    const TestFile file;
    write_bytes(file.path, "old");
    std::vector<DeepLevel> wrong = random_levels(8, 8, 1, 3);
    wrong.erase(wrong.begin() + 1);
    const auto code = [&](const std::vector<DeepLevel>& levels, int tile, const DeepFileNotes& notes) {
        try {
            write_deep_file(file.path, levels, tile, notes);
        } catch (const base::Error& error) {
            return error.code();
        }
        return base::ErrorCode{};
    };
    EXPECT_EQ(code(wrong, 4, {}), base::ErrorCode::internal);
    EXPECT_EQ(code({}, 4, {}), base::ErrorCode::internal);
    const auto right = random_levels(8, 8, 1, 3);
    EXPECT_EQ(code(right, 0, {}), base::ErrorCode::bad_input);
    EXPECT_EQ(code(right, max_deep_tile + 1, {}), base::ErrorCode::bad_input);
    EXPECT_EQ(code(right, 4, {0, 0, 0, std::string(70000, 'a')}), base::ErrorCode::bad_input);
    EXPECT_EQ(base::read_text(file.path), "old");
    EXPECT_THROW(write_deep_file("/nowhere/a.dsm", right, 4, {}), base::Error);
    EXPECT_EQ(code(right, 4, {}), base::ErrorCode{});
    expect_same(read_levels(DeepFile(file.path)), right);
}

}  // namespace
}  // namespace shadowbench::techniques
