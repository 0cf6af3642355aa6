// Tests the texts of storm cells, with other readers: a JSON parser, GDAL and a parser of CSV.
#include "stormcellar/export/cell_text.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/export/tracked_cells.h"
#include "tests/testing/program.h"

namespace stormcellar::cell_export {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(CellText, JsonHasAllValuesAndLeavesOutUnknownOnes) {
    const json scan = json::parse(cells_json({cells_time, "KTLX", two_tracked_cells(), {}}));
    EXPECT_EQ(scan["area"], "KTLX");
    EXPECT_EQ(scan["time"], "2013-05-20T20:00:00Z");
    ASSERT_EQ(scan["cells"].size(), 2U);
    const json& known = scan["cells"][0];
    EXPECT_EQ(known["origin"], "split");
    EXPECT_EQ(known["parents"], json({"20130520_193000_35.20N_97.90W"}));
    EXPECT_EQ(known["latitude_deg"], 35.33333);
    EXPECT_EQ(known["mesh_mm"], 38.1);
    EXPECT_EQ(known["azimuthal_shear_per_s"], 0.0123);
    EXPECT_EQ(known["top_is_at_least"], true);
    EXPECT_EQ(known["motion_east_mps"], 10);
    EXPECT_EQ(known["past"][0]["time"], "2013-05-20T19:55:00Z");
    EXPECT_EQ(known["forecasts"][1]["minutes"], 60);
    EXPECT_EQ(known["forecasts"][1]["error_m"], 15000);
    const json& fresh = scan["cells"][1];
    EXPECT_EQ(fresh["origin"], "new");
    for (const char* name : {"mesh_mm", "azimuthal_shear_per_s", "motion_east_mps"})
        EXPECT_FALSE(fresh.contains(name)) << name;
    EXPECT_TRUE(fresh["forecasts"].empty());
}

// RFC 7946: section 3.1.1 has longitude first; section 3.1.4 wants two positions of a line.
TEST(CellText, GeojsonHasAPointATrackAndAForecast) {
    const json features =
        json::parse(cells_geojson({cells_time, "KTLX", two_tracked_cells(), {}}))["features"];
    ASSERT_EQ(features.size(), 4U);
    const json& point = features[0];
    EXPECT_EQ(point["type"], "Feature");
    EXPECT_EQ(point["geometry"], json({{"type", "Point"}, {"coordinates", {-97.5, 35.33333}}}));
    EXPECT_EQ(point["properties"]["kind"], "cell");
    EXPECT_EQ(point["properties"]["max_dbz"], 62.5);
    EXPECT_EQ(features[1]["properties"]["kind"], "track");
    EXPECT_EQ(features[1]["geometry"]["coordinates"], json({{-97.51, 35.32}, {-97.5, 35.33333}}));
    EXPECT_EQ(features[2]["properties"]["errors_m"], json({0, 4000, 15000}));
    EXPECT_EQ(features[2]["geometry"]["coordinates"].size(), 3U);
    EXPECT_EQ(features[3]["geometry"]["type"], "Point");
    EXPECT_TRUE(json::parse(cells_geojson({}))["features"].empty());
}

TEST(CellText, NamesTheAssumedFreezingLevelsAndTheRangeOfMesh) {
    const retrieve::TrackedScan scan{cells_time, "KTLX", two_tracked_cells(),
                                     retrieve::FreezingLevels{3900, 7000}};
    for (const std::string& text : {cells_json(scan), cells_geojson(scan)}) {
        const json all = json::parse(text);
        EXPECT_EQ(all["assumed_freezing_levels_m"], json({3900, 7000}));
        EXPECT_EQ(all["freezing_levels_error_m"], 300);
    }
    const json point = json::parse(cells_geojson(scan))["features"][0]["properties"];
    EXPECT_EQ(point["mesh_least_mm"], 33.2);
    EXPECT_EQ(point["mesh_most_mm"], 43);
    const json without = json::parse(cells_json({cells_time, "KTLX", two_tracked_cells(), {}}));
    EXPECT_FALSE(without.contains("assumed_freezing_levels_m"));
    EXPECT_FALSE(without["cells"][1].contains("mesh_least_mm"));
}

TEST(CellText, GdalOpensTheGeojson) {
    constexpr const char* ogr_info = "/usr/bin/ogrinfo";
    if (!std::filesystem::exists(ogr_info))
        GTEST_SKIP() << "GDAL's programs are not installed (scripts/install-packages test)";
    const testing::TemporaryDirectory directory;
    const auto file = directory.path() / "cells.geojson";
    std::ofstream(file) << cells_geojson({cells_time, "KTLX", two_tracked_cells(), {}});
    const auto ran = testing::run_program(ogr_info, {"-ro", "-al", file.string()});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "") << "GDAL must not warn";
    for (const char* part :
         {"Feature Count: 4", "POINT (-97.5 35.33333)", "max_dbz (Real) = 62.5",
          "LINESTRING (-97.51 35.32,-97.5 35.33333)", "WGS 84", "top_is_at_least"})
        EXPECT_THAT(ran.out, HasSubstr(part));
}

TEST(CellText, CsvHasARowForEachCellAndEmptyUnknownFields) {
    std::istringstream text(cells_csv(two_tracked_cells()));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(text, line);) {
        ASSERT_EQ(line.back(), '\r');  // RFC 4180, section 2.1
        line.back() = ',';             // ends the last field, so that getline() finds it if empty
        std::istringstream fields(line);
        rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');)
            rows.back().push_back(field);
    }
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[1].size(), rows[0].size());
    EXPECT_EQ(rows[2].size(), rows[0].size());
    const auto field = [&](std::size_t row, const char* name) {
        const auto column = std::ranges::find(rows[0], name) - rows[0].begin();
        return rows[row].at(static_cast<std::size_t>(column));
    };
    EXPECT_EQ(field(1, "latitude_deg"), "35.33333");
    EXPECT_EQ(field(1, "top_is_at_least"), "true");
    EXPECT_EQ(field(1, "error_60min_m"), "15000");
    EXPECT_EQ(field(1, "error_30min_m"), "");  // this cell has no such forecast
    EXPECT_EQ(field(2, "mesh_mm"), "");
    EXPECT_EQ(field(2, "max_dbz"), "45.0");
}

}  // namespace
}  // namespace stormcellar::cell_export
