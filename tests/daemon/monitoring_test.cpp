// Tests that the dashboard, the alerts and the manual name only metrics that the daemon exports.
#include <cstdlib>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/status/metrics_text.h"
#include "tests/daemon/fake_sink.h"
#include "tests/daemon/metrics_reader.h"
#include "tests/repository/text_of.h"
#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using pipeline::IngestResult;

fs::path monitoring() {
    return testing::source_directory() / "daemon/monitoring";
}

// Returns metrics with a sample in every family.
std::map<std::string, MetricFamily> all_families() {
    StatusBook book("/d", "/c");
    const UtcTime now = *parse_utc("2022-03-17T00:20:00Z", UtcTime{});
    Finished one{.job = {},
                 .taken = Taken{{}, outcome_of(IngestResult::gridded)},
                 .started = {},
                 .ended = {}};
    one.job.closed_at = one.ended;
    one.taken->ingest.newest_radial = now;
    one.taken->ingest.living = {"/c/living.scg"};
    book.add(one, now);
    book.set_usage({.grids = 1, .pinned = 0, .bytes = 1, .budget_bytes = 2});
    book.set_loops({{"a", true, 0, 1, now, 24, ""}});
    Unreadable unreadable;
    unreadable.add("/d/KLOT", "Permission denied");
    book.set_unreadable(unreadable);
    book.set_machines({{.name = "north", .newest = now, .arrived = now}});
    pipeline::PairReport report;
    report.domain = "plains";
    book.add(report);
    return read_metrics(metrics_text(book.facts(), {}, now));
}

// Returns the labels of each metric: the labels of its samples, and the labels that Prometheus
// adds.
std::map<std::string, std::set<std::string>> exported() {
    static const std::regex label(R"re([{,]([a-z_]+)=")re");
    std::map<std::string, std::set<std::string>> labels;
    for (const auto& [name, family] : all_families()) {
        EXPECT_FALSE(family.samples.empty()) << name;
        for (const auto& [series, value] : family.samples) {
            std::set<std::string>& found = labels[series.substr(0, series.find('{'))];
            found.insert({"instance", "job"});
            for (std::sregex_iterator at(series.begin(), series.end(), label), end; at != end; ++at)
                found.insert((*at)[1]);
        }
    }
    return labels;
}

// Checks every metric of ours in a text, with the labels that select its samples.
void check_names(const std::string& text, const std::string& what) {
    static const std::regex use(R"re((stormcellar_[a-z][a-z0-9_]*)(?:\{([^}]*)\})?)re");
    static const std::regex label(R"re((?:^|,)([a-z_]+)(?:=~?|!=)\\?")re");
    const auto known = exported();
    std::size_t uses = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), use), end; at != end; ++at, ++uses) {
        const std::string name = (*at)[1];
        ASSERT_TRUE(known.contains(name)) << what << " names " << name;
        const std::string inside = (*at)[2];
        for (std::sregex_iterator one(inside.begin(), inside.end(), label); one != end; ++one) {
            EXPECT_TRUE(known.at(name).contains((*one)[1]))
                << what << " chooses " << name << " by " << (*one)[1];
        }
    }
    EXPECT_GT(uses, 10U) << what;
}

TEST(Monitoring, TheDashboardNamesWhatIsExported) {
    const std::string text = testing::text_of(monitoring() / "stormcellar-dashboard.json");
    check_names(text, "the dashboard");
    const auto dashboard = nlohmann::json::parse(text);
    std::set<int> ids;
    for (const auto& panel : dashboard["panels"]) {
        EXPECT_TRUE(ids.insert(panel["id"].get<int>()).second) << panel["title"];
        EXPECT_FALSE(panel["targets"].empty()) << panel["title"];
        EXPECT_LE(panel["gridPos"]["x"].get<int>() + panel["gridPos"]["w"].get<int>(), 24);
    }
}

TEST(Monitoring, TheAlertsNameWhatIsExported) {
    check_names(testing::text_of(monitoring() / "stormcellar-alerts.yml"), "an alert");
}

TEST(Monitoring, TheManualExplainsEveryMetricAndEveryAlert) {
    const std::string manual =
        testing::text_of(testing::source_directory() / "docs/reference/metrics.md");
    check_names(manual, "the manual");
    for (const auto& [name, family] : all_families())
        EXPECT_NE(manual.find("`" + name), std::string::npos) << name << " is not explained";
    const std::string alerts = testing::text_of(monitoring() / "stormcellar-alerts.yml");
    static const std::regex alert(R"(- alert: (\w+))");
    int count = 0;
    for (std::sregex_iterator at(alerts.begin(), alerts.end(), alert), end; at != end; ++at) {
        ++count;
        EXPECT_NE(manual.find("| `" + (*at)[1].str() + "` |"), std::string::npos)
            << (*at)[1] << " is not explained";
    }
    EXPECT_GT(count, 10);
}

// Returns the promtool on PATH; empty if there is none.
fs::path find_promtool() {
    const char* path = std::getenv("PATH");
    std::istringstream directories(path == nullptr ? "" : path);
    for (std::string directory; std::getline(directories, directory, ':');)
        if (fs::exists(fs::path{directory} / "promtool")) return fs::path{directory} / "promtool";
    return {};
}

// Runs Prometheus' own tool if it is installed (Debian's package prometheus).
class Promtool : public ::testing::Test {
  protected:
    void SetUp() override {
        if (tool_.empty()) GTEST_SKIP() << "promtool is not installed";
    }
    const fs::path tool_ = find_promtool();
    testing::TemporaryDirectory directory_;
};

TEST_F(Promtool, TakesTheMetrics) {
    StatusBook book("/d", "/c");
    const fs::path file = directory_ / "metrics";
    std::ofstream(file) << metrics_text(book.facts(), {}, now_utc());
    const auto checked = testing::run_program(
        "/bin/sh", {"-c", tool_.native() + " check metrics < " + file.native()});
    EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
}

TEST_F(Promtool, TakesTheAlertsWhichFireWhenTheyShould) {
    fs::copy_file(monitoring() / "stormcellar-alerts.yml", directory_ / "stormcellar-alerts.yml");
    fs::copy_file(testing::source_directory() / "tests/daemon/alerts_test.yml",
                  directory_ / "alerts_test.yml");
    const auto checked =
        testing::run_program(tool_, {"test", "rules", directory_ / "alerts_test.yml"});
    EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
}

}  // namespace
}  // namespace stormcellar::daemon
