// Tests that grids say in their JSON and in their packed form which echo the service left out.
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/web/served_grids.h"
#include "web/data/grids/packed_grid.h"

namespace stormcellar::web {
namespace {

class LeftOutOfGrids : public ::testing::Test {
  protected:
    // Replaces the small grid by one with these notes.
    void put(std::vector<std::string> notes) {
        grid::Grid grid = served_.small();
        grid.provenance.notes = std::move(notes);
        ASSERT_TRUE(served_.store().commit(
            "KBGM", cache::describe(grid),
            grid::BrickGrid::from(grid, ServedGrids::quantization()).view()));
        served_.grids().refresh();
    }
    nlohmann::json quality() {
        return nlohmann::json::parse(body_of(served_.get(ServedGrids::small_path))).at("quality");
    }
    PackedHeader header() {
        const std::string bytes =
            body_of(served_.get(std::string(ServedGrids::small_path) + "/packed"));
        PackedHeader read;
        EXPECT_GE(bytes.size(), sizeof read);
        if (bytes.size() >= sizeof read) std::memcpy(&read, bytes.data(), sizeof read);
        return read;
    }
    ServedGrids served_;
};

TEST_F(LeftOutOfGrids, IsNoneUnlessANoteSaysSo) {
    EXPECT_TRUE(quality().is_null());
    EXPECT_EQ(header().least_probability, 0);
    EXPECT_EQ(header().left_out_share, 0);
}

TEST_F(LeftOutOfGrids, HasItsThresholdAndShare) {
    const std::string note = "probability of weather at least 0.5; 12.3 % of the echo left out";
    put({"living: 3 sweeps have come", note});
    EXPECT_EQ(quality(), note);
    EXPECT_EQ(header().least_probability, 0.5F);
    EXPECT_EQ(header().left_out_share, 0.123F);
}

TEST_F(LeftOutOfGrids, HasNoShareIfTheSitesOfAMosaicDiffer) {
    const std::string kept = "probability of weather at least 0.5";
    put({"KBGM: " + kept + "; 43.2 % of the echo left out",
         "KDOX: " + kept + "; 97.9 % of the echo left out"});
    EXPECT_EQ(quality(), kept + "; 43 to 98 % of the echo left out");
    EXPECT_EQ(header().least_probability, 0.5F);
    EXPECT_LT(header().left_out_share, 0);
}

}  // namespace
}  // namespace stormcellar::web
