#include <cstring>
#include <string_view>
#include <utility>

#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {

std::vector<Seed> request_seeds() {
    constexpr std::pair<const char*, std::string_view> texts[] = {
        {"plain", "GET / HTTP/1.1\nHost:localhost:8090"},
        {"range", "GET /volumes/KTLX/KTLX20130520_201643_V06.gz\nHost:localhost\nRange:bytes=0-99"},
        {"suffix", "GET /s3/a/b\nHost:[::1]:80\nRange:bytes=-5\nIf-Range:\"abc\""},
        {"parts", "HEAD /a\nHost:127.0.0.1\nRange:bytes=0-1, 5-, -7"},
        {"condition", "GET /a\nHost:localhost\nIf-None-Match:W/\"abc\", \"d\"\nIf-Match:*"},
        {"dates",
         "GET /a\nHost:localhost\nIf-Modified-Since:Thu, 17 Mar 2022 00:08:42 GMT\n"
         "If-Unmodified-Since:Sunday, 06-Nov-94 08:49:37 GMT\n"
         "If-Range:Sun Nov  6 08:49:37 1994"},
        {"query",
         "GET /api/v1/grids?domain=KTLX&moment=REF&time=2013-05-20T20%3A16Z&&a+b=%C3%A9\n"
         "Host:radar.example.org"},
        {"proxy",
         "GET /storms/api\nHost:radar.example.org\n"
         "Forwarded:for=\"[2001:db8::1]:47\";proto=https;host=a.example, for=_hidden\n"
         "X-Forwarded-For:10.0.0.1, 10.0.0.2\nX-Forwarded-Proto:https"},
        {"dots", "GET /a/%2e%2e/%2E./..%2fb\nHost:localhost"},
        {"letters", "GET /%c0%ae%00%ff/%f0%9f%8c%aa\nHost:localhost"},
        {"absolute",
         "GET http://localhost/a//b/\nHost:localhost\nAccept-Encoding:gzip;q=0.5, zstd"},
        {"other", "OPTIONS *\nHost:localhost\nOrigin:http://a.example"},
    };
    std::vector<Seed> seeds;
    for (const auto& [name, text] : texts) {
        level2::wire::Bytes bytes(text.size());
        std::memcpy(bytes.data(), text.data(), text.size());
        seeds.push_back({name, std::move(bytes)});
    }
    return seeds;
}

}  // namespace stormcellar::fuzz
