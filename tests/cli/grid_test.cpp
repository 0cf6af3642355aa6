// Runs `stormcellar grid` as a user does.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

class GridTest : public ::testing::Test {
  protected:
    static ProgramResult grid(const Words& arguments) { return run(with({"grid"}, arguments)); }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (directory_.path() / name).string();
    }
    // Expects bad usage: exit status 2, one line with `part`, and no output file.
    void expect_usage(const Words& arguments, const std::string& part) {
        const ProgramResult ran = grid(with(arguments, {"-o", file("out.nc")}));
        EXPECT_EQ(ran.status, 2) << part;
        EXPECT_EQ(ran.out, "");
        EXPECT_NE(ran.err.find(part), std::string::npos) << part << " in " << ran.err;
        EXPECT_FALSE(fs::exists(file("out.nc")));
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(GridTest, BadUsageIsExit2AndNamed) {
    EXPECT_EQ(grid({}).status, 2);
    EXPECT_EQ(grid({"file"}).status, 2) << "the output is missing";
    expect_usage({"a", "--overlap", "mean"}, "--overlap needs several FILEs");
    expect_usage({"a", "--time-method", "blend"}, "--time-method needs several FILEs");
    expect_usage({"a", "b", "--overlap", "min"}, "--overlap takes one of");
    expect_usage({"a", "b", "--time-method", "now"}, "--time-method takes one of");
    expect_usage({"a", "b", "--overlap-km", "0"}, "--overlap-km");
    expect_usage({"a", "b", "--fields", "age"},
                 "--fields age: details of single gates need one FILE; several FILEs have counts "
                 "and weights");
    expect_usage({"a", "b", "--fields", "counts,weight"}, "need one FILE");
    expect_usage({"a", "--fields", "counts"}, "counts and weights need several FILEs");
    expect_usage({"a", "--center", "35"}, "--center");
    expect_usage({"a", "--center", "95,0"}, "not on the earth");
    expect_usage({"a", "--center", "35,x"}, "--center");
    expect_usage({"a", "--extent-km", "100.5,100"}, "not a whole number");
    expect_usage({"a", "--extent-km", "100"}, "--extent-km");
    expect_usage({"a", "--extent-km", "-100,100"}, "extent");
    expect_usage({"a", "--extent-km", "100000,100000"}, "too large");
    expect_usage({"a", "--extent-km", "1e9,1e9"}, "the limit is 16384 cells, 16384 km");
    expect_usage({"a", "--extent-km", "4,4", "--spacing-km", "1e-5"}, "too large");
    expect_usage({"a", "--spacing-km", "0"}, "--spacing-km");
    expect_usage({"a", "--spacing-km", "nan"}, "--spacing-km");
    expect_usage({"a", "--levels-km", "1,x"}, "--levels-km");
    expect_usage({"a", "--levels-km", "1:2"}, "--levels-km");
    expect_usage({"a", "--levels-km", "2:1:0.5"}, "--levels-km");
    expect_usage({"a", "--levels-km", "1:2:0"}, "--levels-km");
    expect_usage({"a", "--levels-km", "1:2:1e-9"}, "at most 1024 levels");
    expect_usage({"a", "--levels-km", "2,1"}, "levels must rise");
    expect_usage({"a", "--moment", "reflectivity"}, "--moment must be REF, VEL, SW");
    expect_usage({"a", "--threads", "0"}, "--threads");
    expect_usage({"a", "--projection", "mercator"}, "latitude_longitude (lat-lon, latlon)");
    expect_usage({"a", "--spacing-deg", "0.01"}, "--spacing-deg");
    expect_usage({"a", "--extent-deg", "4,4", "--projection", "lcc"}, "--extent-deg");
    expect_usage({"a", "--parallels", "30,60"}, "--parallels");
    const Words degrees = {"a", "--projection", "lat-lon", "--center", "35,-97"};
    const auto expect_usage_of = [&](const Words& arguments, const Words& more,
                                     const std::string& part) {
        expect_usage(with(arguments, more), part);
    };
    expect_usage_of(degrees, {"--spacing-deg", "0"}, "--spacing-deg");
    expect_usage_of(degrees, {"--spacing-deg", "1", "--spacing-km", "1"}, "the extent once");
    expect_usage_of(degrees, {"--extent-deg", "4,4", "--extent-km", "9,9"}, "the extent once");
    expect_usage_of(degrees, {"--extent-deg", "4"}, "--extent-deg takes");
    expect_usage_of(degrees, {"--extent-deg", "4,x"}, "--extent-deg takes");
    expect_usage_of(degrees, {"--extent-deg", "4,4.005", "--spacing-deg", "0.01"}, "whole number");
    expect_usage_of(degrees, {"--extent-deg", "4,1e9", "--spacing-deg", "0.1"}, "too large");
    expect_usage_of(degrees, {"--extent-km", "1e9,4"}, "too large");
    expect_usage_of(degrees, {"--extent-deg", "400,1", "--spacing-deg", "0.1"}, "360 degrees");
    expect_usage_of(degrees, {"--extent-deg", "4,120", "--spacing-deg", "0.1"},
                    "ends at the poles");
    const Words cone = {"a", "--projection", "lambert", "--center", "35,-97"};
    expect_usage_of(cone, {"--parallels", "30"}, "--parallels takes");
    expect_usage_of(cone, {"--parallels", "30,-30"}, "opposite");
    expect_usage_of(cone, {"--parallels", "30,90"}, "not at 90");
    expect_usage({"a", "--fields", "age,hight"},
                 "--fields takes age, height_offset, distance, weight or all for one FILE, and "
                 "counts, weights or all for several FILEs, not 'hight'");
    expect_usage({"a", "--fields", "age,"}, "not ''");
    expect_usage({"a", "--time", "yesterday"}, "--time");
    expect_usage({"a", "--no-such-option"}, "--no-such-option");
}

// 2026-11-21: an option with an empty value was ignored.
TEST_F(GridTest, AnOptionWithAnEmptyValueIsBadUsageAndNamed) {
    for (const char* option :
         {"--method", "--tolerance", "--averaging", "--profile", "--effect", "--center",
          "--projection", "--extent-km", "--levels-km", "--moment", "--time", "--fields"}) {
        expect_usage({"a", option, ""}, std::string{option} + ": must not be empty");
    }
    const ProgramResult ran = grid({"a", "-o", ""});
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.err.find("--output: must not be empty"), std::string::npos) << ran.err;
    EXPECT_EQ(grid({"", "-o", file("out.nc")}).status, 2);
}

TEST_F(GridTest, AFileThatCannotBeReadIsExit1AndNamed) {
    std::ofstream(file("empty"));
    for (const std::string& bad : {file("empty"), file("missing"), directory_.path().string()}) {
        const ProgramResult ran = grid({bad, "-o", file("out.nc")});
        EXPECT_EQ(ran.status, 1);
        EXPECT_EQ(ran.out, "");
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        EXPECT_NE(ran.err.find(bad), std::string::npos) << ran.err;
        EXPECT_FALSE(fs::exists(file("out.nc")));
    }
}

TEST_F(GridTest, ReportsFactsAndTimings) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran =
        grid({volume("KTLX19990503_235621.gz"), "-o", file("out.nc"), "--json", "--extent-km",
              "200,100", "--spacing-km", "2", "--levels-km", "0.1:1:0.3", "--center", "-10,20"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err,
              "stormcellar: note: KTLX, at 35.3334,-97.2778, sees no cell of the grid around "
              "-10.0000,20.0000\n");
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json["station"], "KTLX");
    EXPECT_EQ(json["time"], "1999-05-03T23:56:21Z");
    EXPECT_EQ(json["nx"], 100);
    EXPECT_EQ(json["ny"], 50);
    EXPECT_EQ(json["levels_m"], (std::vector<double>{100, 400, 700, 1000}));
    EXPECT_EQ(json["center"], (std::vector<double>{-10, 20}));
    EXPECT_EQ(json["cells"]["not_seen"], 100 * 50 * 4)
        << "the grid is on a different continent from the radar";
    for (const char* phase : {"read_s", "decode_s", "grid_s", "write_s", "total_s"})
        EXPECT_TRUE(json[phase].is_number()) << phase;
    EXPECT_LE(json["read_s"].get<double>() + json["decode_s"].get<double>() +
                  json["grid_s"].get<double>() + json["write_s"].get<double>(),
              json["total_s"].get<double>());
    EXPECT_TRUE(fs::exists(file("out.nc")));
}

TEST_F(GridTest, AllMomentsOfAVolumeAreOneFile) {
    STORMCELLAR_NEED_DATA();
    const auto moments_of = [&](const Words& arguments) {
        const auto json = json_of(
            grid(with(arguments, {"-o", file("out.nc"), "--json", "--extent-km", "60,60"})));
        Words names;
        for (const auto& one : json["moments"])
            names.push_back(one["moment"]);
        return names;
    };
    using Names = Words;
    const std::string of_1999 = volume("KTLX19990503_235621.gz");
    EXPECT_EQ(moments_of({of_1999, "--moment", "all"}), (Names{"REF", "VEL", "SW"}));
    EXPECT_EQ(moments_of({of_1999, "--moment", "VEL,REF,VEL"}), (Names{"REF", "VEL"}));
    const std::string of_2022 = volume("KLOT20220317_000842_V06");
    EXPECT_EQ(moments_of({of_2022, "--moment", "all"}),
              (Names{"REF", "VEL", "SW", "ZDR", "PHI", "RHO", "CFP"}));
    // With several files, all moments have the same instant, though their sweeps have different
    // times.
    EXPECT_EQ(moments_of({of_1999, volume("KTLX19990503_235621.gz"), "--moment", "REF,VEL"}),
              (Names{"REF", "VEL"}));
    const ProgramResult missing = grid({of_1999, "-o", file("no.nc"), "--moment", "REF,RHO"});
    EXPECT_EQ(missing.status, 1);
    EXPECT_NE(missing.err.find("has no sweep with RHO"), std::string::npos) << missing.err;
    EXPECT_FALSE(fs::exists(file("no.nc")));
    fs::remove(file("out.nc"));
    expect_usage({of_1999, "--moment", "REF,ALL"}, "--moment must be REF");
    expect_usage({of_1999, "--moment", "REF,"}, "--moment must be REF");
    expect_usage({of_1999, "--moment", "REF,VEL", "--tolerance", "0.5 dB"}, "VEL is in");
}

TEST_F(GridTest, DealiasedVelocityIsAMomentOfItsOwn) {
    STORMCELLAR_NEED_DATA();
    const std::string of_1999 = volume("KTLX19990503_235621.gz");
    const auto cells_of = [&](const Words& arguments, const char* moment) {
        const auto json = json_of(grid(with({of_1999, "-o", file("out.nc"), "--json"}, arguments)));
        EXPECT_EQ(json.at("moment"), moment);
        return json.at("cells");
    };
    const auto raw = cells_of({"--moment", "VEL"}, "VEL");
    const auto dealiased = cells_of({"--moment", "VEL", "--dealias", "region"}, "VELD");
    EXPECT_FALSE(raw.contains("ambiguous"));
    EXPECT_GT(dealiased.at("ambiguous"), 10);
    EXPECT_GT(dealiased.at("value"), raw.at("value").get<int>() / 2);
    EXPECT_EQ(dealiased.at("not_seen"), raw.at("not_seen"));
    const ProgramResult text = grid({of_1999, "-o", file("out.nc"), "--moment", "VELD"});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("% ambiguous"), std::string::npos) << text.out;
    fs::remove(file("out.nc"));
    expect_usage({of_1999, "--moment", "VEL", "--dealias", "strong"},
                 "it must be off, auto, profile, region or anchored");
    expect_usage({of_1999, "--moment", "VELD", "--dealias", "off"}, "--dealias off does not go");
    expect_usage({of_1999, "--dealias", "auto"}, "--dealias needs --moment VEL");
}

TEST_F(GridTest, QualityLeavesOutEchoThatIsProbablyNoWeather) {
    STORMCELLAR_NEED_DATA();
    const std::string winter = volume("KDMX20220305_232324.trimmed.ar2v");
    const auto values_of = [&](const Words& arguments) {
        const auto json = json_of(grid(with({winter, "-o", file("out.nc"), "--json"}, arguments)));
        return json.at("cells").at("value").get<int>();
    };
    const int all = values_of({}), weather = values_of({"--quality", "0.5"});
    EXPECT_LT(weather, all);
    EXPECT_GT(weather, all / 2);
    EXPECT_EQ(values_of({"--quality", "0"}), all);
    EXPECT_GT(values_of({"--moment", "POW"}), all / 2);
    const ProgramResult text = grid({winter, "-o", file("out.nc"), "--quality", "0.5"});
    EXPECT_NE(text.out.find("probability of weather at least 0.5; "), std::string::npos)
        << text.out;
    fs::remove(file("out.nc"));
    expect_usage({winter, "--quality", "50"}, "--quality must be from 0 to 1");
    expect_usage({winter, "--quality", "nan"}, "--quality must be from 0 to 1");
}

// The plan has a line for each rung of dealiasing and says why the chosen rung is on. The grid is
// made with this rung.
TEST_F(GridTest, APlanChoosesTheRungOfDealiasing) {
    STORMCELLAR_NEED_DATA();
    const auto explained = [&](const std::string& path, const Words& more) {
        const ProgramResult ran = grid(
            with({path, "-o", file("out.nc"), "--moment", "VELD", "--spacing-km", "4", "--explain"},
                 more));
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.out;
    };
    const std::string storm =
        explained(volume("KTLX19990503_235621.gz"), {"--tolerance", "60 m/s"});
    EXPECT_NE(storm.find("Budget: 60 m/s\nChosen: dealiasing: "), std::string::npos) << storm;
    EXPECT_NE(storm.find("Why: how much it matters has no bound."), std::string::npos) << storm;
    for (const char* effect : {"folds_by_wind", "folds_by_neighbors", "folds_by_anchors"})
        EXPECT_NE(storm.find(effect), std::string::npos) << storm;
    const std::string set = explained(volume("KTLX19990503_235621.gz"),
                                      {"--tolerance", "62 m/s", "--dealias", "region"});
    EXPECT_NE(set.find("Chosen: dealiasing: region, frame: "), std::string::npos) << set;
    EXPECT_NE(set.find("Why: set off."), std::string::npos) << set;
    const std::string calm =
        explained(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz"), {});
    EXPECT_NE(calm.find("Chosen: dealiasing: off, frame: "), std::string::npos) << calm;
}

TEST_F(GridTest, AFrameTimeChoosesSweepsAndIsNamed) {
    STORMCELLAR_NEED_DATA();
    const Words common = {
        volume("KLOT20220317_000842_V06"), "-o", file("out.nc"), "--json", "--extent-km", "60,60"};
    const auto facts = [&](const Words& more) { return json_of(grid(with(common, more))); };
    const auto plain = facts({});
    EXPECT_EQ(plain["frame_time"], plain["time"]);
    EXPECT_EQ(plain["fields"].size(), 0U);
    const auto framed = facts({"--time", "2022-03-17T00:10:00Z", "--fields", "weight,age,age"});
    EXPECT_EQ(framed["time"], plain["time"]);
    EXPECT_EQ(framed["frame_time"], "2022-03-17T00:10:00Z");
    EXPECT_EQ(framed["fields"], (Words{"age", "weight"}));
    EXPECT_EQ(facts({"--fields", "all"})["fields"].size(), 4U);
}

// 2026-11-21: a grid for today was made from a volume of 1999 without a note.
TEST_F(GridTest, AFrameTimeFarFromTheVolumeIsNoted) {
    STORMCELLAR_NEED_DATA();
    const auto noted = [&](const std::string& time) {
        const ProgramResult ran = grid({volume("KTLX19990503_235621.gz"), "-o", file("out.nc"),
                                        "--extent-km", "60,60", "--time", time});
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.err;
    };
    const std::string volume_time = " the volume, which is of 1999-05-03T23:56:21Z\n";
    const std::string head = "stormcellar: note: the grid's time is ";
    EXPECT_EQ(noted("2026-05-04"), head + "27 years after" + volume_time);
    EXPECT_EQ(noted("1999-04-30T23:56:21Z"), head + "3 days before" + volume_time);
    EXPECT_EQ(noted("1999-05-03T22:26:21Z"), head + "1.5 hours before" + volume_time);
    EXPECT_EQ(noted("1999-05-04T00:50:00Z"), "") << "less than an hour after its last radial";
}

// 2026-11-21: the message did not say that the file's name may give the station.
TEST_F(GridTest, AVolumeThatNobodyPlacesSaysHowToNameIt) {
    STORMCELLAR_NEED_DATA();
    const std::string nameless = volume("example_nexrad_archive_msg1.bz2");
    const ProgramResult ran = grid({nameless, "-o", file("out.nc")});
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("name the radar with --station ICAO"), std::string::npos) << ran.err;
    fs::copy_file(nameless, file("KTLX_msg1.bz2"));
    EXPECT_EQ(json_of(grid({file("KTLX_msg1.bz2"), "-o", file("out.nc"), "--json"}))["station"],
              "KTLX");
}

TEST_F(GridTest, OddVolumesAreGriddedOrRefusedWithAReason) {
    STORMCELLAR_NEED_DATA();
    for (const auto& entry : fs::directory_iterator(testing::real_file("volumes"))) {
        const ProgramResult ran =
            grid({entry.path(), "-o", file("out.nc"), "--extent-km", "60,60"});
        EXPECT_TRUE(ran.status == 0 || ran.status == 1) << entry.path() << " " << ran.status;
        EXPECT_EQ(ran.status == 0, fs::exists(file("out.nc"))) << entry.path();
        if (ran.status == 1) {
            EXPECT_NE(ran.err.find(entry.path()), std::string::npos) << ran.err;
        }
        fs::remove(file("out.nc"));
    }
}

TEST_F(GridTest, AVolumeWithoutRadialsHasNothingToGrid) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = grid({volume("KFDR20160420_214957_V06.gz"), "-o", file("out.nc")});
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("no sweep with REF"), std::string::npos) << ran.err;
}

TEST_F(GridTest, OfSeveralVolumesTheFirstIsTakenAndSaidSo) {
    STORMCELLAR_NEED_DATA();
    EXPECT_NE(
        json_of(grid({volume("KBBX20060113_170337.gz"), "-o", file("out.nc"), "--json"}))["notes"]
            .dump()
            .find("this is number 1"),
        std::string::npos);
}

TEST_F(GridTest, WhatCannotBeWrittenIsExit1) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = grid(
        {volume("KTLX19990503_235621.gz"), "-o", file("no/such/out.nc"), "--extent-km", "20,20"});
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("no/such"), std::string::npos) << ran.err;
}

TEST_F(GridTest, TheVolumeItselfAndThingsThatAreNoFilesStay) {
    STORMCELLAR_NEED_DATA();
    fs::copy_file(volume("KLBB20160601_150025_V06"), file("volume"));
    const auto size = fs::file_size(file("volume"));
    const auto itself = grid({file("volume"), "-o", file("volume")});
    EXPECT_EQ(itself.status, 2);
    EXPECT_NE(itself.err.find("this is the input file itself"), std::string::npos);
    EXPECT_EQ(fs::file_size(file("volume")), size);
    ASSERT_EQ(::mkfifo(file("fifo").c_str(), 0600), 0);
    EXPECT_EQ(grid({file("volume"), "-o", file("fifo")}).status, 1);
    EXPECT_TRUE(fs::is_fifo(file("fifo")));
    expect_usage({file("volume"), "--extent-km", "16384,16384"}, "cells, more than");
}

}  // namespace
}  // namespace stormcellar::cli
