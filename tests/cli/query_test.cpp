// Runs `stormcellar catalog` and `stormcellar cache` as a user does, on two real volumes.
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/keep/instance_lock.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::cli {
namespace {

using nlohmann::json;
using testing::ProgramResult;

class QueryTest : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        auto catalog = *catalog::CatalogWriter::open(directory_ / "catalog");
        auto store = *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
        pipeline::Ingestor ingestor(catalog, store, pipeline::small_grid());
        for (const char* name : {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz"}) {
            ASSERT_TRUE(ingestor.ingest(testing::real_file("sequence-kbgm") / name, true));
        }
    }
    void ingest(const fs::path& file) {
        auto catalog = *catalog::CatalogWriter::open(directory_ / "catalog");
        auto store = *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
        pipeline::Ingestor ingestor(catalog, store, {});
        ASSERT_TRUE(ingestor.ingest(file, true));
    }
    ProgramResult run(const Words& arguments) {
        const bool catalog = arguments.at(0) == "catalog";
        return cli::run(with(arguments, {catalog ? "--catalog" : "--cache",
                                         directory_ / (catalog ? "catalog" : "cache")}));
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(QueryTest, CatalogListsVolumesInTimeOrder) {
    const json entries = json_of(run({"catalog", "list", "--station", "KBGM", "--json"}));
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[0]["start_time"], "2005-08-22T02:44:14Z");
    EXPECT_EQ(entries[0]["n_radials"], 4028);  // number in the file
    EXPECT_EQ(entries[1]["state"], "complete");
    EXPECT_EQ(run({"catalog", "list", "--from", "2005-08-22T02:50"}).out.find("024414"),
              std::string::npos);
}

TEST_F(QueryTest, NothingMatchedIsThreeAndBadUsageIsTwo) {
    EXPECT_EQ(run({"catalog", "list", "--from", "2020-01-01"}).status, 3);
    EXPECT_EQ(run({"catalog", "latest", "--station", "KTLX"}).status, 3);
    EXPECT_EQ(run({"cache", "list", "--domain", "KTLX"}).status, 3);
    const auto ran = run({"catalog", "list", "--from", "yesterday"});
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.err.find("--from"), std::string::npos);
    EXPECT_EQ(run({"catalog", "list", "--from", "2006-01-01", "--to", "2005-01-01"}).status, 2);
    EXPECT_EQ(testing::run_stormcellar({"catalog", "list"}).status, 2);
}

TEST_F(QueryTest, LatestAndOldestNameTheirFiles) {
    EXPECT_EQ(json::parse(run({"catalog", "latest", "--station", "KBGM", "--json"}).out)["path"],
              testing::real_file("sequence-kbgm/KBGM20050822_025001.gz").string());
    EXPECT_NE(run({"catalog", "oldest", "--station", "KBGM"}).out.find("024414"),
              std::string::npos);
    EXPECT_NE(run({"catalog", "stations"}).out.find("KBGM"), std::string::npos);
}

TEST_F(QueryTest, GetCopiesRawBytesAndLeavesWhatIsThere) {
    const std::string out = directory_ / "out";
    const Words get = {"catalog",          "get", "--station", "KBGM", "--to",
                       "2005-08-22T02:45", "-o",  out};
    ASSERT_EQ(run(get).status, 0);
    EXPECT_EQ(*read_file(out + "/KBGM20050822_024414.gz"),
              *read_file(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz")));
    EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 1);
    EXPECT_EQ(run(get).status, 2) << "the file exists";
    auto forced = get;
    forced.emplace_back("--force");
    EXPECT_EQ(run(forced).status, 0);
}

// A volume that came as a file for each chunk is copied as one file with the contents of all
// chunks.
TEST_F(QueryTest, GetJoinsTheChunksOfAVolume) {
    const fs::path drop = directory_ / "drop/KLOT";
    fs::create_directories(drop.parent_path());
    fs::copy(testing::real_file("chunks/OPENRADAR_KLOT"), drop);
    ASSERT_EQ(run({"catalog", "rebuild", "--drop", drop.parent_path()}).status, 0);
    const std::string out = directory_ / "out";
    const Words get = {"catalog", "get", "--station", "KLOT", "-o", out};
    const auto ran = run(get);
    ASSERT_EQ(ran.status, 0) << ran.err;
    ASSERT_EQ(ran.out, out + "/KLOT20260328_201457\n");
    const auto described = [](const std::string& path) {
        return json_of(testing::run_stormcellar({"info", path, "--json"}))["sweeps"];
    };
    EXPECT_EQ(described(out + "/KLOT20260328_201457"), described(drop));
    EXPECT_FALSE(described(drop).empty());
    auto decode = get;
    decode.emplace_back("--decode");
    EXPECT_EQ(run(decode).out, out + "/KLOT20260328_201457.nc\n");
    decode.insert(decode.end(), {"--format", "odim"});
    EXPECT_EQ(run(decode).out, out + "/KLOT20260328_201457.h5\n");
    // If a chunk has gone meanwhile, the remaining chunks are copied, with a note.
    fs::remove(drop / "20260328-201457-007-I");
    auto forced = get;
    forced.emplace_back("--force");
    const auto lacking = run(forced);
    EXPECT_EQ(lacking.status, 0);
    EXPECT_NE(lacking.err.find("008-I: chunks are missing before this one"), std::string::npos)
        << lacking.err;
}

TEST_F(QueryTest, GetDecodesEachVolumeToNetcdf) {
    const std::string out = directory_ / "out";
    const Words get = {"catalog", "get", "--station", "KBGM", "-o", out, "--decode"};
    const auto ran = run(get);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out, out + "/KBGM20050822_024414.nc\n" + out + "/KBGM20050822_025001.nc\n");
    // `info` writes the same file.
    const std::string other = directory_ / "other.nc";
    const auto raw = testing::real_file("sequence-kbgm/KBGM20050822_024414.gz");
    ASSERT_EQ(testing::run_stormcellar({"info", raw, "--to", other}).status, 0);
    EXPECT_EQ(*read_file(out + "/KBGM20050822_024414.nc"), *read_file(other));
    fs::resize_file(out + "/KBGM20050822_024414.nc", 10);
    const auto again = run(get);
    EXPECT_EQ(again.status, 2);
    EXPECT_NE(again.err.find("--force replaces it"), std::string::npos) << again.err;
    EXPECT_EQ(fs::file_size(out + "/KBGM20050822_024414.nc"), 10U);
    auto forced = get;
    forced.emplace_back("--force");
    EXPECT_EQ(run(forced).status, 0);
    EXPECT_EQ(*read_file(out + "/KBGM20050822_024414.nc"), *read_file(other));
}

// Each requested volume of a file with four volumes becomes a separate file.
TEST_F(QueryTest, GetDecodesTheVolumesOfAFileThatWereAskedFor) {
    ingest(testing::real_file("volumes/KBBX20060113_170337.gz"));
    const json entries = json::parse(run({"catalog", "list", "--station", "KBBX", "--json"}).out);
    ASSERT_EQ(entries.size(), 4U);
    const auto names = [&](const Words& times) {
        const auto out = directory_ / ("out" + std::to_string(times.size()));
        const Words get = {"catalog", "get", "--station", "KBBX", "-o", out, "--decode"};
        EXPECT_EQ(run(with(get, times)).status, 0);
        std::set<std::string> found;
        for (const auto& entry : fs::directory_iterator(out))
            found.insert(entry.path().filename());
        return found;
    };
    const std::string name = "KBBX20060113_170337_volume";
    EXPECT_EQ(names({}), (std::set{name + "1.nc", name + "2.nc", name + "3.nc", name + "4.nc"}));
    EXPECT_EQ(names({"--from", entries[1]["start_time"], "--to", entries[2]["start_time"]}),
              (std::set{name + "2.nc", name + "3.nc"}));
}

// A file that can no longer be decoded is named; the remaining files are written.
TEST_F(QueryTest, GetDecodesWhatItCanAndNamesTheRest) {
    const auto copy = directory_ / "KBGM20050822_025549.gz";
    fs::copy_file(testing::real_file("sequence-kbgm/KBGM20050822_025549.gz"), copy);
    ingest(copy);
    const auto size = fs::file_size(copy);
    std::ofstream(copy) << std::string(size, 'x');
    const std::string out = directory_ / "out";
    const auto ran = run({"catalog", "get", "--station", "KBGM", "-o", out, "--decode"});
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find(copy.string()), std::string::npos) << ran.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 2);
}

TEST_F(QueryTest, CacheIsListedAndADamagedGridIsNamed) {
    const json grids = json::parse(run({"cache", "list", "--json"}).out);
    ASSERT_EQ(grids.size(), 2U);
    EXPECT_EQ(grids[0]["domain"], "KBGM");
    EXPECT_EQ(json::parse(run({"cache", "stat", "--json"}).out)[0]["grids"], 2);
    EXPECT_EQ(run({"cache", "verify"}).status, 0);
    const std::string path = grids[1]["path"];
    fs::resize_file(path, 5000);
    const auto ran = run({"cache", "verify"});
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find(path), std::string::npos);
    EXPECT_NE(ran.out.find("2 grids checked, 1 bad"), std::string::npos);
}

TEST_F(QueryTest, GetGivesOneFileToStandardOutput) {
    const fs::path kbgm = testing::real_file("sequence-kbgm");
    const Words one = {"catalog",          "get", "--station", "KBGM", "--to",
                       "2005-08-22T02:45", "-o",  "-"};
    const auto raw = run(one);
    ASSERT_EQ(raw.status, 0) << raw.err;
    EXPECT_TRUE(raw.out == testing::file_text(kbgm / "KBGM20050822_024414.gz"));
    auto decoded = one;
    decoded.emplace_back("--decode");
    EXPECT_EQ(run(decoded).out.substr(1, 3), "HDF");
    EXPECT_EQ(run({"catalog", "get", "--station", "KBGM", "-o", "-"}).status, 2);
}

// Two directories of the archive may hold files of the same name.
TEST_F(QueryTest, GetNeverPutsOneFileInThePlaceOfAnother) {
    const fs::path kbgm = testing::real_file("sequence-kbgm");
    fs::create_directory(directory_ / "other");
    const auto copy = directory_ / "other/KBGM20050822_024414.gz";
    fs::copy_file(kbgm / "KBGM20050822_025549.gz", copy);
    ingest(copy);
    const std::string out = directory_ / "out";
    const auto ran = run({"catalog", "get", "--station", "KBGM", "-o", out, "--force"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(*read_file(out + "/KBGM20050822_024414.gz"),
              *read_file(kbgm / "KBGM20050822_024414.gz"));
    EXPECT_EQ(*read_file(out + "/KBGM20050822_024414_2.gz"), *read_file(copy));
    // A file that has changed since it was cataloged is not copied.
    fs::resize_file(copy, 1000);
    const auto changed =
        run({"catalog", "get", "--station", "KBGM", "--from", "2005-08-22T02:55", "-o", out + "2"});
    EXPECT_EQ(changed.status, 1);
    EXPECT_NE(changed.err.find("has 1000 bytes, not"), std::string::npos) << changed.err;
}

TEST_F(QueryTest, AMisspeltOptionIsNamedThoughARequiredOneIsMissing) {
    const auto misspelt = run({"catalog", "get", "--staton", "KBGM"});
    EXPECT_EQ(misspelt.status, 2);
    EXPECT_NE(misspelt.err.find("there is no option --staton; did you mean '--station'?\n"),
              std::string::npos)
        << misspelt.err;
    const auto frame = run({"frame", "a.gz", "--prodct", "volume", "-o", "a.png"});
    EXPECT_EQ(frame.status, 2);
    EXPECT_NE(frame.err.find("there is no option --prodct; did you mean '--product'?\n"),
              std::string::npos)
        << frame.err;
}

TEST_F(QueryTest, AnUnknownStationIsNothingMatchedAndAMisspeltOneIsBadUsage) {
    for (const char* command : {"latest", "oldest"})
        EXPECT_EQ(run({"catalog", command, "--station", "KXXX"}).status, 3);
    const std::string out = directory_ / "out";
    EXPECT_EQ(run({"catalog", "get", "--station", "KXXX", "-o", out}).status, 3);
    const auto misspelt = run({"catalog", "list", "--station", "kbgm"});
    EXPECT_EQ(misspelt.status, 2);
    EXPECT_NE(misspelt.err.find("'kbgm' is not a station"), std::string::npos);
    const auto none = run({"cache", "list", "--domain", "KXXX", "--json"});
    EXPECT_EQ(none.status, 3);
    EXPECT_EQ(json::parse(none.out), json::array());
    EXPECT_NE(none.err.find("nothing matched"), std::string::npos);
}

TEST_F(QueryTest, WhatCannotBePrintedIsAFailure) {
    const std::string command = std::string(STORMCELLAR_PROGRAM) + " catalog stations --catalog " +
                                (directory_ / "catalog").string() + " >/dev/full 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
}

TEST_F(QueryTest, ACatalogIsCheckedAndRebuilt) {
    const std::string drop = testing::real_file("sequence-kbgm");
    const auto sound = run({"catalog", "check"});
    EXPECT_EQ(sound.status, 0) << sound.err;
    EXPECT_NE(sound.out.find("2 files  sound, 0 missing, 0 changed"), std::string::npos)
        << sound.out;
    EXPECT_EQ(run({"catalog", "check", "--station", "KTLX"}).status, 3);
    const auto database = directory_ / "catalog/KBGM.sqlite";
    fs::resize_file(database, fs::file_size(database) - 100);
    const auto damaged = run({"catalog", "check", "--json"});
    EXPECT_EQ(damaged.status, 1);
    EXPECT_EQ(json::parse(damaged.out)["sound"], false);
    EXPECT_FALSE(json::parse(damaged.out)["stations"][0]["damage"].empty());

    {
        const auto daemon = pipeline::InstanceLock::acquire(directory_.path());
        const auto refused = run({"catalog", "rebuild", "--drop", drop});
        EXPECT_EQ(refused.status, 1);
        EXPECT_NE(refused.err.find("while no daemon runs"), std::string::npos) << refused.err;
    }
    const auto rebuilt = run({"catalog", "rebuild", "--drop", drop, "--json"});
    EXPECT_EQ(json_of(rebuilt)["registered"], 5);
    EXPECT_EQ(json::parse(rebuilt.out)["repairs"].size(), 1U);
    EXPECT_EQ(run({"catalog", "check"}).status, 0);
    EXPECT_NE(run({"catalog", "check"}).out.find("set aside before: "), std::string::npos);
}

}  // namespace
}  // namespace stormcellar::cli
