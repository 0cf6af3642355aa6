// Runs `stormcellar cyclone` as a user does, and tests its output and exit status.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

constexpr const char* harvey = "KCRP20170826_044114.trimmed.ar2v";
constexpr const char* katrina = "KLIX20050828_180149.gz";

TEST(CycloneCommand, PrintsCenterWindAndPressureWithTheirErrors) {
    STORMCELLAR_NEED_DATA();
    const auto ran = run({"cyclone", volume(harvey)});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    for (const char* part : {"KCRP  2017-08-26", "center    28.1", "maximum   5", "mean wind ",
                             "pressure  4", " hPa lower than ", "tangential", "  maximum\n"})
        EXPECT_THAT(ran.out, HasSubstr(part));
}

TEST(CycloneCommand, PrintsAllRingsAsJson) {
    STORMCELLAR_NEED_DATA();
    const nlohmann::json found = json_of(run({"cyclone", volume(harvey), "--json"}));
    EXPECT_EQ(found["station"], "KCRP");
    EXPECT_NEAR(found["center"]["latitude_deg"].get<double>(), 28.11, 0.05);
    EXPECT_NEAR(found["center"]["longitude_deg"].get<double>(), -97.01, 0.05);
    EXPECT_GT(found["center"]["error_m"].get<double>(), 0);
    EXPECT_NEAR(found["maximum"]["tangential_mps"]["value"].get<double>(), 57, 2);
    EXPECT_GT(found["maximum"]["tangential_mps"]["error"].get<double>(), 0.5);
    EXPECT_GT(found["pressure_deficit_hpa"]["error"].get<double>(), 1);
    EXPECT_GT(found["rings"].size(), 40U);
}

TEST(CycloneCommand, TakesAFirstGuessAndTheMeanWind) {
    STORMCELLAR_NEED_DATA();
    const nlohmann::json found = json_of(
        run({"cyclone", volume(harvey), "--json", "--near", "28.0,-97.0", "--mean-wind=-2,2.5"}));
    EXPECT_NEAR(found["center"]["latitude_deg"].get<double>(), 28.11, 0.05);
    EXPECT_NEAR(found["mean_wind_across_mps"]["value"].get<double>(), 3.2, 0.2);
    EXPECT_EQ(found["mean_wind_across_mps"]["error"], 2);
}

// The eye of Katrina is 463 km from New Orleans.
TEST(CycloneCommand, RefusesWhatTheRadarCannotShow) {
    STORMCELLAR_NEED_DATA();
    const auto searched = run({"cyclone", volume(katrina)});
    EXPECT_EQ(searched.status, 3);
    EXPECT_EQ(searched.out, "");
    EXPECT_THAT(searched.err, HasSubstr("no hurricane whose center is within 229 km"));
    const auto given = run({"cyclone", volume(katrina), "--near", "26.3,-88.6", "--json"});
    EXPECT_EQ(given.status, 3);
    EXPECT_THAT(given.err,
                HasSubstr("the center is 463 km from the radar, but velocities reach 229 km"));
    EXPECT_EQ(nlohmann::json::parse(given.out)["reason"], "out_of_reach");
    EXPECT_EQ(run({"cyclone", volume("KTLX19990503_235621.gz")}).status, 3);
}

TEST(CycloneCommand, RefusesBadOptions) {
    for (const Words& options : {Words{"--near", "28"},
                                 {"--near", "95,0"},
                                 {"--near", "a,b"},
                                 {"--mean-wind", "1"},
                                 {"--mean-wind", "99,0"}}) {
        const auto ran = run(with({"cyclone", "no-such-file"}, options));
        EXPECT_EQ(ran.status, 2) << options.back();
        EXPECT_THAT(ran.err, HasSubstr(options.front() + " takes "));
    }
    EXPECT_EQ(run({"cyclone", "no-such-file"}).status, 1);
}

}  // namespace
}  // namespace stormcellar::cli
