// Tests that the server answers requests, also while other clients misbehave.
#include "daemon/status/status_server.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/status/listening_socket.h"
#include "stormcellar/base/descriptor.h"
#include "tests/daemon/status_client.h"
#include "tests/testing/loopback.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;

class StatusServerTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path path() const { return directory_ / "s.sock"; }
    [[nodiscard]] StatusServerOptions quick() const {
        return {.socket = path(),
                .http_port = 0,
                .retry = milliseconds{20},
                .longest_connection = std::chrono::minutes{1},
                .freshness = milliseconds{0},
                .most_connections = 8};
    }
    // Returns options that cut off clients soon.
    [[nodiscard]] StatusServerOptions impatient() const {
        StatusServerOptions options = quick();
        options.longest_connection = milliseconds{300};
        return options;
    }
    StatusServer::Render render() {
        return [this](StatusPage which) {
            ++rendered_;
            return which == StatusPage::json ? std::string{"{}\n"} : metrics_;
        };
    }
    [[nodiscard]] std::string ask(const std::string& request) const {
        return StatusClient::at_path(path()).ask(request);
    }
    // Returns true if one of 100 requests is answered: on a busy machine, well-behaved clients may
    // be cut off, too.
    [[nodiscard]] bool answers() const {
        for (int i = 0; i < 100; ++i)
            if (body_of(ask(get("/metrics"))) == metrics_) return true;
        return false;
    }

    testing::TemporaryDirectory directory_;
    std::string metrics_ = "x 1\n";
    std::atomic<int> rendered_ = 0;
};

// The watchdog must notice a server that hangs in the middle of an answer, but not a server that
// waits for a request.
TEST_F(StatusServerTest, IsSeenToHang) {
    std::atomic<bool> hangs = true, is_at_a_page = false;
    const StatusServer server(quick(), [&](StatusPage) {
        is_at_a_page = true;
        EXPECT_TRUE(testing::eventually([&] { return !hangs; }));
        return metrics_;
    });
    const SteadyTime before = std::chrono::steady_clock::now();
    const StatusClient client = StatusClient::at_path(path());
    client.send(get("/metrics"));
    const bool hung = testing::eventually([&] { return is_at_a_page.load(); });
    const auto since = server.pulse().since();
    hangs = false;
    ASSERT_TRUE(hung);
    ASSERT_TRUE(since);
    EXPECT_GE(*since, before);
    EXPECT_TRUE(testing::eventually([&] { return !server.pulse().since(); }));
}

bool says_how_to_take_it(const std::string& answer) {
    return answer.find("Cache-Control: no-store\r\n") != std::string::npos &&
           answer.find("X-Content-Type-Options: nosniff\r\n") != std::string::npos;
}

TEST_F(StatusServerTest, AnswersWithPagesAndEndsTheConnection) {
    const StatusServer server(quick(), render());
    const std::string metrics = ask(get("/metrics"));
    EXPECT_TRUE(metrics.starts_with("HTTP/1.")) << metrics;
    EXPECT_NE(metrics.find(" 200 OK\r\n"), std::string::npos) << metrics;
    EXPECT_NE(metrics.find("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"),
              std::string::npos);
    EXPECT_EQ(body_of(metrics), "x 1\n");
    const std::string json = ask("GET /status.json HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_NE(json.find("Content-Type: application/json\r\n"), std::string::npos) << json;
    EXPECT_EQ(body_of(json), "{}\n");
    const std::string head = ask("HEAD /metrics HTTP/1.0\r\n\r\n");
    EXPECT_NE(head.find("Content-Length: 4\r\n"), std::string::npos) << head;
    EXPECT_EQ(body_of(head), "");
    EXPECT_EQ(body_of(ask("GET /metrics?x=y HTTP/1.0\r\n\r\n")), "x 1\n");
}

TEST_F(StatusServerTest, EverythingElseIsRefused) {
    const StatusServer server(quick(), render());
    const auto status_of = [&](const std::string& request) {
        const std::string answer = ask(request);
        return answer.size() < 12 ? "none" : answer.substr(9, 3);
    };
    EXPECT_EQ(status_of(get("/")), "404");
    EXPECT_EQ(status_of(get("/metrics/../../etc/passwd")), "404");
    EXPECT_EQ(status_of("POST /metrics HTTP/1.0\r\nContent-Length: 3\r\n\r\nabc"), "405");
    EXPECT_EQ(status_of("DELETE /status.json HTTP/1.0\r\n\r\n"), "405");
    EXPECT_EQ(status_of("GET /metrics HTTP/1.0\r\nContent-Length: -1\r\n\r\n"), "400");
    EXPECT_EQ(status_of("GET /" + std::string(50'000, 'a') + " HTTP/1.0\r\n\r\n"), "414");
    EXPECT_EQ(status_of("GET /metrics HTTP/1.0\r\nX: " + std::string(50'000, 'a') + "\r\n\r\n"),
              "431");
    EXPECT_TRUE(answers());
}

TEST_F(StatusServerTest, BeforeThereIsAPageItSaysSo) {
    const StatusBoard board;
    const StatusServer server(quick(), pages_of(board));
    EXPECT_NE(ask(get("/metrics")).find(" 503 "), std::string::npos);
}

TEST_F(StatusServerTest, ThePagesAreThoseOfTheBoard) {
    StatusBoard board;
    StatusBook book("/d", "/c");
    book.set_state("running");
    board.post(book.facts(), {3, 2, 1});
    const StatusServer server(quick(), pages_of(board));
    EXPECT_NE(ask(get("/metrics")).find("stormcellar_queue_files{state=\"waiting\"} 3\n"),
              std::string::npos);
    EXPECT_NE(ask(get("/status.json")).find("\"state\": \"running\""), std::string::npos);
}

TEST_F(StatusServerTest, WhoSaysNothingOrDripsIsCutOff) {
    const StatusServer server(impatient(), render());
    const StatusClient silent = StatusClient::at_path(path());
    const StatusClient half = StatusClient::at_path(path());
    half.send("GET /metr");
    EXPECT_TRUE(answers()) << "other clients must be answered meanwhile";
    EXPECT_TRUE(silent.read_to_end()) << "the server must end the connection";
    EXPECT_TRUE(half.read_to_end());
    // A client that sends a byte now and then is cut off, too.
    const StatusClient dripping = StatusClient::at_path(path());
    int sent = 0;
    EXPECT_TRUE(testing::eventually([&] { return !dripping.send("G") || ++sent == 1000; }));
    EXPECT_LT(sent, 1000);
}

TEST_F(StatusServerTest, WhoNeverReadsIsCutOff) {
    metrics_.assign(20'000'000, 'x');
    const StatusServer server(impatient(), render());
    std::vector<StatusClient> lazy;
    for (int i = 0; i < 4; ++i) {
        lazy.push_back(StatusClient::at_path(path()));
        lazy.back().send(get("/metrics"));
    }
    for (const StatusClient& client : lazy)
        EXPECT_TRUE(testing::eventually([&] { return client.is_cut_off(); }));
    for (const StatusClient& client : lazy)
        EXPECT_LT(client.read_to_end().value_or(metrics_).size(), metrics_.size());
}

TEST_F(StatusServerTest, MoreConnectionsThanThereMayBeWaitTheirTurn) {
    const StatusServer server(impatient(), render());
    std::vector<StatusClient> many;
    for (int i = 0; i < 20; ++i)
        many.push_back(StatusClient::at_path(path()));
    EXPECT_TRUE(answers()) << "answers must come once the silent clients were cut off";
}

// 2026-11-22: silent connections kept all clients from an answer until they were cut off after 10
// s.
TEST_F(StatusServerTest, SilentConnectionsMakeRoomForWhoAsks) {
    StatusServerOptions options = quick();
    options.longest_connection = std::chrono::hours{1};
    const StatusServer server(options, render());
    std::vector<StatusClient> many;
    for (int i = 0; i < 24; ++i) {
        many.push_back(StatusClient::at_path(path()));
        many.back().send("GET /metr");
    }
    EXPECT_EQ(body_of(ask(get("/metrics"))), metrics_);
    EXPECT_TRUE(many.front().read_to_end()) << "the oldest connection must be closed";
}

TEST_F(StatusServerTest, BrokenRequestsAndHastyGoodbyesChangeNothing) {
    const StatusServer server(impatient(), render());
    for (const std::string& request :
         {std::string(3000, '\0'), std::string(100'000, '\xFF'), std::string{"\r\n\r\n\r\n"},
          std::string{"GET\r\n\r\n"}, std::string{"GET /metrics HTTP/9.9\r\n\r\n"},
          std::string{"GET /metrics HTTP/1.0\r\nContent-Length: -1\r\n\r\n"},
          std::string{
              "GET /metrics HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"}}) {
        StatusClient::at_path(path()).send(request);  // and closes the connection
        EXPECT_TRUE(StatusClient::at_path(path()).is_connected());
        (void)ask(request);
    }
    EXPECT_TRUE(answers());
}

TEST_F(StatusServerTest, APageIsNotMadeAgainForEachWhoAsks) {
    StatusServerOptions options = quick();
    options.freshness = std::chrono::hours{1};
    const StatusServer server(options, render());
    for (int i = 0; i < 50; ++i)
        EXPECT_TRUE(answers());
    EXPECT_EQ(rendered_, 1);
}

TEST_F(StatusServerTest, APageThatCannotBeMadeEndsNothing) {
    std::atomic<bool> fails = true;
    const StatusServer server(quick(), [&](StatusPage) -> std::string {
        if (fails) throw std::bad_alloc();
        return metrics_;
    });
    EXPECT_EQ(ask(get("/metrics")), "");
    fails = false;
    EXPECT_TRUE(answers());
}

TEST_F(StatusServerTest, ThePortIsOfThisMachineAlone) {
    StatusServerOptions options = quick();
    options.http_port = testing::free_port();
    const StatusServer server(options, render());
    EXPECT_EQ(body_of(StatusClient::at_port(options.http_port).ask(get("/metrics"))), "x 1\n");
    std::ifstream sockets("/proc/self/net/tcp");
    const std::string all{std::istreambuf_iterator<char>(sockets), {}};
    const std::string port = fmt::format(":{:04X} ", options.http_port);
    EXPECT_NE(all.find("0100007F" + port), std::string::npos);
    EXPECT_EQ(all.find("00000000" + port), std::string::npos);
}

// 2026-11-25: the server answered a web page whose host name had the address of this machine (DNS
// rebinding), and the browser let the page read the answer.
TEST_F(StatusServerTest, APortAnswersNobodyWhoMeansAnotherHost) {
    StatusServerOptions options = quick();
    options.http_port = testing::free_port();
    const StatusServer server(options, render());
    const auto status_of = [&](const std::string& fields, bool at_port = true) {
        const std::string request = "GET /metrics HTTP/1.1\r\n" + fields + "\r\n";
        const std::string answer =
            at_port ? StatusClient::at_port(options.http_port).ask(request) : ask(request);
        EXPECT_TRUE(says_how_to_take_it(answer)) << answer;
        return answer.size() < 12 ? "none" : answer.substr(9, 3);
    };
    const std::string with_port = fmt::format("Host: localhost:{}\r\n", options.http_port);
    EXPECT_EQ(status_of(with_port), "200");
    EXPECT_EQ(status_of("Host: 127.0.0.1\r\n"), "200");
    EXPECT_EQ(status_of("host: [::1]\r\n"), "200");
    EXPECT_EQ(status_of("Host: evil.example\r\n"), "421");
    EXPECT_EQ(status_of("hOST: evil.example\r\n"), "421");
    EXPECT_EQ(status_of(fmt::format("Host: evil.example:{}\r\n", options.http_port)), "421");
    EXPECT_EQ(status_of("Host: localhost:1\r\n"), "200") << "the request came through a tunnel";
    EXPECT_EQ(status_of("Host:\r\n"), "421");
    EXPECT_EQ(status_of(with_port + "Host: evil.example\r\n"), "421")
        << "one of two Host fields is foreign";
    EXPECT_EQ(status_of("Host: evil.example\r\n" + with_port), "421");
    EXPECT_EQ(status_of("Host: evil.example\r\n", false), "200") << "the socket accepts any host";
    EXPECT_EQ(rendered_, 5) << "no page must be rendered for refused requests";
}

// 2026-11-25: a browser could store an answer, or guess another type of content.
TEST_F(StatusServerTest, EveryAnswerSaysHowItIsToBeTaken) {
    const StatusBoard empty;
    const StatusServer server(quick(), pages_of(empty));
    for (const std::string request :
         {"GET /metrics HTTP/1.0", "GET / HTTP/1.0", "DELETE / HTTP/1.0", "HEAD / HTTP/1.0"}) {
        const std::string answer = ask(request + "\r\n\r\n");
        EXPECT_TRUE(says_how_to_take_it(answer)) << request << ": " << answer;
    }
}

// Begins to open silent connections to the port, without waiting until any is accepted.
std::vector<Descriptor> silent_connections(int port, int count) {
    std::vector<Descriptor> all;
    for (int i = 0; i < count; ++i) {
        all.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
        const sockaddr_in address = testing::loopback_address(port);
        ::connect(all.back().number(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    }
    return all;
}

// Waits until all sockets are connected, at most 10 s for each.
bool all_are_connected(const std::vector<Descriptor>& sockets) {
    return std::all_of(sockets.begin(), sockets.end(), [](const Descriptor& socket) {
        pollfd connects{socket.number(), POLLOUT, 0};
        return ::poll(&connects, 1, 10'000) == 1 && (connects.revents & POLLOUT) != 0 &&
               (connects.revents & (POLLERR | POLLHUP)) == 0;
    });
}

std::ptrdiff_t open_descriptors() {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return std::distance(begin(all), end(all));
}

// 2026-11-25: the kernel queued 16 connections for the server and dropped the other connections,
// which tried again after 1 s and after 3 s. At the limit, the server slept, although it had cut
// connections and so had room for new connections.
TEST_F(StatusServerTest, ABurstOfSilentConnectionsDelaysNobody) {
    constexpr int silent = 200;
    StatusServerOptions options = quick();
    options.retry = std::chrono::minutes{1};  // nothing else wakes the server's thread
    options.http_port = testing::free_port();
    std::promise<void> go_on;
    std::atomic<bool> is_at_a_page = false;
    const StatusServer server(options, [&, goes_on = go_on.get_future().share()](StatusPage) {
        is_at_a_page = true;
        goes_on.wait();
        return metrics_;
    });
    const auto ask_it = [&] {
        return StatusClient::at_port(options.http_port).ask(get("/metrics"));
    };
    // The server's thread is rendering a page while the connections arrive.
    auto first = std::async(std::launch::async, ask_it);
    EXPECT_TRUE(testing::eventually([&] { return is_at_a_page.load(); }));
    const std::ptrdiff_t before = open_descriptors();
    const auto many = silent_connections(options.http_port, silent);
    // Meanwhile the server accepts no connection, so a connection that the kernel dropped would
    // never be connected.
    EXPECT_TRUE(all_are_connected(many));
    const StatusClient second = StatusClient::at_port(options.http_port);
    second.send(get("/metrics"));
    go_on.set_value();
    EXPECT_EQ(body_of(second.read_to_end().value_or("")), metrics_) << "the server slept";
    EXPECT_EQ(body_of(first.get()), metrics_);
    EXPECT_LE(open_descriptors(), before + silent + std::ptrdiff_t{options.most_connections} + 1);
}

TEST_F(StatusServerTest, ASocketOfAKilledDaemonIsTakenOver) {
    {
        auto left = ListeningSocket::at_path(path());
        ASSERT_TRUE(left) << left.error().message;
        std::filesystem::rename(path(), directory_ / "kept");  // so the server does not remove it
    }
    std::filesystem::rename(directory_ / "kept", path());
    const StatusServer server(quick(), render());
    EXPECT_TRUE(answers());
}

TEST_F(StatusServerTest, WhatCannotBeOpenedIsTriedAgain) {
    std::ofstream(path()) << "somebody's file";
    const StatusServer server(quick(), render());
    EXPECT_TRUE(testing::eventually([&] {
        const Status answers = server.answers();
        return !answers && answers.error().message.find(path().native()) != std::string::npos;
    })) << "the server must have tried to open the address";
    std::ifstream file(path());
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>(file), {}}), "somebody's file");
    std::filesystem::remove(path());
    EXPECT_TRUE(answers());
    std::filesystem::remove(path());
    EXPECT_TRUE(answers()) << "a socket that was removed is made again";
}

mode_t mode_of(const std::filesystem::path& path) {
    struct stat found {};
    EXPECT_EQ(::stat(path.c_str(), &found), 0);
    return found.st_mode & 07777;
}

TEST_F(StatusServerTest, TheSocketIsForUserAndGroupAndGoesWithTheServer) {
    const mode_t umask_before = ::umask(0077);
    {
        const StatusServer server(quick(), render());
        EXPECT_TRUE(answers());
        EXPECT_EQ(mode_of(path()), 0660U) << "whatever the umask of files is";
    }
    EXPECT_EQ(::umask(umask_before), 0077U) << "the process must keep its umask";
    EXPECT_FALSE(std::filesystem::exists(path()));
}

}  // namespace
}  // namespace stormcellar::daemon
