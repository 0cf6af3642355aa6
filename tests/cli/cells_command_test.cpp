// Runs `stormcellar cells` as a user does, and tests its output and exit status.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/small_sequence.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// Three volumes of one storm, which moves by 15 m/s to the east and 5 to the north.
class CellsCommand : public ::testing::Test {
  protected:
    void SetUp() override { files_ = testing::write_small_volumes(3, directory_.path()); }
    [[nodiscard]] Words command(const Words& options) const {
        return with({"cells"}, files_, options);
    }

    testing::TemporaryDirectory directory_;
    Words files_;
};

TEST_F(CellsCommand, PrintsATable) {
    const auto ran = run({"cells", files_[0]});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.out, StartsWith("KBGM  2005-08-22T02:44:14Z  1 cell\n"));
    EXPECT_THAT(ran.out, HasSubstr("new"));
}

TEST_F(CellsCommand, WritesEachFormat) {
    const auto json = json_of(run(command({"--json"})));
    ASSERT_EQ(json["cells"].size(), 1U);
    EXPECT_EQ(json["time"], "2005-08-22T02:55:49Z");
    EXPECT_EQ(json["cells"][0]["origin"], "continued");
    EXPECT_EQ(json["cells"][0]["past"].size(), 2U);
    EXPECT_FALSE(json["cells"][0].contains("azimuthal_shear_per_s"));
    const auto csv = run(command({"--to", "csv"}));
    EXPECT_THAT(csv.out, StartsWith("id,time,origin"));
    const std::string file = directory_.path() / "cells.geojson";
    EXPECT_EQ(run(command({"-o", file})).status, 0);
    std::ifstream written(file);
    EXPECT_EQ(nlohmann::json::parse(written)["type"], "FeatureCollection");
    EXPECT_THAT(run(command({"--to", "placefile", "-o", "-"})).out,
                StartsWith("Title: KBGM storm cells"));
}

TEST_F(CellsCommand, DerivesShearOnlyIfAsked) {
    const auto json = json_of(run({"cells", files_[0], "--shear", "--json"}));
    ASSERT_EQ(json["cells"].size(), 1U);
    EXPECT_TRUE(json["cells"][0].contains("azimuthal_shear_per_s"));
}

TEST_F(CellsCommand, RefusesWhatItCannotRead) {
    for (const Words& options :
         {Words{"-o", "cells.png"}, Words{"--to", "kml"}, Words{"--freezing-levels", "4200"},
          Words{"--freezing-levels", "5000,4000"}, Words{"--json", "--to", "csv"},
          Words{"--quality", "2"}}) {
        const auto ran = run(command(options));
        EXPECT_EQ(ran.status, 2) << options.back();
        EXPECT_EQ(ran.out, "") << options.back();
    }
    EXPECT_EQ(run({"cells", "no-such-file"}).status, 1);
    EXPECT_EQ(run({"cells", "no-such-file.scg"}).status, 1);
}

}  // namespace
}  // namespace stormcellar::cli
