#include "web/http/connection_watch.h"

#include <gtest/gtest.h>

namespace stormcellar::web {
namespace {

// The watch takes the address of a connection for its name and does not look into it.
MHD_Connection* made_connection(std::uintptr_t number) {
    return reinterpret_cast<MHD_Connection*>(number);
}

// 2026-11-28: one machine has 2^64 addresses of IPv6, and so had as many shares of the connections.
TEST(ConnectionWatch, AnIpv6NetworkOf64BitsIsOneClient) {
    ServerLimits limits;
    limits.most_connections_of_address = 2;
    ConnectionWatch watch(limits, {"2001:db8:0:2::1"});
    watch.opened(made_connection(1), -1, "2001:db8::1");
    EXPECT_TRUE(watch.may_open("2001:db8::2"));
    watch.opened(made_connection(2), -1, "2001:db8::2");
    EXPECT_FALSE(watch.may_open("2001:db8::3"));
    EXPECT_TRUE(watch.may_open("2001:db8:0:1::3"));
    for (const std::uintptr_t proxied : {3, 4, 5})
        watch.opened(made_connection(proxied), -1, "2001:db8:0:2::1");
    EXPECT_TRUE(watch.may_open("2001:db8:0:2::1")) << "a proxy has as many as there are";
    EXPECT_TRUE(watch.may_open("2001:db8:0:2::2")) << "and takes none of its neighbor's";
    watch.closed(made_connection(1));
    EXPECT_TRUE(watch.may_open("2001:db8::3"));
}

}  // namespace
}  // namespace stormcellar::web
