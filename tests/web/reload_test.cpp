// Tests the whole data server while it reloads its configuration.
#include <atomic>
#include <fstream>
#include <future>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include "base/steady_time.h"
#include "stormcellar/base/file_system.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"
#include "tests/web/raw_client.h"
#include "tests/web/setup_below.h"
#include "web/service/web_service.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;

// Tries to take the port as another program would, and closes it again.
bool takes_port(int port) {
    const Descriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const int on = 1;
    ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) ==
               0 &&
           ::listen(socket.number(), 1) == 0;
}

class Reload : public ::testing::Test {
  protected:
    void start() {
        fs::create_directories(directory_ / "cache");
        auto opened = WebService::open(setup_);
        ASSERT_TRUE(opened) << opened.error().message;
        service_ = std::move(*opened);
        const std::string url = service_->addresses().at(0);
        port_ = std::stoi(url.substr(url.rfind(':', url.size() - 2) + 1));
    }
    // Begins an answer that is larger than the client's buffer.
    static void begin_long_answer(RawClient& client) {
        client.send(
            "GET /api/v1/map?west=-170&south=-60&east=170&north=75&detail=0 HTTP/1.1\r\nHost: "
            "localhost\r\n\r\n");
        ASSERT_EQ(status_in(client.read_until("\r\n\r\n")), 200);
    }
    [[nodiscard]] int status() const { return status_in(RawClient::get(port_, "/api/v1")); }

    testing::TemporaryDirectory directory_;
    WebSetup setup_ = setup_below(directory_.path());
    std::unique_ptr<WebService> service_;
    int port_ = 0;
};

// 2026-11-28: if an answer was under way at a reload, the port was free for two seconds, and
// another program took it at the first try.
TEST_F(Reload, NoOtherProgramCanTakeThePort) {
    start();
    // An answer under way delays the end of the old server.
    RawClient half(port_, 2048);
    begin_long_answer(half);
    std::atomic<bool> is_over = false;
    std::atomic<int> taken = 0;
    std::thread rival([&] {
        while (!is_over)
            taken += takes_port(port_) ? 1 : 0;
    });
    WebSetup fresh = setup_;
    fresh.web.silent += std::chrono::seconds{1};
    EXPECT_TRUE(service_->reload(fresh));
    is_over = true;
    rival.join();
    EXPECT_EQ(taken, 0);
    EXPECT_EQ(status(), 200);
}

// 2026-11-28: while an answer was computed or sent slowly, a reload kept every other client
// waiting.
TEST_F(Reload, NobodyWaitsForTheOldServersEnd) {
    start();
    RawClient half(port_, 2048);
    begin_long_answer(half);
    WebSetup fresh = setup_;
    fresh.web.cors = true;
    auto reloaded = std::async(std::launch::async, [&] { return service_->reload(fresh); });
    int of_the_new_one = 0;
    while (reloaded.wait_for(std::chrono::seconds{0}) != std::future_status::ready) {
        const std::string answer = RawClient::get(port_, "/api/v1");
        EXPECT_EQ(status_in(answer), 200);
        of_the_new_one += answer.find("Access-Control-Allow-Origin") != std::string::npos ? 1 : 0;
    }
    EXPECT_TRUE(reloaded.get());
    EXPECT_GE(of_the_new_one, 3) << "the new server answers while the old server still ends";
}

// 2026-11-28: a client that had connected just before a reload was cut off without an answer.
TEST_F(Reload, AClientThatHasJustConnectedIsAnswered) {
    start();
    for (int i = 0; i < 10; ++i) {
        RawClient client(port_);
        // The server has the connection, but no request yet.
        ASSERT_TRUE(testing::eventually([&] { return service_->facts().connections > 0; }));
        auto reloaded = std::async(std::launch::async, [&] { return service_->reload(setup_); });
        client.send("GET /api/v1 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
        EXPECT_NE(status_in(client.read_to_end()), 0) << "503 is an answer, too";
        EXPECT_TRUE(reloaded.get());
    }
}

TEST_F(Reload, AnAddressThatIsTakenLeavesTheServerAsItWas) {
    start();
    const Descriptor other{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(other.number(), reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(other.number(), 1), 0);
    ::getsockname(other.number(), reinterpret_cast<sockaddr*>(&address), &size);
    WebSetup fresh = setup_;
    fresh.web.listen = {{"127.0.0.1", ntohs(address.sin_port)}};
    EXPECT_FALSE(service_->reload(fresh));
    EXPECT_EQ(status(), 200);
}

// 2026-11-28: the old server was closed to free its port. That could not help, because the new
// address is not of this machine.
TEST_F(Reload, AnAddressOfAnotherMachineLeavesTheServerAsItWas) {
    start();
    RawClient kept(port_);
    ASSERT_TRUE(testing::eventually([&] { return service_->facts().connections > 0; }));
    setup_.web.listen = {{"203.0.113.9", port_}};
    EXPECT_FALSE(service_->reload(setup_));
    EXPECT_TRUE(kept.send("GET /api/v1 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
    EXPECT_EQ(status_in(kept.read_to_end()), 200);
}

TEST_F(Reload, AServerMayBeOpenedToAllOnTheSamePort) {
    start();
    setup_.web.listen = {{"127.0.0.1", port_}};
    ASSERT_TRUE(service_->reload(setup_));
    setup_.web.listen = {{"0.0.0.0", port_}};
    const Status taken = service_->reload(setup_);
    EXPECT_TRUE(taken) << taken.error().message;
    EXPECT_EQ(status(), 200);
}

// 2026-11-28: a server that could not listen again after a reload never tried again, and its
// watchdog was told that all is well.
TEST_F(Reload, AServerThatListensNowhereTriesAgain) {
    start();
    setup_.web.listen = {{"127.0.0.1", port_}};
    ASSERT_TRUE(service_->reload(setup_));
    rlimit before{};
    ::getrlimit(RLIMIT_NOFILE, &before);
    bool was_deaf = false;
    for (int i = 0; i < 200 && !was_deaf; ++i) {
        // Take all descriptors, as another thread might.
        const rlimit few{512, before.rlim_max};
        ::setrlimit(RLIMIT_NOFILE, &few);
        std::atomic<bool> is_over = false, has_all = false;
        std::vector<Descriptor> taken;
        std::thread greedy([&] {
            while (!is_over) {
                Descriptor one{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
                if (one.is_open()) {
                    taken.push_back(std::move(one));
                } else {
                    has_all = true;
                }
            }
        });
        EXPECT_TRUE(testing::eventually([&] { return has_all.load(); }));
        // The new address conflicts with the old address, so the old server must end first.
        setup_.web.listen = {{i % 2 == 0 ? "0.0.0.0" : "127.0.0.1", port_}};
        const Status done = service_->reload(setup_);
        const std::string why = done ? std::string{} : done.error().message;
        EXPECT_EQ(why.find("Bad file descriptor"), std::string::npos);
        was_deaf = !service_->is_listening();
        if (was_deaf) {
            service_->look_again();
            EXPECT_FALSE(service_->is_listening()) << "no descriptor is free yet";
            EXPECT_FALSE(service_->is_at_work()) << "systemd then starts the service again";
        }
        is_over = true;
        greedy.join();
        taken.clear();
        ::setrlimit(RLIMIT_NOFILE, &before);
        service_->look_again();
        ASSERT_TRUE(service_->is_listening());
        ASSERT_EQ(status(), 200);
    }
    EXPECT_TRUE(was_deaf);
    EXPECT_TRUE(service_->is_at_work());
}

// 2026-11-28: a server that was killed left temporary files, which no later start removed.
TEST_F(Reload, WhatAKilledServerLeftIsRemovedAtTheStart) {
    setup_.numbers = directory_ / "times";
    fs::create_directories(setup_.numbers / "KTLX");
    const fs::path left = setup_.numbers / "KTLX" / (std::string(temporary_prefix) + "1-1");
    std::ofstream(left) << "half";
    std::ofstream(setup_.numbers / "KTLX" / "REF.times") << "kept";
    start();
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(setup_.numbers / "KTLX" / "REF.times"));
}

}  // namespace
}  // namespace stormcellar::web
