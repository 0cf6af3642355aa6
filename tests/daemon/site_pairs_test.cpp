// Runs the real program on files of two simulated radars. One of the radars measures values that
// are too low.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/running_daemon.h"
#include "tests/testing/two_radar_files.h"

namespace stormcellar::daemon {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(SitePairs, GoToTheLogAndIntoTheStatus) {
    RunningDaemon daemon;
    testing::write_two_radars(daemon.drop(), 2);
    daemon.start(
        "[ingest]\nstations = [\"XSYA\", \"XSYB\"]\n"
        "[[domain]]\nname = \"plains\"\ncenter = [35, -97]\nspacing_km = 2\n"
        "extent_km = [300, 320]\nlevels_km = \"0.5:12:0.5\"\n");
    ASSERT_TRUE(daemon.wait_for([](const json& status) { return !status["sites"].empty(); }))
        << daemon.log();
    const json sites = daemon.status()["sites"];
    EXPECT_EQ(daemon.terminate(), 0);
    ASSERT_EQ(sites.size(), 1U);
    EXPECT_EQ(sites[0]["domain"], "plains");
    EXPECT_EQ(sites[0]["a"], "XSYA");
    EXPECT_EQ(sites[0]["b"], "XSYB");
    EXPECT_EQ(sites[0]["time"], "2024-06-01T22:05:00Z");
    EXPECT_NEAR(sites[0]["bias_db"]["value"].get<double>(), -2, 0.4);
    EXPECT_NEAR(sites[0]["azimuth_deg"]["value"].get<double>(), 0, 0.12);
    EXPECT_NEAR(sites[0]["elevation_deg"]["value"].get<double>(), 0, 0.15);
    EXPECT_NEAR(sites[0]["time_s"]["value"].get<double>(), 0, 12);
    ASSERT_EQ(sites[0]["faults"].size(), 1U) << sites[0];
    EXPECT_THAT(daemon.log(), HasSubstr("sites of plains at 2024-06-01T22:05:00Z: XSYB against "
                                        "XSYA: bias -"));
    EXPECT_THAT(daemon.log(), HasSubstr("sites of plains: XSYB against XSYA: too weak by "));
}

}  // namespace
}  // namespace stormcellar::daemon
