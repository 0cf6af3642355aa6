// Tests how much of a server one client, or all clients together, may hold.
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/waiting.h"
#include "tests/web/served.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

// Size of an answer that does not fit into the buffers of both sockets.
constexpr std::size_t large_bytes = 64 << 20;
Text large_text() {
    return text_of(std::string(large_bytes, 'x'));
}

TEST_F(WebServer, ConnectionsBeyondTheLimitAreClosedAndTheServerGoesOn) {
    options_.limits.most_connections = 16;
    options_.limits.most_connections_of_address = 1000;
    options_.limits.request_time = 1s;
    start();
    std::vector<std::unique_ptr<RawClient>> idle;
    for (int i = 0; i < 200; ++i)
        idle.push_back(std::make_unique<RawClient>(port_));
    EXPECT_TRUE(testing::eventually([&] { return server_->facts().connections <= 16; }));
    // The server ends idle connections, so other clients can connect.
    EXPECT_TRUE(testing::eventually([&] { return status_in(get("/")) == 200; }));
    for (const auto& client : idle)
        EXPECT_TRUE(client->is_closed(5s));
}

TEST_F(WebServer, OneAddressDoesNotTakeAllPlaces) {
    options_.limits.most_connections_of_address = 4;
    start();
    std::vector<std::unique_ptr<RawClient>> held;
    for (int i = 0; i < 8; ++i)
        held.push_back(std::make_unique<RawClient>(port_));
    EXPECT_TRUE(testing::eventually([&] { return server_->facts().connections == 4; }));
    int closed = 0;
    for (const auto& client : held)
        closed += client->is_closed(200ms) ? 1 : 0;
    EXPECT_EQ(closed, 4);
}

TEST_F(WebServer, HalfARequestIsCutOffInTime) {
    options_.limits.request_time = 1s;
    start();
    RawClient client(port_);
    client.send("GET / HTTP/1.1\r\nHo");
    const auto began = std::chrono::steady_clock::now();
    // Sending one byte now and then does not extend the time.
    bool is_open = true;
    while (is_open && std::chrono::steady_clock::now() - began < 10s) {
        is_open = client.send("s") && !client.is_closed(200ms);
    }
    EXPECT_FALSE(is_open);
    EXPECT_EQ(status_in(get("/")), 200);
}

TEST_F(WebServer, AClientThatTakesNothingIsCutOff) {
    options_.limits.rate_time = 1s;
    add_body("/large", Pieces{large_text()});
    start();
    RawClient client(port_, 4096);
    client.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(testing::eventually([&] { return server_->facts().connections == 1; }));
    EXPECT_TRUE(testing::eventually([&] { return server_->facts().connections == 0; }));
}

// 2026-11-28: 120 clients that slowly took ranges of a kept answer held 120 copies, and the system
// killed the server for its memory.
TEST_F(WebServer, AnswersOnTheirWayHaveABudget) {
    constexpr std::size_t large = 8 << 20;
    options_.limits.answer_bytes = 20 << 20;
    const auto answer_with_text = [](const Text& text) {
        Answer answer;
        answer.body = Pieces{text};
        return answer;
    };
    const Text shared = text_of(std::string(large, 's'));
    add("/shared", [&, shared](const Request&) { return answer_with_text(shared); });
    add("/own", [&](const Request&) { return answer_with_text(text_of(std::string(large, 'o'))); });
    start();
    std::vector<std::unique_ptr<RawClient>> slow;
    const auto take_slowly = [&](std::string_view path, const std::string& from,
                                 const std::string& verb = "GET ") {
        slow.push_back(std::make_unique<RawClient>(port_, 4096, from));
        slow.back()->send(verb + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
        return status_in(slow.back()->read_until("\r\n\r\n"));
    };
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(take_slowly("/shared", "127.0.0." + std::to_string(10 + i)), 200);
    EXPECT_EQ(server_->facts().answer_bytes, large) << "all clients share one copy";
    EXPECT_EQ(take_slowly("/own", "127.0.0.2"), 200);
    EXPECT_EQ(take_slowly("/own", "127.0.0.2"), 503)
        << "one client may not hold more than half of the budget";
    EXPECT_EQ(take_slowly("/own", "127.0.0.3"), 503) << "the budget has no room";
    // 2026-11-28: twelve clients that sent HEAD requests and read nothing held 447 MB that did not
    // count.
    EXPECT_EQ(take_slowly("/own", "127.0.0.4", "HEAD "), 503) << "the answer to HEAD is held, too";
    EXPECT_EQ(status_in(get("/")), 200) << "small answers need no room";
    slow.clear();
    EXPECT_TRUE(testing::eventually([&] { return server_->facts().answer_bytes == 0; }));
    EXPECT_EQ(body_in(get("/own")).size(), large);
}

// 2026-11-28: slow readers of two addresses held the whole budget for half an hour, and all other
// clients got 503.
TEST_F(WebServer, ASlowBodyGivesWayWhenMemoryIsShort) {
    constexpr std::size_t large = 8 << 20;
    options_.limits.answer_bytes = 10 << 20;
    options_.limits.least_bytes_per_s = 100'000;
    options_.limits.rate_time = 600s;
    options_.limits.answer_time = 600s;
    add("/own", [&](const Request&) {
        Answer answer;
        answer.body = Pieces{text_of(std::string(large, 'o'))};
        return answer;
    });
    start();
    RawClient slow(port_, 4096, "127.0.0.2");
    slow.send("GET /own HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_EQ(status_in(slow.read_until("\r\n\r\n")), 200);
    EXPECT_EQ(status_in(get("/own")), 503);
    EXPECT_TRUE(testing::eventually([&] { return status_in(get("/own")) == 200; }));
}

// 2026-11-28: a client that took 1,000 bytes a second held a connection for ten hours.
TEST_F(WebServer, AnAnswerHasATotalTime) {
    options_.limits.answer_time = 3s;
    options_.limits.rate_time = 60s;
    options_.limits.least_bytes_per_s = 10'000'000;
    add_body("/large", Pieces{large_text()});
    start();
    EXPECT_EQ(body_in(get("/large")).size(), large_bytes);
    RawClient client(port_, 4096);
    client.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(testing::eventually([&] { return server_->facts().connections == 1; }));
    EXPECT_TRUE(testing::eventually([&] {
        (void)client.read_until("never", 1ms);
        return server_->facts().connections == 0;
    }));
}

// 2026-11-28: 1,024 slow readers of five addresses kept all connections, and an honest client was
// refused ten times of ten.
TEST_F(WebServer, TheSlowestBodiesGiveWay) {
    options_.limits.most_connections = 8;
    options_.limits.most_connections_of_address = 8;
    add_body("/large", Pieces{large_text()});
    start();
    std::vector<std::unique_ptr<RawClient>> slow;
    for (int i = 0; i < 8; ++i) {
        slow.push_back(std::make_unique<RawClient>(port_, 4096, "127.0.0.2"));
        slow.back()->send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_EQ(status_in(slow.back()->read_until("\r\n\r\n")), 200);
    }
    EXPECT_TRUE(testing::eventually([&] { return status_in(get("/")) == 200; }));
}

}  // namespace
}  // namespace stormcellar::web
