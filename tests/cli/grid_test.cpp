// The program itself, as a user runs it: `stormcellar grid`.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

class GridTest : public ::testing::Test {
  protected:
    static ProgramResult grid(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "grid");
        return testing::run_program(STORMCELLAR_PROGRAM, arguments);
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (directory_.path() / name).string();
    }
    static std::string volume(const std::string& name) {
        return (*testing::data_directory() / "volumes" / name).string();
    }
    // Bad usage: exit 2 and one line that names what is wrong; nothing is written.
    void expect_usage(std::vector<std::string> arguments, const std::string& part) {
        arguments.insert(arguments.end(), {"-o", file("out.nc")});
        const ProgramResult ran = grid(arguments);
        EXPECT_EQ(ran.status, 2) << part;
        EXPECT_EQ(ran.out, "");
        EXPECT_NE(ran.err.find(part), std::string::npos) << part << " in " << ran.err;
        EXPECT_FALSE(std::filesystem::exists(file("out.nc")));
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(GridTest, BadUsageIsExit2AndNamed) {
    EXPECT_EQ(grid({}).status, 2);
    EXPECT_EQ(grid({"file"}).status, 2) << "no output";
    expect_usage({"a", "b"}, "takes one FILE, not 2");
    expect_usage({"a", "--center", "35"}, "--center");
    expect_usage({"a", "--center", "95,0"}, "not on the earth");
    expect_usage({"a", "--center", "35,x"}, "--center");
    expect_usage({"a", "--extent-km", "100.5,100"}, "no whole number");
    expect_usage({"a", "--extent-km", "100"}, "--extent-km");
    expect_usage({"a", "--extent-km", "-100,100"}, "extent");
    expect_usage({"a", "--extent-km", "100000,100000"}, "columns and rows");
    expect_usage({"a", "--spacing-km", "0"}, "--spacing-km");
    expect_usage({"a", "--spacing-km", "nan"}, "--spacing-km");
    expect_usage({"a", "--levels-km", "1,x"}, "--levels-km");
    expect_usage({"a", "--levels-km", "1:2"}, "--levels-km");
    expect_usage({"a", "--levels-km", "2:1:0.5"}, "--levels-km");
    expect_usage({"a", "--levels-km", "1:2:0"}, "--levels-km");
    expect_usage({"a", "--levels-km", "1:2:1e-9"}, "too many levels");
    expect_usage({"a", "--levels-km", "2,1"}, "levels must rise");
    expect_usage({"a", "--moment", "ref"}, "REF VEL SW");
    expect_usage({"a", "--threads", "0"}, "--threads");
    expect_usage({"a", "--no-such-option"}, "--no-such-option");
}

TEST_F(GridTest, AFileThatCannotBeReadIsExit1AndNamed) {
    std::ofstream(file("empty"));
    for (const std::string& bad : {file("empty"), file("missing"), directory_.path().string()}) {
        const ProgramResult ran = grid({bad, "-o", file("out.nc")});
        EXPECT_EQ(ran.status, 1);
        EXPECT_EQ(ran.out, "");
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        EXPECT_NE(ran.err.find(bad), std::string::npos) << ran.err;
        EXPECT_FALSE(std::filesystem::exists(file("out.nc")));
    }
}

TEST_F(GridTest, ReportsFactsAndTimings) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran =
        grid({volume("KTLX19990503_235621.gz"), "-o", file("out.nc"), "--json", "--extent-km",
              "200,100", "--spacing-km", "2", "--levels-km", "0.1:1:0.3", "--center", "-10,20"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json["station"], "KTLX");
    EXPECT_EQ(json["time"], "1999-05-03T23:56:21Z");
    EXPECT_EQ(json["nx"], 100);
    EXPECT_EQ(json["ny"], 50);
    EXPECT_EQ(json["levels_m"], (std::vector<double>{100, 400, 700, 1000}));
    EXPECT_EQ(json["center"], (std::vector<double>{-10, 20}));
    EXPECT_EQ(json["cells"]["not_seen"], 100 * 50 * 4) << "another continent";
    for (const char* phase : {"read_s", "decode_s", "grid_s", "write_s", "total_s"})
        EXPECT_GT(json[phase], 0) << phase;
    EXPECT_LE(json["read_s"].get<double>() + json["decode_s"].get<double>() +
                  json["grid_s"].get<double>() + json["write_s"].get<double>(),
              json["total_s"].get<double>());
    EXPECT_TRUE(std::filesystem::exists(file("out.nc")));
}

TEST_F(GridTest, OddVolumesAreGriddedOrRefusedWithAReason) {
    STORMCELLAR_NEED_DATA();
    for (const auto& entry :
         std::filesystem::directory_iterator(*testing::data_directory() / "volumes")) {
        const ProgramResult ran =
            grid({entry.path(), "-o", file("out.nc"), "--extent-km", "60,60"});
        EXPECT_TRUE(ran.status == 0 || ran.status == 1) << entry.path() << " " << ran.status;
        EXPECT_EQ(ran.status == 0, std::filesystem::exists(file("out.nc"))) << entry.path();
        if (ran.status == 1) {
            EXPECT_NE(ran.err.find(entry.path()), std::string::npos) << ran.err;
        }
        std::filesystem::remove(file("out.nc"));
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
    const ProgramResult ran =
        grid({volume("KBBX20060113_170337.gz"), "-o", file("out.nc"), "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(nlohmann::json::parse(ran.out)["notes"].dump().find("this is number 1"),
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
    std::filesystem::copy_file(volume("KLBB20160601_150025_V06"), file("volume"));
    const auto size = std::filesystem::file_size(file("volume"));
    const auto itself = grid({file("volume"), "-o", file("volume")});
    EXPECT_EQ(itself.status, 2);
    EXPECT_NE(itself.err.find("is the volume itself"), std::string::npos);
    EXPECT_EQ(std::filesystem::file_size(file("volume")), size);
    ASSERT_EQ(::mkfifo(file("fifo").c_str(), 0600), 0);
    EXPECT_EQ(grid({file("volume"), "-o", file("fifo")}).status, 1);
    EXPECT_TRUE(std::filesystem::is_fifo(file("fifo")));
    expect_usage({file("volume"), "--extent-km", "16384,16384"}, "cells, more than");
}

}  // namespace
}  // namespace stormcellar::cli
