// Tests the counters, and /metrics of a whole server with a reader as strict as Prometheus.
#include <limits>
#include <regex>

#include <gtest/gtest.h>

#include "stormcellar/base/version.h"
#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/daemon/metrics_reader.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/raw_client.h"
#include "tests/web/setup_below.h"
#include "web/http/counters.h"
#include "web/service/web_service.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
using daemon::read_metrics;

double sample(const std::string& text, const std::string& family, const std::string& series) {
    const auto families = read_metrics(text);
    const auto found = families.find(family);
    if (found == families.end()) return -1;
    const auto value = found->second.samples.find(series);
    return value == found->second.samples.end() ? -1 : value->second;
}
double requests(const std::string& text, const std::string& door, unsigned status) {
    const std::string family = "stormcellar_web_requests_total";
    return sample(text, family,
                  family + "{door=\"" + door + "\",status=\"" + std::to_string(status) + "\"}");
}

TEST(Counters, CountByDoorAndStatus) {
    Counters counters;
    for (const char* prefix : {"/", "/api/v1", "/api/v1/events"})
        counters.add_door(prefix);
    Request request;
    const auto count = [&](const char* path, unsigned status, std::uint64_t bytes) {
        request.path = path;
        counters.count({&request, status, bytes, 3ms});
    };
    count("/", 200, 10);
    count("/api/v1", 200, 20);
    count("/api/v1/grids", 404, 5);
    count("/api/v1/events", 200, 0);
    count("/api/v1x", 404, 1);
    count("/favicon.ico", 404, 1);
    count("/api/v1/grids", 299, 0);
    counters.count({nullptr, 400, 30, 0ms});
    const std::string text = counters.text();
    EXPECT_EQ(requests(text, "/", 200), 1);
    EXPECT_EQ(requests(text, "/api/v1", 200), 1);
    EXPECT_EQ(requests(text, "/api/v1", 404), 1);
    EXPECT_EQ(requests(text, "/api/v1", 0), 1) << "a status that is not in the list";
    EXPECT_EQ(requests(text, "/api/v1/events", 200), 1);
    EXPECT_EQ(requests(text, "other", 404), 2);
    EXPECT_EQ(requests(text, "unread", 400), 1);
    EXPECT_EQ(sample(text, "stormcellar_web_answer_bytes_total",
                     "stormcellar_web_answer_bytes_total{door=\"/api/v1\"}"),
              25);
    const auto bucket = [&](const char* bound) {
        return sample(text, "stormcellar_web_answer_seconds",
                      std::string("stormcellar_web_answer_seconds_bucket{door=\"/api/v1\",le=\"") +
                          bound + "\"}");
    };
    EXPECT_EQ(bucket("0.002"), 0);
    EXPECT_EQ(bucket("0.01"), 3);
    EXPECT_EQ(bucket("+Inf"), 3);
    EXPECT_NEAR(sample(text, "stormcellar_web_answer_seconds",
                       "stormcellar_web_answer_seconds_sum{door=\"/api/v1\"}"),
                0.009, 1e-9);
}

TEST(Counters, ValuesAndLabelsAreWrittenAsPrometheusReadsThem) {
    Counters counters;
    double value = 0.25;
    counters.add_gauge("a_bytes", "Something.", [&] { return value; }, {{"x", "a\"b\\c"}});
    counters.add_counter("b_total", "More.", [] { return 12345678901.0; });
    EXPECT_EQ(sample(counters.text(), "b_total", "b_total"), 12345678901.0);
    EXPECT_NE(counters.text().find("a_bytes{x=\"a\\\"b\\\\c\"} 0.25\n"), std::string::npos);
    value = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(counters.text().find("} NaN\n"), std::string::npos);
}

class Metrics : public ::testing::Test {
  protected:
    Metrics() {
        auto opened = WebService::open(setup_);
        EXPECT_TRUE(opened) << opened.error().message;
        service_ = std::move(*opened);
        note_port();
    }
    void note_port() {
        const std::string url = service_->addresses().at(0);
        port_ = std::stoi(url.substr(url.rfind(':') + 1));
    }
    [[nodiscard]] std::string text() const {
        const std::string answer = RawClient::get(port_, "/metrics");
        EXPECT_EQ(status_in(answer), 200);
        EXPECT_NE(answer.find("Content-Type: text/plain; version=0.0.4"), std::string::npos);
        return body_in(answer);
    }
    [[nodiscard]] double value(const std::string& name) const { return sample(text(), name, name); }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    WebSetup setup_ = setup_below(directory_.path());
    std::unique_ptr<WebService> service_;
    int port_ = 0;
};

TEST_F(Metrics, TellWhatTheServerDidAndHolds) {
    (void)RawClient::get(port_, "/nothing");
    (void)RawClient::get(port_, "/api/v1/domains");
    RawClient refused(port_);
    refused.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
    (void)refused.read_until("\r\n\r\n");
    RawClient events(port_);
    events.send("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    (void)events.read_until("id: ");
    const std::string all = text();
    EXPECT_EQ(requests(all, "other", 404), 1);
    EXPECT_EQ(requests(all, "/api/v1", 200), 1);
    EXPECT_EQ(requests(all, "/api/v1/events", 200), 1);
    EXPECT_EQ(
        sample(all, "stormcellar_web_build_info",
               "stormcellar_web_build_info{version=\"" + std::string(software_version) + "\"}"),
        1);
    EXPECT_EQ(value("stormcellar_web_streams"), 1);
    EXPECT_GE(value("stormcellar_web_connections"), 2);
    EXPECT_EQ(value("stormcellar_web_working_requests"), 1) << "the server works on this request";
    EXPECT_GT(value("stormcellar_web_resident_bytes"), 1 << 20);
    EXPECT_GT(value("stormcellar_web_cpu_seconds_total"), 0);
    EXPECT_EQ(value("stormcellar_web_cache_watched"), 1);
    EXPECT_EQ(value("stormcellar_web_events_total"), 0);
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", testing::noon));
    (void)events.read_until("event: cells");
    EXPECT_EQ(value("stormcellar_web_events_total"), 3);
    EXPECT_EQ(value("stormcellar_web_stations"), 1);
}

TEST_F(Metrics, GoOnAfterAReload) {
    setup_.web.limits.connections = 500;
    ASSERT_TRUE(service_->reload(setup_));
    note_port();
    EXPECT_GE(value("stormcellar_web_connections"), 1);
    setup_.web.serve = {WebPart::grids};
    ASSERT_TRUE(service_->reload(setup_));
    note_port();
    EXPECT_EQ(status_in(RawClient::get(port_, "/metrics")), 404);
}

// docs/web/metrics.md must name each metric of the server, and no other metrics.
TEST_F(Metrics, StandInTheManual) {
    const auto bytes = read_file(testing::source_directory() / "docs/web/metrics.md");
    ASSERT_TRUE(bytes);
    const std::string manual(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const auto families = read_metrics(text());
    EXPECT_GT(families.size(), 10u);
    for (const auto& [name, family] : families)
        EXPECT_NE(manual.find("`" + name), std::string::npos) << name;
    static const std::regex named("`(stormcellar_web_[a-z_]+)");
    for (std::sregex_iterator at(manual.begin(), manual.end(), named), end; at != end; ++at)
        EXPECT_TRUE(families.contains((*at)[1])) << (*at)[1];
}

}  // namespace
}  // namespace stormcellar::web
