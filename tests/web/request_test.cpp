#include "web/http/request.h"

#include <gtest/gtest.h>

#include "web/http/client_address.h"
#include "web/http/read_request.h"

namespace stormcellar::web {
namespace {

RawRequest raw_get(std::string target, Fields headers = {{"Host", "localhost:8090"}}) {
    return {.method = "GET",
            .target = std::move(target),
            .headers = std::move(headers),
            .client = "127.0.0.1"};
}

unsigned refusal_of(const RawRequest& raw, const ServerOptions& options = {}) {
    const Reading reading = read_request(raw, identity_of(options));
    return reading.refusal ? reading.refusal->status : 0;
}

TEST(DecodedPath, CollapsesSlashesAndKeepsTheLast) {
    EXPECT_EQ(decoded_path("/a//b///c/"), "/a/b/c/");
    EXPECT_EQ(decoded_path("//"), "/");
    EXPECT_EQ(decoded_path("/caf%C3%A9"), "/caf\xC3\xA9");
    EXPECT_EQ(decoded_path("/a+b%20c"), "/a+b c");
}

TEST(DecodedPath, RefusesEverySpellingOfTheDirectoryAbove) {
    for (const char* path :
         {"/../etc/passwd", "/a/../b", "/a/..", "/%2e%2e/b", "/%2E./b", "/.%2e/b", "/./a", "/a/%2e",
          "/..%2fetc", "/..%5cetc", "/a%2F..%2Fb", "/..\\b", "/a\\..\\b"}) {
        EXPECT_EQ(decoded_path(path), std::nullopt) << path;
    }
    EXPECT_EQ(decoded_path("/..."), "/...") << "three dots are a name";
}

TEST(DecodedPath, RefusesWhatIsNoText) {
    for (const char* path : {"/a%00b", "/%0d%0aX: y", "/%7f", "/%1b[31m", "/%", "/%4", "/%zz", "a",
                             "", "/%c0%af", "/%c0%ae%c0%ae/b", "/%e0%80%af", "/%f0%80%80%af",
                             "/%ed%a0%80", "/%f4%90%80%80", "/%ff", "/%80", "/%c3", "/%c2%80"}) {
        EXPECT_EQ(decoded_path(path), std::nullopt) << path;
    }
}

TEST(DecodedQuery, TakesPartsInOrder) {
    const auto query = decoded_query("a=1&&b=x+y%26z&a=2&flag&=v");
    const Fields expected = {{"a", "1"}, {"b", "x y&z"}, {"a", "2"}, {"flag", ""}, {"", "v"}};
    EXPECT_EQ(query, expected);
    EXPECT_EQ(decoded_query("a=%00"), std::nullopt);
    EXPECT_EQ(decoded_query("a=1&b=2&c=3", 2), std::nullopt);
}

TEST(Encoded, IsUndoneByDecoded) {
    const std::string text = "a b/c?d=e&f%\xC3\xA9~";
    EXPECT_EQ(encoded(text), "a%20b%2Fc%3Fd%3De%26f%25%C3%A9~");
    EXPECT_EQ(decoded(encoded(text), false), text);
}

TEST(Request, FindsParametersAndHeaders) {
    Request request;
    request.query = {{"stn", "KTLX"}, {"stn", "KOKX"}};
    request.headers = {{"accept-encoding", "br;q=1.0, gzip;q=0.8"},
                       {"Accept-Encoding", "zstd;q=0"}};
    EXPECT_EQ(request.parameter("stn"), "KTLX");
    EXPECT_EQ(request.parameters("stn"), (std::vector<std::string_view>{"KTLX", "KOKX"}));
    EXPECT_EQ(request.parameter("time"), std::nullopt);
    EXPECT_TRUE(request.accepts("gzip"));
    EXPECT_TRUE(request.accepts("br"));
    EXPECT_FALSE(request.accepts("zstd")) << "the weight of zstd is 0";
    EXPECT_FALSE(request.accepts("deflate"));
}

TEST(Request, PrefersHtmlIfItsAcceptDoes) {
    const auto prefers = [](const char* accept) {
        Request request;
        request.headers = {{"accept", accept}};
        return request.prefers_html();
    };
    EXPECT_FALSE(Request{}.prefers_html());
    EXPECT_TRUE(prefers("text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"));
    EXPECT_TRUE(prefers("text/html"));
    EXPECT_TRUE(prefers("application/json;q=0.2, text/*;q=0.5"));
    for (const char* accept : {"*/*", "application/json", "text/html;q=0, */*", "", ";;,/,q="})
        EXPECT_FALSE(prefers(accept)) << accept;
}

TEST(ReadRequest, AnswersLoopbackNamesAlone) {
    for (const char* host : {"localhost", "LOCALHOST:1", "127.0.0.1:8090", "[::1]", "[::1]:80"})
        EXPECT_EQ(refusal_of(raw_get("/", {{"Host", host}})), 0u) << host;
    for (const char* host :
         {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "localhost:x",
          "localhost:123456", "127.0.0.2", "", "[::1", "[::1]x", "a b", "localhost/@evil"})
        EXPECT_EQ(refusal_of(raw_get("/", {{"Host", host}})), 421u) << host;
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "localhost"}, {"host", "evil.example"}})), 400u);
    EXPECT_EQ(refusal_of(raw_get("/", {})), 400u);
}

TEST(ReadRequest, AnswersNamesThatAreConfigured) {
    ServerOptions options;
    options.names = {"Radar.Example.org"};
    options.listen = {{"192.0.2.7", 80}};
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "radar.example.ORG:443"}}), options), 0u);
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "192.0.2.7"}}), options), 0u);
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "other.example.org"}}), options), 421u);
    options.names = {"*"};
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "other.example.org"}}), options), 0u);
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "<script>"}}), options), 421u);
}

TEST(ReadRequest, RefusesWhatIsNotReading) {
    RawRequest raw = raw_get("/");
    for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "TRACE", "CONNECT", "get", "X"}) {
        raw.method = method;
        EXPECT_EQ(refusal_of(raw), 405u) << method;
    }
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "localhost"}, {"Content-Length", "5"}})), 413u);
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "localhost"}, {"Transfer-Encoding", "chunked"}})),
              413u);
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "localhost"}, {"Content-Length", "0"}})), 0u);
}

TEST(ReadRequest, TakesAWholeAddressAsTarget) {
    const Identity identity = identity_of({});
    const Reading reading = read_request(raw_get("http://localhost/a?b=c"), identity);
    EXPECT_FALSE(reading.refusal);
    EXPECT_EQ(reading.request.path, "/a");
    EXPECT_EQ(reading.request.parameter("b"), "c");
    EXPECT_EQ(refusal_of(raw_get("http://evil.example/a")), 421u);
}

TEST(ReadRequest, BelievesForwardedFieldsOfTrustedProxiesAlone) {
    const Fields headers = {{"Host", "localhost:8090"},
                            {"X-Forwarded-For", "203.0.113.5, 198.51.100.9"},
                            {"X-Forwarded-Proto", "https"},
                            {"X-Forwarded-Host", "radar.example.org"}};
    ServerOptions options;
    options.names = {"radar.example.org"};
    Reading reading = read_request(raw_get("/", headers), identity_of(options));
    EXPECT_EQ(reading.request.client, "127.0.0.1");
    EXPECT_EQ(reading.request.base, "http://localhost:8090");
    options.trusted_proxies = {"127.0.0.1"};
    reading = read_request(raw_get("/", headers), identity_of(options));
    EXPECT_EQ(reading.request.client, "198.51.100.9") << "the client that the proxy itself saw";
    EXPECT_EQ(reading.request.base, "https://radar.example.org");
    const Fields forwarded = {
        {"Host", "localhost"},
        {"Forwarded", "for=1.2.3.4, for=\"5.6.7.8\";proto=https;host=evil.example"}};
    reading = read_request(raw_get("/", forwarded), identity_of(options));
    EXPECT_EQ(reading.request.client, "5.6.7.8");
    EXPECT_EQ(reading.request.base, "https://localhost") << "a name that is not ours is not taken";
}

Reading read_through_proxy(Fields headers) {
    ServerOptions options;
    options.names = {"radar.example.org"};
    options.trusted_proxies = {"127.0.0.1"};
    headers.emplace_back("Host", "radar.example.org");
    return read_request(raw_get("/", headers), identity_of(options));
}

// 2026-11-28: a trusted proxy was not recognized if the configuration wrote its IPv6 address with
// zeros or capitals.
TEST(ReadRequest, TrustsAProxyHoweverItsAddressIsWritten) {
    ServerOptions options;
    options.trusted_proxies = {"2001:DB8:0:0:0:0:0:1"};
    RawRequest raw = raw_get("/", {{"Host", "localhost"}, {"X-Forwarded-For", "192.0.2.7"}});
    raw.client = "2001:db8::1";
    EXPECT_EQ(read_request(raw, identity_of(options)).request.client, "192.0.2.7");
}

// 2026-11-28: nginx adds X-Forwarded-For and passes Forwarded on. A client that sent Forwarded
// could pretend to be many clients and take all streams of events, and could change the host in the
// links of answers.
TEST(ReadRequest, DoesNotBelieveAClientThatAddsTheOtherKindOfForwardedField) {
    Reading reading = read_through_proxy(
        {{"X-Forwarded-For", "192.0.2.7"}, {"Forwarded", "for=198.51.100.77;host=127.0.0.1"}});
    EXPECT_EQ(reading.request.client, "127.0.0.1") << "the client is the proxy itself";
    EXPECT_EQ(reading.request.base, "http://radar.example.org");
    reading = read_through_proxy(
        {{"X-Forwarded-For", "192.0.2.7"}, {"Forwarded", "proto=https;host=127.0.0.1"}});
    EXPECT_EQ(reading.request.client, "127.0.0.1");
    EXPECT_EQ(reading.request.base, "http://radar.example.org");
    reading = read_through_proxy({{"X-Forwarded-For", "2001:db8::7"},
                                  {"X-Forwarded-Proto", "https"},
                                  {"Forwarded", "for=\"[2001:DB8:0::7]:4711\";host=localhost"}});
    EXPECT_EQ(reading.request.client, "2001:db8::7") << "this proxy writes both fields";
    EXPECT_EQ(reading.request.base, "https://radar.example.org");
}

TEST(ReadRequest, AForwardedClientIsAnAddress) {
    for (const char* name : {"unknown", "_hidden", "192.0.2", "[2001:db8::7", "a\x1b[2J", ""}) {
        EXPECT_EQ(read_through_proxy({{"X-Forwarded-For", name}}).request.client, "127.0.0.1")
            << name;
    }
    EXPECT_EQ(read_through_proxy({{"X-Forwarded-For", "192.0.2.7:80"}}).request.client,
              "192.0.2.7");
    EXPECT_EQ(read_through_proxy({{"Forwarded", "for=\"[::ffff:192.0.2.7]:80\""}}).request.client,
              "192.0.2.7");
}

TEST(ClientNetwork, IsTheNetworkOf64BitsInIpv6) {
    EXPECT_EQ(client_network("192.0.2.7"), "192.0.2.7");
    EXPECT_EQ(client_network("2001:db8:1:2::7"), "2001:db8:1:2::/64");
    EXPECT_EQ(client_network("2001:db8:1:2:ffff:ffff:ffff:ffff"), "2001:db8:1:2::/64");
    EXPECT_EQ(client_network("2001:db8:1:3::7"), "2001:db8:1:3::/64");
}

TEST(ReadRequest, TakesThePrefixOff) {
    ServerOptions options;
    options.prefix = "/storms/";
    options.public_address = "https://example.org/storms/";
    const Identity identity = identity_of(options);
    const auto path_of = [&](std::string target) {
        return read_request(raw_get(std::move(target)), identity).request.path;
    };
    EXPECT_EQ(path_of("/storms"), "/");
    EXPECT_EQ(path_of("/storms/a"), "/a");
    EXPECT_EQ(path_of("/stormsa"), "/stormsa");
    EXPECT_EQ(path_of("/a"), "/a") << "a proxy may remove the prefix itself";
    EXPECT_EQ(read_request(raw_get("/"), identity).request.base, "https://example.org/storms");
    EXPECT_EQ(refusal_of(raw_get("/", {{"Host", "example.org"}}), options), 0u)
        << "the public address names this server";
}

}  // namespace
}  // namespace stormcellar::web
