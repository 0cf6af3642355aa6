#include "base/host_field.h"

#include <string_view>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(LoopbackHost, NamesOfThisMachineWithAPortOrWithout) {
    for (const std::string_view host : {"127.0.0.1", "127.0.0.1:9123", "localhost",
                                        "LocalHost:9123", "[::1]", "[::1]:9123", "localhost:80"}) {
        EXPECT_TRUE(is_loopback_host(host)) << host;
    }
}

TEST(LoopbackHost, NothingElse) {
    for (const std::string_view host :
         {"", "evil.example", "evil.example:9123", "localhost.evil.example",
          "localhost:", "localhost:x", "localhost:123456", "localhost:9123 ", "localhost.",
          " localhost", "127.0.0.1.evil.example", "127.0.0.10", "0.0.0.0:9123", "::1", "[::1]x",
          "[::]:9123", "localhost:9123, evil.example", "evil.example localhost", "local"}) {
        EXPECT_FALSE(is_loopback_host(host)) << host;
    }
}

}  // namespace
}  // namespace stormcellar
