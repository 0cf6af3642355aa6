// Tests inputs that failed once (../shared/data/cases). The README there has the expected results.
#include <chrono>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/file_system.h"
#include "tests/cli/files_and_service.h"

namespace stormcellar::cli {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;

class FieldCases : public FilesAndService {
  protected:
    void SetUp() override {
        FilesAndService::SetUp();
        cases_ = data_ / "cases";
        fs::create_directory(directory_ / "catalog");
        if (!fs::exists(cases_)) GTEST_SKIP() << "no cases beside the real volumes";
    }
    [[nodiscard]] std::string in(const std::string& name) const { return (cases_ / name).string(); }
    nlohmann::json json_of(const Words& arguments) {
        const ProgramResult ran = run(arguments);
        EXPECT_EQ(ran.status, 0) << ran.err;
        errors_ = ran.err;
        return nlohmann::json::parse(ran.out, nullptr, false);
    }
    void rebuild(const std::string& catalog, const std::string& drop, const Words& more = {}) {
        const auto ran =
            run(with({"catalog", "rebuild", "--catalog", catalog, "--drop", drop}, more));
        ASSERT_EQ(ran.status, 0) << ran.err;
    }
    nlohmann::json latest_of_ktlx(const std::string& catalog) {
        return json_of({"catalog", "latest", "--catalog", catalog, "--station", "KTLX", "--json"});
    }
    nlohmann::json list(const std::string& catalog, const Words& more = {}) {
        return json_of(with({"catalog", "list", "--catalog", catalog, "--json"}, more));
    }
    nlohmann::json info(const std::string& file, const Words& more = {}) {
        return json_of(with({"info", file, "--json"}, more));
    }

    fs::path cases_;
    std::string errors_;
};

TEST_F(FieldCases, RadialsMayNameTheirStationInLowerCase) {
    const auto lower = info(in("0-lower-case-station/klbb_chunk"));
    auto whole = info(testing::real_file("volumes/Level2_KLBB_single_chunk").string());
    EXPECT_EQ(lower["n_radials"], 120);
    EXPECT_EQ(lower["site"], "KLBB");
    EXPECT_EQ(lower["sweeps"], whole["sweeps"]);
}

// A frame needs two volumes near its instant, so one volume makes no frame. The program reports
// that and does not crash.
TEST_F(FieldCases, AMosaicAboutACenterNeedsNoStationOfTheTable) {
    const std::string catalog = out("catalog");
    for (const auto& [drop, status] :
         {std::pair{"1-segfault-center/drop", 3}, std::pair{"6-bounds-without-unlisted/drop", 0}}) {
        rebuild(catalog, in(drop), {"--stations", "any"});
        for (const Words& place : {Words{"--center", "35,-97"},
                                   {"--center", "35,-97", "--extent-km", "200,200"},
                                   {"--center", "35,-97", "--projection", "lat-lon"}}) {
            const std::string cache = out(fmt::format("cache-{}-{}", status, place.back()));
            const Words range =
                words("--stations NOP4 --from 2017-01-01 --to 2017-01-02 --spacing-km 4 --quiet");
            const ProgramResult ran =
                run(with({"loop", "--catalog", catalog, "--cache", cache, "-o", out("a.webp")},
                         range, place));
            EXPECT_EQ(ran.status, status) << ran.err;
        }
    }
}

TEST_F(FieldCases, ASiteThatMovedHasItsOwnHeight) {
    for (const char* name : {"RKSG_first_site", "ZKSG_same_bytes_unlisted_name"}) {
        const ProgramResult ran = run({"info", in("2-moved-site-height/") + name});
        EXPECT_THAT(ran.out, HasSubstr("36.9597, 127.0183, 36 m above sea level\n")) << name;
    }
}

TEST_F(FieldCases, MetadataAloneAreNoVolumeAndHideNone) {
    const std::string catalog = out("catalog");
    rebuild(catalog, in("3-mdm-is-latest/drop"));
    const auto latest = latest_of_ktlx(catalog);
    EXPECT_THAT(latest["path"].get<std::string>(), Not(HasSubstr("_MDM")));
    EXPECT_GT(latest["n_radials"], 0);
    EXPECT_EQ(list(catalog).size(), 1U);
}

TEST_F(FieldCases, WhatLiesInTheFutureIsNotTheLatest) {
    const std::string catalog = out("catalog");
    rebuild(catalog, in("5-future-volume-is-latest/drop"));
    const auto latest = latest_of_ktlx(catalog);
    EXPECT_THAT(latest["path"].get<std::string>(), HasSubstr("KTLX_now"));
    const auto stations = json_of({"catalog", "stations", "--catalog", catalog, "--json"});
    EXPECT_THAT(stations[0]["latest"].get<std::string>(), Not(HasSubstr("2049")));
    EXPECT_EQ(list(catalog).size(), 2U);
}

TEST_F(FieldCases, WhereAllLiesInTheFutureTheNewestIsShownWithAWarning) {
    fs::create_directory(out("drop"));
    fs::copy(in("5-future-volume-is-latest/drop/KTLX_radials_of_2049"), out("drop"));
    const std::string catalog = out("catalog");
    rebuild(catalog, out("drop"));
    const auto latest = latest_of_ktlx(catalog);
    EXPECT_THAT(latest["start_time"].get<std::string>(), HasSubstr("2049"));
    EXPECT_THAT(errors_, HasSubstr("is in the future"));
}

TEST_F(FieldCases, BoundsTakeStationsThatOnlyTheirFilesPlace) {
    const std::string catalog = out("catalog");
    rebuild(catalog, in("6-bounds-without-unlisted/drop"), {"--stations", "any"});
    const auto made =
        json_of({"loop", "--catalog", catalog, "--bounds=-98,35,-97,36", "--from",
                 "2017-01-01T02:00", "--to", "2017-01-01T04:00", "--product", "composite",
                 "--cache", out("cache"), "-o", out("a.webp"), "--json", "--spacing-km", "4"});
    EXPECT_THAT(made.dump(), HasSubstr("KTLX-NOP4"));
    EXPECT_TRUE(made["left_out"].empty()) << made["left_out"];
}

TEST_F(FieldCases, OldFilesAreNamedAndPlacedByTheirNameOrByOptions) {
    const std::string directory = in("7-ncei-6500-name/");
    EXPECT_EQ(info(directory + "6500KTLX19910720_160529.gz")["site"], "KTLX");
    const std::string nameless = directory + "KUNR19910720_160529.gz";
    EXPECT_TRUE(info(nameless)["site"].is_null());
    EXPECT_EQ(info(nameless, {"--station", "kunr"})["site"], "KUNR");
    const Words grid = {"grid",        nameless, "-o",          out("a.nc"),
                        "--levels-km", "1",      "--extent-km", "50,50"};
    const ProgramResult unknown = run(grid);
    EXPECT_EQ(unknown.status, 1);
    EXPECT_THAT(unknown.err, HasSubstr("--position LAT,LON,HEIGHT"));
    const auto made =
        json_of(with(grid, {"--station", "KUNR", "--position", "35.33,-97.28,390", "--json"}));
    EXPECT_EQ(made["station"], "KUNR");
    EXPECT_NEAR(made["center"][0], 35.33, 1e-6);
    const ProgramResult no_name = run(with(grid, {"--position", "35.33,-97.28,390"}));
    EXPECT_EQ(no_name.status, 2);
    EXPECT_THAT(no_name.err, HasSubstr("--station"));
}

// 2026-11-28: files of a station that no table has were cataloged under an unknown station, so a
// loop did not find them.
TEST_F(FieldCases, AStationThatNoTableHasIsFiledByWhatItsFileSays) {
    fs::create_directory(directory_ / "drop");
    fs::copy_file(in("files/6-station-not-in-the-table/ROP420240601_220000_V06"),
                  directory_ / "drop/mine.ar2v");
    const std::string catalog = out("catalog");
    rebuild(catalog, out("drop"));
    const auto volumes = list(catalog, {"--station", "ROP4"});
    ASSERT_EQ(volumes.size(), 1U);
    const auto made =
        json_of(with({"loop", "--catalog", catalog, "--cache", out("cache"), "-o", out("a.webp")},
                     words("--stations ROP4 --from 2024-06-01T00:00Z --to 2024-06-02T00:00Z --json "
                           "--product composite --width 400 --height 300")));
    EXPECT_EQ(made["frames"], 1);
}

// 2026-11-28: files that begin with ARCHIVE2 do not name their radar, and the station was looked
// for only at the start of the file's name.
TEST_F(FieldCases, TheStationOfAnOldFileMayBeAnyWordOfItsName) {
    const std::string file = in("files/11-name-of-an-old-file/Level2_KTLX_19990503_2356.ar2v");
    EXPECT_EQ(info(file)["site"], "KTLX");
    for (const char* name : {"19990503_235621_KTLX.gz", "NEXRAD_KTLX.dat"}) {
        fs::copy_file(file, directory_ / name);
        EXPECT_EQ(info(out(name))["site"], "KTLX") << name;
    }
}

// 2026-11-28: a directory with chunks of two volumes was refused, but the bucket reuses its
// directories.
TEST_F(FieldCases, OfChunksOfTwoVolumesTheNewestIsTaken) {
    const std::string chunks = in("files/8-chunks-of-two-volumes/KTLX/589");
    const auto start = [&](const Words& words) {
        const auto json = json_of(with({"info", "--json"}, words));
        return json["volume_header"]["time"].get<std::string>().substr(11, 5);
    };
    EXPECT_EQ(start({chunks}), "22:02");
    EXPECT_EQ(start({chunks, "--volume", "1"}), "22:00");
    const ProgramResult none = run({"info", chunks, "--volume", "3"});
    EXPECT_EQ(none.status, 2);
    EXPECT_THAT(none.err, HasSubstr("holds chunks of only 2 volumes"));
    EXPECT_THAT(run({"info", chunks}).err, HasSubstr("holds chunks of 2 volumes"));
    const auto time_of_frame = [&](const Words& words) {
        const auto json = json_of(with({"frame", "--product", "composite", "--width", "400",
                                        "--height", "300", "-o", out("a.png"), "--json"},
                                       words));
        return json["time"].get<std::string>().substr(11, 5);
    };
    EXPECT_EQ(time_of_frame({chunks}), "22:02");
    EXPECT_EQ(time_of_frame({chunks, "--volume", "1"}), "22:00");
    // A shell makes these names from 20240601-220000-*.
    Words named;
    for (const auto& entry : fs::directory_iterator(chunks)) {
        if (entry.path().filename().native().starts_with("20240601-220000-"))
            named.push_back(entry.path());
    }
    ASSERT_EQ(named.size(), 16U);
    EXPECT_EQ(start(named), "22:00");
    EXPECT_EQ(time_of_frame(named), "22:00");
    const auto gridded =
        json_of(with({"grid", "-o", out("b.nc"), "--extent-km", "100,100", "--json"}, named));
    EXPECT_EQ(gridded["station"], "KTLX");
}

// --volume also chooses among the volumes of one file.
TEST_F(FieldCases, AVolumeOfAFileMayBeChosen) {
    const std::string file = (cases_.parent_path() / "volumes/KBBX20060113_170337.gz").native();
    if (!fs::exists(file)) GTEST_SKIP() << file;
    const auto grid = [&](const char* number) {
        return run({"grid", file, "--volume", number, "-o", out("a.nc"), "--extent-km", "20,20",
                    "--levels-km", "1,2", "--json"});
    };
    const ProgramResult second = grid("2");
    EXPECT_EQ(second.status, 0) << second.err;
    EXPECT_THAT(second.out + second.err, HasSubstr("this is number 2"));
    EXPECT_EQ(grid("5").status, 2);
}

TEST_F(FieldCases, ChunksNamedByTheirLdmKeyAreOneVolume) {
    const std::string catalog = out("catalog");
    rebuild(catalog, in("9-ldm-key-chunk-names/drop"));
    const auto volumes = list(catalog);
    ASSERT_EQ(volumes.size(), 1U);
    EXPECT_EQ(volumes[0]["n_radials"], 360);
    EXPECT_EQ(list(catalog, {"--rejected"}).size(), 1U)
        << "the other chunks have no line of their own";
    // A chunk must not be taken for a volume, even if its name does not show that it is a chunk.
    fs::create_directory(directory_ / "drop");
    fs::create_directory(directory_ / "other");
    fs::copy_file(in("9-ldm-key-chunk-names/drop/L2-BZIP2_KLOT_20201019054806_34_2_I_V06_0"),
                  directory_ / "drop" / "KLOT_part");
    rebuild(out("other"), out("drop"));
    const auto lone = list(out("other"));
    EXPECT_THAT(lone[0]["reason"].get<std::string>(), HasSubstr("looks like one chunk"));
}

TEST_F(FieldCases, AMessage5ThatCountsMoreCutsThanItHoldsIsNotBelieved) {
    const auto json = info(in("10-pattern-17-of-7/KTLX_msg5_17"));
    EXPECT_TRUE(json["vcp_message"].is_null());
    EXPECT_THAT(json["problems"].dump(), HasSubstr("does not hold the cuts that it counts"));
}

TEST_F(FieldCases, AnOutputsEndingDecidesItsFormat) {
    const std::string file = in("11-grid-output-name/KTLX_any");
    const Words small = {"--levels-km", "1", "--extent-km", "50,50"};
    const auto grid = [&](const Words& more) { return run(with({"grid", file}, more, small)); };
    const ProgramResult tif = grid({"-o", out("picture.tif")});
    EXPECT_EQ(tif.status, 2);
    EXPECT_THAT(tif.err, HasSubstr(".nc"));
    EXPECT_FALSE(fs::exists(out("picture.tif")));
    EXPECT_EQ(run({"info", file, "--to", out("x.tif")}).status, 2);

    const ProgramResult piped = grid({"-o", "-"});
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(grid({"-o", out("a.nc")}).status, 0);
    EXPECT_TRUE(piped.out.starts_with("\x89HDF")) << "netCDF alone goes to standard output";
    EXPECT_GT(piped.out.size(), 5000U);
    const ProgramResult both = grid({"-o", "-", "--json"});
    EXPECT_EQ(both.status, 2);
    EXPECT_TRUE(both.out.empty());
    EXPECT_TRUE(run({"info", file, "--to", "-"}).out.starts_with("\x89HDF"));
}

TEST_F(FieldCases, VolumesFarApartInTimeDoNotBlend) {
    const std::string two = in("13-mosaic-years-apart/");
    const auto made =
        json_of(with({"grid", two + "KTLX_2017", two + "NOP4_2021", "-o", out("a.nc")},
                     words("--levels-km 1 --spacing-km 4 --json")));
    EXPECT_THAT(made["time"].get<std::string>(), HasSubstr("2021"));
    EXPECT_EQ(made["stations"], Words{"NOP4"});
    EXPECT_THAT(made["notes"].dump(), HasSubstr("KTLX_2017 is left out"));
}

TEST_F(FieldCases, TheSevenOfTheMosaicStaySeven) {
    Words arguments = {"grid"};
    for (const auto& entry : fs::directory_iterator(testing::real_file("mosaic-northeast")))
        arguments.push_back(entry.path().string());
    const std::size_t count = arguments.size() - 1;
    const auto made = json_of(
        with(arguments, {"-o", out("a.nc"), "--levels-km", "1", "--spacing-km", "8", "--json"}));
    EXPECT_EQ(made["stations"].size(), count);
}

}  // namespace
}  // namespace stormcellar::cli
