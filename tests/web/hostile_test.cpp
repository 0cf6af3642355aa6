// Tests the whole data server, with every part on, against hostile and broken clients
// (docs/web.md). STORMCELLAR_WEB_CLIENTS and STORMCELLAR_WEB_REQUESTS set the numbers of clients
// and requests (scripts/test --web).
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"
#include "tests/web/raw_client.h"
#include "tests/web/setup_below.h"
#include "web/service/web_service.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

std::size_t count_from_environment(const char* name, std::size_t usual) {
    const char* text = std::getenv(name);
    return text ? static_cast<std::size_t>(std::strtoull(text, nullptr, 10)) : usual;
}

// Returns a loopback address for each client, because an address has 28,000 ports, and a port
// cannot be used again within a minute.
std::string address_of(std::size_t client) {
    return "127.0." + std::to_string(1 + client / 200) + "." + std::to_string(1 + client % 200);
}

double resident_mib() {
    std::ifstream file("/proc/self/statm");
    double pages = 0, resident = 0;
    file >> pages >> resident;
    return resident * 4096 / 1'048'576;
}

class HostileClients : public ::testing::Test {
  protected:
    HostileClients() {
        grid_ = testing::small_grid();
        commit();
    }
    void commit() {
        (void)store_.commit(
            "KBGM", cache::describe(grid_),
            grid::BrickGrid::from(grid_, grid::default_quantization(level2::Moment::ref)).view());
    }
    void start() {
        auto opened = WebService::open(setup_);
        ASSERT_TRUE(opened) << opened.error().message;
        service_ = std::move(*opened);
        const std::string url = service_->addresses().at(0);
        port_ = std::stoi(url.substr(url.rfind(':') + 1));
    }
    [[nodiscard]] int status_at(std::string_view target) const {
        return status_in(RawClient::get(port_, target));
    }

    static constexpr const char* grid_path = "/api/v1/grids/KBGM/REF/2005-08-22T02:44:14.123Z";

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    grid::Grid grid_;
    WebSetup setup_ = setup_below(directory_.path());
    std::unique_ptr<WebService> service_;
    int port_ = 0;
};

// Clients come from many addresses, because an address has a limit of its own.
TEST_F(HostileClients, IdleConnectionsBeyondTheLimitAreRefused) {
    const std::size_t clients = count_from_environment("STORMCELLAR_WEB_CLIENTS", 300);
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    if (files.rlim_cur < clients + clients / 8 + 200)
        GTEST_SKIP() << "too few descriptors are allowed";
    setup_.web.limits.connections = static_cast<int>(clients) / 8;
    setup_.web.limits.request = 3s;
    start();
    const double before_mib = resident_mib();
    std::vector<std::unique_ptr<RawClient>> idle;
    for (std::size_t i = 0; i < clients; ++i) {
        idle.push_back(std::make_unique<RawClient>(port_, 0, address_of(i)));
    }
    EXPECT_LE(service_->facts().connections, clients / 8);
    EXPECT_LE(resident_mib() - before_mib, 64 + 0.06 * static_cast<double>(clients));
    // The server ends idle connections, so an honest client gets a connection in time.
    EXPECT_TRUE(testing::eventually([&] { return status_at(grid_path) == 200; }));
    for (const auto& client : idle)
        ASSERT_TRUE(!client->is_connected() || client->is_closed(10s));
}

TEST_F(HostileClients, NoIdThatDoesNotExistIsAnswered) {
    start();
    const std::vector<std::string> places = {"/api/v1/grids/{}/REF/latest",
                                             "/api/v1/grids/KBGM/{}/latest",
                                             "/api/v1/grids/KBGM/REF/{}",
                                             "/api/v1/grids/KBGM/REF/{}/packed",
                                             "/api/v1/grids/{}/REF/latest/file",
                                             "/api/v1/stations/{}/volumes/latest/sweeps",
                                             "/api/v1/between/{}/REF/latest",
                                             "/volumes/KTLX/{}",
                                             "/volumes/{}/KTLX20130520_201643_V06.gz",
                                             "/nexrd2/{}/dir.list",
                                             "/nexrd2/KTLX/{}",
                                             "/thredds/fileServer/nexrad/level2/{}/20130520/a",
                                             "/thredds/{}/catalog.xml",
                                             "/s3/{}",
                                             "/s3/unidata-nexrad-level2/2013/05/20/{}/a",
                                             "/zarr/{}/REF/.zgroup",
                                             "/zarr/KBGM/{}/.zmetadata",
                                             "/zarr/KBGM/REF/REF/{}",
                                             "/zarr3/{}/zarr.json",
                                             "/zarr3/volumes/{}/zarr.json",
                                             "/zarr3/volumes/KTLX/{}/zarr.json",
                                             "/frames/{}.png",
                                             "/tiles/{}/composite/latest/0/0/0.png",
                                             "/tiles/KBGM/{}/latest/0/0/0.png",
                                             "/tiles/KBGM/composite/{}/0/0/0.png",
                                             "/tiles/KBGM/composite/latest/{}/0/0.png",
                                             "/loops/{}",
                                             "/{}"};
    std::string overlong(3000, 'A');
    const std::vector<std::string> ids = {"KZZZ",
                                          "%2e%2e",
                                          "..%2f..%2fetc%2fpasswd",
                                          "%00",
                                          "%c0%ae%c0%ae",
                                          "%ff",
                                          "%0d%0aX:%20y",
                                          "9999-99-99T99:99:99Z",
                                          "-1",
                                          "99999999999999999999",
                                          "1e9",
                                          "nan",
                                          "%25s%25n",
                                          "*",
                                          "'--",
                                          "%7b%7d",
                                          ".hidden",
                                          "CON",
                                          "KBGM%20",
                                          "kbgm%2f",
                                          overlong};
    for (const std::string& place : places) {
        for (const std::string& id : ids) {
            const std::size_t at = place.find("{}");
            const std::string target = place.substr(0, at) + id + place.substr(at + 2);
            const int status = status_at(target);
            EXPECT_TRUE(status == 400 || status == 403 || status == 404 || status == 410)
                << status << " at " << target.substr(0, 200);
        }
    }
    EXPECT_EQ(status_at(grid_path), 200);
}

// Sends requests that are cut, changed and joined at random, as a fuzzer would.
TEST_F(HostileClients, ChangedRequestsDoNotHurt) {
    start();
    const std::size_t requests = count_from_environment("STORMCELLAR_WEB_REQUESTS", 300);
    const std::vector<std::string> seeds = {
        "GET /api/v1/grids/KBGM/REF/latest/packed?half=1&by=maximum HTTP/1.1\r\nHost: localhost\r\n"
        "Accept-Encoding: gzip\r\nRange: bytes=0-9,20-\r\n\r\n",
        "GET /thredds/radarServer/nexrad/level2/IDD?stn=KTLX&time=2013-05-20T20:16:43 HTTP/1.1\r\n"
        "Host: localhost\r\nConnection: close\r\n\r\n",
        "HEAD /s3/unidata-nexrad-level2?list-type=2&prefix=2013/&delimiter=%2F&max-keys=3 "
        "HTTP/1.1\r\nHost: 127.0.0.1\r\nIf-None-Match: \"a\"\r\n\r\n",
        "GET /wms?service=WMS&version=1.3.0&request=GetMap&layers=KBGM/composite/REF&crs=EPSG:4326"
        "&bbox=41,-77,43,-75&width=64&height=64&format=image/png HTTP/1.1\r\nHost: localhost\r\n"
        "\r\n",
        "GET /tiles/KBGM/composite/latest/7/36/47.png HTTP/1.0\r\nHost: [::1]:80\r\n\r\n",
        "OPTIONS * HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n",
        "POST /api/v1 HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
        "5\r\nhello\r\n0\r\n\r\n",
        "GET /zarr/KBGM/REF/REF/0.0.0.0 HTTP/1.1\r\nHost: localhost\r\n\r\n"};
    std::mt19937 random(32);
    const auto below = [&](std::size_t limit) { return random() % limit; };
    for (std::size_t i = 0; i < requests; ++i) {
        std::string text = seeds[below(seeds.size())];
        for (std::size_t changes = below(8); changes > 0; --changes) {
            const std::size_t at = below(text.size());
            switch (below(4)) {
                case 0:
                    text[at] = static_cast<char>(random());
                    break;
                case 1:
                    text.insert(at, text.substr(below(text.size()), below(64)));
                    break;
                case 2:
                    text.erase(at, below(16));
                    break;
                default:
                    text.insert(at, below(2) ? "%2e%2e/" : "\r\n");
            }
            if (text.empty()) text = "G";
        }
        RawClient client(port_, 0, address_of(i % 1000));
        client.send(text);
        if (below(4) == 0) continue;  // leaves without waiting
        const std::string answer = client.read_until("\r\n\r\n", 20ms);
        const int status = status_in(answer);
        EXPECT_NE(status, 500) << text;
    }
    EXPECT_EQ(status_at(grid_path), 200);
}

// Many honest clients at the same time each get the bytes that a lone client gets. Memory stays
// within the limits of [web.limits].
TEST_F(HostileClients, ManyClientsGetTheBytesThatOneGets) {
    constexpr std::size_t clients = 16;
    const std::size_t requests = count_from_environment("STORMCELLAR_WEB_REQUESTS", 300);
    start();
    const std::string path = grid_path;
    const std::vector<std::string> targets = {path,
                                              path + "/packed",
                                              path + "/packed?half=1&by=mean",
                                              path + "/file",
                                              path + "/netcdf",
                                              path + "/probe?at=42.2,-75.98",
                                              "/api/v1/grids?domain=KBGM",
                                              "/api/v1/openapi.json"};
    std::vector<std::string> expected;
    for (const std::string& target : targets) {
        expected.push_back(body_in(RawClient::get(port_, target)));
        ASSERT_FALSE(expected.back().empty()) << target;
    }
    const double before_mib = resident_mib();
    std::atomic<std::size_t> others = 0, told_to_come_back = 0;
    std::vector<std::thread> threads;
    for (std::size_t client = 0; client < clients; ++client) {
        threads.emplace_back([&, client] {
            for (std::size_t i = 0; i < requests / clients + 1; ++i) {
                const std::size_t which = (i + client) % targets.size();
                RawClient one(port_, 0, address_of(client));
                one.send("GET " + targets[which] +
                         " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
                const std::string answer = one.read_to_end();
                if (status_in(answer) == 503) {
                    ++told_to_come_back;
                } else if (body_in(answer) != expected[which]) {
                    ++others;
                }
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(others, 0u);
    EXPECT_LT(told_to_come_back, requests / 2)
        << "only requests that need computing may be refused";
    EXPECT_LE(resident_mib() - before_mib, 200);
}

TEST_F(HostileClients, AGridThatIsEvictedWhileItIsSentArrivesWhole) {
    start();
    const std::string path = std::string(grid_path) + "/file";
    const std::string whole = body_in(RawClient::get(port_, path));
    ASSERT_GT(whole.size(), 1000u);
    RawClient slow(port_, 2048);
    slow.send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    std::string answer = slow.read_until("\r\n\r\n");
    fs::remove_all(directory_ / "cache" / "KBGM");
    answer += slow.read_to_end();
    EXPECT_EQ(body_in(answer), whole);
    EXPECT_TRUE(testing::eventually([&] { return status_at(path) == 410; }));
}

TEST_F(HostileClients, ACacheMayVanishAndComeBack) {
    start();
    ASSERT_EQ(status_at(grid_path), 200);
    fs::rename(directory_ / "cache", directory_ / "away");
    EXPECT_TRUE(testing::eventually([&] {
        const int status = status_at(grid_path);
        return status == 404 || status == 410 || status == 503;
    }));
    EXPECT_EQ(status_at("/api/v1/domains"), 200) << "the server goes on";
    fs::rename(directory_ / "away", directory_ / "cache");
    EXPECT_TRUE(testing::eventually([&] {
        service_->look_again();
        return status_at(grid_path) == 200;
    }));
}

}  // namespace
}  // namespace stormcellar::web
