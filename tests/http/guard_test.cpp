#include "service/http/guard.h"

#include <gtest/gtest.h>

namespace shadowbench::service {
namespace {

int status_of(const std::vector<Field>& headers, const GuardOptions& options, const std::string& path = "v1",
              const std::string& method = "GET") {
    ApiRequest request;
    request.method = method;
    request.path = {path};
    request.headers = headers;
    const auto refusal = guard(request, options);
    return refusal ? refusal->status : 0;
}

TEST(Guard, AsksForTheTokenOfTheServer) {
    const GuardOptions options{false, {{"", "0123456789abcdef"}}};
    EXPECT_EQ(status_of({}, options), 401);
    for (const char* wrong :
         {"", "Bearer", "Bearer ", "Bearer 0123456789abcde", "Bearer 0123456789abcdef0", "Bearer 0123456789abcdeF",
          "Digest 0123456789abcdef", "0123456789abcdef", "Basic YW55OjAxMjM0NTY3ODlhYmNkZWY="})
        EXPECT_EQ(status_of({{"authorization", wrong}}, options), 401) << wrong;
    EXPECT_EQ(status_of({{"authorization", "Bearer 0123456789abcdef"}}, options), 0);
    EXPECT_EQ(status_of({{"authorization", "bearer  0123456789abcdef"}}, options), 0);
    EXPECT_EQ(status_of({}, options, "healthz"), 0);
    EXPECT_EQ(status_of({}, options, "readyz"), 0);
    EXPECT_EQ(status_of({}, options, ""), 0) << "the page asks for it";
    EXPECT_EQ(status_of({}, options, "assets"), 0);
    EXPECT_EQ(status_of({}, options, "openapi.json"), 401);
    EXPECT_EQ(status_of({}, options, "metrics"), 401);
}

TEST(Guard, ComparesWholeTokens) {
    EXPECT_TRUE(equal_in_constant_time("secret", "secret"));
    for (const char* wrong : {"", "s", "secre", "secrets", "Secret", "secretsecret", "xecret", "secrex"})
        EXPECT_FALSE(equal_in_constant_time(wrong, "secret")) << wrong;
}

TEST(Guard, OnThisMachineAnswersToItsNamesAlone) {
    for (const char* host :
         {"localhost", "localhost:8080", "127.0.0.1:1", "[::1]:80", "[::1]", "LOCALHOST", "localhost:"})
        EXPECT_EQ(status_of({{"host", host}}, {}), 0) << host;
    for (const char* host :
         {"evil.example", "localhost.evil.example:8080", "127.0.0.1.nip.io", "10.0.0.1", "[::2]", "[", "",
          "[::1].evil.example", "[::1].evil.example:80", "[::1]evil", "[::1", "[::1]:80.evil.example",
          "localhost:80.evil.example", "localhost:x", "127.0.0.1:80:80", "::1"})
        EXPECT_EQ(status_of({{"host", host}}, {}), 421) << host;
    EXPECT_EQ(status_of({{"host", "bench.example"}}, {false, {}}), 0);
}

TEST(Guard, RefusesPagesOfOtherOrigins) {
    const Field host{"host", "localhost:8080"};
    EXPECT_EQ(status_of({host, {"origin", "http://localhost:8080"}}, {}), 0);
    for (const char* origin : {"http://evil.example", "null", "http://localhost:9090", "http://localhost"})
        EXPECT_EQ(status_of({host, {"origin", origin}}, {}), 403) << origin;
    EXPECT_EQ(status_of({host, {"sec-fetch-site", "cross-site"}}, {}, "v1", "POST"), 403);
    EXPECT_EQ(status_of({host, {"sec-fetch-site", "same-origin"}}, {}, "v1", "POST"), 0);
    EXPECT_EQ(status_of({host, {"sec-fetch-site", "cross-site"}}, {}), 0) << "a link leads here";
}

TEST(Guard, KnowsAddressesOfThisMachine) {
    for (const char* host : {"127.0.0.1", "localhost", "::1"}) EXPECT_TRUE(is_loopback(host)) << host;
    for (const char* host : {"0.0.0.0", "::", "10.0.0.1", "127.0.0.1.example", ""})
        EXPECT_FALSE(is_loopback(host)) << host;
}

}  // namespace
}  // namespace shadowbench::service
