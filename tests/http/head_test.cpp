#include "service/http/head.h"

#include <gtest/gtest.h>

namespace shadowbench::service {
namespace {

int fault_of(const std::string& text) {
    Head head;
    const auto fault = parse_head(text, head);
    return fault ? fault->status : 0;
}

std::string with(const std::string& fields) {
    return "POST / HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n";
}

TEST(ParseHead, ReadsARequest) {
    Head head;
    ASSERT_FALSE(
        parse_head("POST /v1/jobs/a%20b/%41?x=1&y=a+b%26&empty&=none HTTP/1.1\r\nHost: localhost\r\n"
                   "Content-LENGTH:  12 \r\nX-Two: %41\r\n\r\n",
                   head));
    EXPECT_EQ(head.request.method, "POST");
    EXPECT_EQ(head.request.path, (std::vector<std::string>{"v1", "jobs", "a b", "A"}));
    EXPECT_EQ(*head.request.parameter("x"), "1");
    EXPECT_EQ(*head.request.parameter("y"), "a b&");
    EXPECT_EQ(*head.request.parameter("empty"), "");
    EXPECT_EQ(*head.request.header("x-two"), "%41") << "header values are not decoded";
    EXPECT_EQ(head.content_length, 12u);
    EXPECT_TRUE(head.request.has_body);
    EXPECT_TRUE(head.keep_alive);
}

TEST(ParseHead, RefusesWhatIsNoRequestLine) {
    for (const char* line :
         {"", "GET", "GET /", "GET  / HTTP/1.1", "GET / HTTP/1.1 x", "G\tET / HTTP/1.1", " GET / HTTP/1.1",
          "GET * HTTP/1.1", "GET x HTTP/1.1", "GET / FTP/1.1", "(GET) / HTTP/1.1"})
        EXPECT_EQ(fault_of(std::string(line) + "\r\nHost: a\r\n\r\n"), 400) << line;
    EXPECT_EQ(fault_of("GET / HTTP/2.0\r\nHost: a\r\n\r\n"), 505);
    EXPECT_EQ(fault_of("GET http://a/x HTTP/1.1\r\nHost: a\r\n\r\n"), 0);
}

TEST(ParseHead, RefusesWaysOutOfThePath) {
    for (const char* path : {"/../etc/passwd", "/a/../../b", "/%2e%2e/b", "/a/%2E./b", "/a%2fb", "/a%5c..%5cb",
                             "/a\\..\\b", "/a%00b", "/a%0d%0ab", "/%", "/%4", "/%zz", "/./a", "/a/.."})
        EXPECT_EQ(fault_of("GET " + std::string(path) + " HTTP/1.1\r\nHost: a\r\n\r\n"), 400) << path;
    EXPECT_EQ(fault_of("GET /%252e%252e/a HTTP/1.1\r\nHost: a\r\n\r\n"), 0) << "a name of letters";
}

TEST(ParseHead, RefusesBodiesOfTwoLengths) {
    EXPECT_EQ(fault_of(with("Content-Length: 1\r\nTransfer-Encoding: chunked\r\n")), 400);
    EXPECT_EQ(fault_of(with("Content-Length: 1\r\nContent-Length: 1\r\n")), 400);
    EXPECT_EQ(fault_of(with("Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n")), 400);
    EXPECT_EQ(fault_of(with("Transfer-Encoding: gzip, chunked\r\n")), 501);
    for (const char* length : {"-1", "+1", "1x", "", "0x10", "1, 1", "99999999999999999999999"})
        EXPECT_EQ(fault_of(with(std::string("Content-Length: ") + length + "\r\n")), 400) << length;
    EXPECT_EQ(fault_of("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"), 400);
    EXPECT_EQ(fault_of(with("Transfer-Encoding: Chunked\r\n")), 0);
}

TEST(ParseHead, RefusesFieldsThatCanBeReadInTwoWays) {
    for (const char* field : {"Bad Name: x\r\n", "Name : x\r\n", ": x\r\n", "none\r\n", "A: b\r\n folded\r\n",
                              "A: b\nC: d\r\n", "A: b\rc\r\n", "A: \x01\r\n"})
        EXPECT_EQ(fault_of(with(field)), 400) << field;
    EXPECT_EQ(fault_of(with(std::string("A: b\0c\r\n", 8))), 400);
    EXPECT_EQ(fault_of("GET / HTTP/1.1\r\n\r\n"), 400) << "no Host";
    EXPECT_EQ(fault_of("GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"), 400);
    EXPECT_EQ(fault_of("GET / HTTP/1.0\r\n\r\n"), 0);
    EXPECT_EQ(fault_of(with("Expect: a miracle\r\n")), 417);
}

TEST(ParseHead, KnowsWhetherTheConnectionGoesOn) {
    const auto keeps = [](const std::string& text) {
        Head head;
        EXPECT_FALSE(parse_head(text, head)) << text;
        return head.keep_alive;
    };
    EXPECT_TRUE(keeps("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    EXPECT_FALSE(keeps("GET / HTTP/1.1\r\nHost: a\r\nConnection: Close\r\n\r\n"));
    EXPECT_FALSE(keeps("GET / HTTP/1.0\r\n\r\n"));
    EXPECT_TRUE(keeps("GET / HTTP/1.0\r\nConnection: keep-alive\r\n\r\n"));
}

}  // namespace
}  // namespace shadowbench::service
