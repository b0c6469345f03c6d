#include "service/http/chunks.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace shadowbench::service {
namespace {

struct Body {
    std::string text, rest;  // rest: what is left for the next request
};

// What the coding says, read in pieces of at most so many bytes.
std::optional<Body> decoded(std::string coded, std::size_t piece = 1000) {
    Body body;
    const bool whole = read_chunks(
        [&](char* to, std::size_t size) {
            const std::size_t n = std::min({size, piece, coded.size()});
            std::memcpy(to, coded.data(), n);
            coded.erase(0, n);
            return static_cast<long>(n);
        },
        [&](const char* bytes, std::size_t size) {
            body.text.append(bytes, size);
            return true;
        });
    body.rest = coded;
    return whole ? std::optional(body) : std::nullopt;
}

TEST(Chunks, AreJoined) {
    for (const std::size_t piece : {1u, 2u, 1000u}) {
        const auto body = decoded("5\r\nabcde\r\n0a\r\n0123\r\n6789\r\n1\r\n\n\r\n0\r\n\r\nGET /", piece);
        ASSERT_TRUE(body);
        EXPECT_EQ(body->text, "abcde0123\r\n6789\n");
        EXPECT_EQ(body->rest, "GET /") << "and no byte of the next request is taken";
    }
    EXPECT_EQ(decoded("00000\r\n\r\n")->text, "");
}

TEST(Chunks, MayHaveExtensionsAndTrailersThatNobodyReads) {
    EXPECT_EQ(decoded("2;a=b\r\nxy\r\n1 ; a=\"b c\" ;d\r\nz\r\n0;last\r\n\r\n")->text, "xyz");
    const auto body = decoded("1\r\nx\r\n0\r\nChecksum: 5\r\nContent-Length: 9\r\n\r\nnext");
    ASSERT_TRUE(body);
    EXPECT_EQ(body->text, "x");
    EXPECT_EQ(body->rest, "next");
}

// Each of these is a size for strtoul, or for a server less strict, and another one for the proxy before it.
TEST(Chunks, HaveHexadecimalSizesAndNothingElse) {
    for (const char* size : {"", " 1", "+1", "-1", "0x1", "1x", "1 x", "1 ", "1\t", "1,1", "g", "10000000000000000",
                             "ffffffffffffffffffff", ";a", "1\n", "1\r"})
        EXPECT_FALSE(decoded(std::string(size) + "\r\nx\r\n0\r\n\r\n")) << size;
    EXPECT_FALSE(decoded("1\nx\n0\n\n")) << "a line ends with CR and LF";
    EXPECT_FALSE(decoded("1\r\nxy\r\n0\r\n\r\n")) << "more than it says";
    EXPECT_FALSE(decoded("2\r\nx\r\n0\r\n\r\n")) << "less than it says";
    EXPECT_FALSE(decoded("ffffffffffffffff\r\nx")) << "it ends before";
    EXPECT_FALSE(decoded("1\r\nx\r\n0\r\n"));
    EXPECT_FALSE(decoded("1\r\nx\r\n0\r\na\nb\r\n\r\n"));
}

TEST(Chunks, HaveLinesOfBoundedLength) {
    EXPECT_FALSE(decoded(std::string(2000, '0') + "\r\n\r\n"));
    EXPECT_FALSE(decoded("1;" + std::string(2000, 'a') + "\r\nx\r\n0\r\n\r\n"));
    EXPECT_FALSE(decoded("0\r\nA: " + std::string(10'000, 'a') + "\r\n\r\n"));
    std::string many = "0\r\n";
    for (int i = 0; i < 1000; ++i) many += "A: 0123456789\r\n";
    EXPECT_FALSE(decoded(many + "\r\n"));
}

TEST(Chunks, EndWhereNoMoreIsTaken) {
    std::string coded = "5\r\nabcde\r\n0\r\n\r\n";
    EXPECT_FALSE(read_chunks(
        [&](char* to, std::size_t size) {
            const std::size_t n = std::min(size, coded.size());
            std::memcpy(to, coded.data(), n);
            coded.erase(0, n);
            return static_cast<long>(n);
        },
        [](const char*, std::size_t) { return false; }));
}

}  // namespace
}  // namespace shadowbench::service
