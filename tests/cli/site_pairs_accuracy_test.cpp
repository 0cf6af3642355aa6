// Runs `stormcellar accuracy --compare-sites` as a user does, on files of two simulated radars.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/two_radar_files.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SitePairs : public ::testing::Test {
  protected:
    static testing::ProgramResult compare(const std::vector<fs::path>& files,
                                          const Words& options) {
        Words arguments = {"accuracy", "--compare-sites", "--spacing-km", "2"};
        for (const auto& file : files)
            arguments.push_back(file.native());
        return run(with(arguments, options));
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(SitePairs, AFaultIsMeasuredAndNamed) {
    const auto files = testing::write_two_radars(directory_.path(), 2);
    const auto document = json_of(compare(files, {"--json"}));
    EXPECT_EQ(document["stations"], (Words{"XSYA", "XSYB"}));
    ASSERT_EQ(document["pairs"].size(), 1U);
    const auto& pair = document["pairs"][0];
    EXPECT_EQ(pair["a"], "XSYA");
    EXPECT_EQ(pair["b"], "XSYB");
    EXPECT_NEAR(pair["bias_db"]["value"].get<double>(), -2, 0.4);
    EXPECT_GT(pair["bias_db"]["standard_error"].get<double>(), 0);
    EXPECT_NEAR(pair["azimuth_deg"]["value"].get<double>(), 0, 0.12);
    EXPECT_NEAR(pair["elevation_deg"]["value"].get<double>(), 0, 0.15);
    EXPECT_NEAR(pair["time_s"]["value"].get<double>(), 0, 12);
    EXPECT_GT(pair["cells"], 1000);
    ASSERT_EQ(pair["faults"].size(), 1U) << pair["faults"];
    EXPECT_THAT(pair["faults"][0], HasSubstr("XSYB against XSYA: too weak by"));

    const auto printed = compare(files, {});
    ASSERT_EQ(printed.status, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("XSYB against XSYA"));
    EXPECT_THAT(printed.out, HasSubstr("Faults found:\n\n  XSYB against XSYA: too weak by"));
    EXPECT_THAT(printed.out, Not(HasSubstr("What cannot be determined")));
}

// With one volume of each site the motion is unknown, so the clocks cannot be compared.
TEST_F(SitePairs, WhatCannotBeToldSaysWhy) {
    auto files = testing::write_two_radars(directory_.path(), 0);
    files.resize(2);
    const auto document = json_of(compare(files, {"--json"}));
    const auto& pair = document["pairs"][0];
    EXPECT_EQ(pair["time_s"]["untold"], "the motion is not known");
    EXPECT_NEAR(pair["bias_db"]["value"].get<double>(), 0, 0.4);
    EXPECT_TRUE(pair["faults"].empty());
    const auto printed = compare(files, {});
    EXPECT_THAT(printed.out, HasSubstr("No fault was found."));
    EXPECT_THAT(printed.out, HasSubstr("time cannot be determined: the motion is not known"));
    EXPECT_THAT(compare(files, {"--markdown"}).out, HasSubstr("| XSYB against XSYA | "));
}

TEST_F(SitePairs, BadUsageIsSaid) {
    const auto files = testing::write_two_radars(directory_.path(), 0);
    EXPECT_EQ(compare({files[0]}, {}).status, 2);
    EXPECT_EQ(compare(files, {"--held-out"}).status, 2);
    EXPECT_EQ(compare(files, {"--json", "--markdown"}).status, 2);
    const auto one_site = compare({files[0], files[2]}, {});
    EXPECT_EQ(one_site.status, 2);
    EXPECT_THAT(one_site.err, HasSubstr("files of two or more sites"));
    const auto velocity = compare(files, {"--moment", "ZDR"});
    EXPECT_EQ(velocity.status, 2);
    EXPECT_THAT(velocity.err, HasSubstr("compared by REF"));
}

// Most pairs of these seven sites of one night have too little common echo. The program does not
// fail.
TEST_F(SitePairs, OfRealSitesEachPairHasARow) {
    STORMCELLAR_NEED_DATA();
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(testing::real_file("mosaic-northeast")))
        files.push_back(entry.path());
    const auto document = json_of(compare(files, {"--json"}));
    EXPECT_EQ(document["stations"].size(), 7U);
    EXPECT_GE(document["pairs"].size(), 10U);
    EXPECT_THAT(compare(files, {}).out,
                HasSubstr("\n  KDOX against KBGM: nothing can be determined: there is no echo "
                          "where both sites look\n"));
    for (const auto& pair : document["pairs"]) {
        for (const char* what : {"bias_db", "azimuth_deg", "elevation_deg", "time_s"})
            EXPECT_TRUE(pair[what].contains("value") != pair[what].contains("untold")) << pair;
    }
}

}  // namespace
}  // namespace stormcellar::cli
