#include "web/http/connection_watch.h"

#include <gtest/gtest.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::web {
namespace {

// Returns a pointer that names a connection. The watch never dereferences it.
MHD_Connection* made_connection(std::uintptr_t number) {
    return reinterpret_cast<MHD_Connection*>(number);
}

// 2026-11-28: a machine has 2^64 IPv6 addresses, and each of them got a share of the connections.
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
    EXPECT_TRUE(watch.may_open("2001:db8:0:2::1")) << "a trusted proxy may take all connections";
    EXPECT_TRUE(watch.may_open("2001:db8:0:2::2"))
        << "the proxy's connections do not count for its neighbor";
    watch.closed(made_connection(1));
    EXPECT_TRUE(watch.may_open("2001:db8::3"));
}

int most_unsent(int socket) {
    int bytes = 0;
    socklen_t size = sizeof bytes;
    EXPECT_EQ(::getsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &bytes, &size), 0);
    return bytes;
}

// 2026-11-28: the kernel held megabytes for each of a thousand slow readers. With a small limit for
// every connection, a volume takes twice the processor time.
TEST(ConnectionWatch, TheKernelHoldsLittleOfManyBodies) {
    const Descriptor first{::socket(AF_INET, SOCK_STREAM, 0)};
    const Descriptor last{::socket(AF_INET, SOCK_STREAM, 0)};
    ConnectionWatch watch({}, {});
    watch.opened(made_connection(1), first.number(), "192.0.2.1");
    EXPECT_EQ(most_unsent(first.number()), 4 << 20);
    for (std::uintptr_t other = 2; other <= 64; ++other)
        watch.opened(made_connection(other), -1, "192.0.2.1");
    watch.opened(made_connection(65), last.number(), "192.0.2.1");
    EXPECT_EQ(most_unsent(last.number()), 256 << 10);
}

}  // namespace
}  // namespace stormcellar::web
