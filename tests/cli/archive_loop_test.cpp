// Runs `stormcellar loop --catalog` as a user does.
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/cache/store.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/pipeline/small_house.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

using pipeline::five_volumes;

const Words two_hours = {"--from", "2005-08-22T02:00", "--to", "2005-08-22T04:00"};

class ArchiveLoop : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        pipeline::catalog_real_volumes(directory_.path(), five_volumes);
        if (HasFatalFailure()) return;
        ::setenv("XDG_CACHE_HOME", (directory_ / "home").c_str(), 1);
    }
    [[nodiscard]] fs::path raw(const std::string& name) const { return directory_ / "drop" / name; }
    [[nodiscard]] Words arguments(const Words& more) const {
        return with({"loop", "--catalog", directory_ / "catalog", "-o", out()},
                    words("--product composite --width 300 --height 200 --no-labels"), more);
    }
    [[nodiscard]] testing::ProgramResult run(const Words& more) const {
        return cli::run(arguments(more));
    }
    // Makes a loop of one station with a coarse grid, which is quick.
    [[nodiscard]] testing::ProgramResult run_station(const Words& more) const {
        const Words station = {"--stations", "KBGM", "--spacing-km", "4", "--extent-km", "400,400"};
        return run(with(station, two_hours, more));
    }
    [[nodiscard]] std::string out() const { return directory_ / "a.webp"; }
    [[nodiscard]] fs::path loops() const { return directory_ / "home" / "stormcellar" / "loops"; }

    testing::TemporaryDirectory directory_;
};

TEST_F(ArchiveLoop, ASecondRunTakesTheGridsThatStandAndWritesTheSameFile) {
    const auto made = json_of(run_station({"--json"}));
    EXPECT_EQ(made["volumes"], 5);
    EXPECT_EQ(made["grids_made"], 5);
    EXPECT_EQ(made["grids_found"], 0);
    EXPECT_EQ(made["frames"], 5);
    EXPECT_EQ(made["domain"], "KBGM");
    EXPECT_TRUE(made["fill_s"].is_number());
    EXPECT_GT(made["cache_bytes"], 0);
    const auto bytes = *read_file(out());
    const auto second = run_station({"--json"});
    const auto found = nlohmann::json::parse(second.out);
    EXPECT_EQ(found["grids_made"], 0);
    EXPECT_EQ(found["grids_found"], 5);
    EXPECT_EQ(*read_file(out()), bytes);
    EXPECT_THAT(second.err, HasSubstr("5 volumes of KBGM: all grids are in"));
    EXPECT_THAT(second.err, HasSubstr("the grids stay in"));
}

// 2026-11-24: a loop drew any file that had the path of a cataloged file.
TEST_F(ArchiveLoop, LeavesOutWhatIsNotTheFileThatWasCataloged) {
    fs::rename(raw(five_volumes[0]), directory_ / "elsewhere");
    fs::create_symlink(directory_ / "elsewhere", raw(five_volumes[0]));
    const auto size = fs::file_size(raw(five_volumes[1]));
    fs::copy_file(raw(five_volumes[4]), raw(five_volumes[1]), fs::copy_options::overwrite_existing);
    fs::resize_file(raw(five_volumes[1]), size);
    const auto ran = run_station({"--json"});
    EXPECT_EQ(json_of(ran)["grids_made"], 3);
    EXPECT_THAT(ran.err, HasSubstr(five_volumes[0] + ": is a symbolic link"));
    EXPECT_THAT(ran.err, HasSubstr(five_volumes[1] + ": is not the file that was cataloged"));
}

TEST_F(ArchiveLoop, DrawsWhatTheCacheDraws) {
    ASSERT_EQ(run_station({"--cache", (directory_ / "c").string(), "--quiet"}).status, 0);
    const auto bytes = *read_file(out());
    const auto cached = testing::run_stormcellar(
        {"loop", "KBGM", "--cache", (directory_ / "c").string(), "--product", "composite",
         "--width", "300", "--height", "200", "--no-labels", "-o", out()});
    ASSERT_EQ(cached.status, 0) << cached.err;
    EXPECT_EQ(*read_file(out()), bytes);
    EXPECT_FALSE(fs::exists(loops()));
}

// 2026-11-22: with `--cache word` every raw file was reported as gone, because the path has no
// parent to sync.
TEST_F(ArchiveLoop, TheCacheMayBeNamedByOneWord) {
    const testing::WorkingDirectory inside(directory_ / "drop");
    const auto result = run_station({"--cache", "word", "--quiet"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(fs::exists(directory_ / "drop" / "word" / "KBGM"));
}

TEST_F(ArchiveLoop, LeavesOutEchoThatIsNoWeather) {
    const Words weather = {"--quality", "0.5", "--json"};
    ASSERT_EQ(json_of(run_station({"--json"}))["grids_made"], 5);
    const auto all = *read_file(out());
    EXPECT_EQ(json_of(run_station(weather))["grids_made"], 5)
        << "grids of weather are in a cache of their own";
    EXPECT_NE(*read_file(out()), all);
    EXPECT_EQ(json_of(run_station(weather))["grids_made"], 0);
}

// 2026-11-30: --storm-motion was refused, though the loop makes the grids.
TEST_F(ArchiveLoop, DrawsVelocitiesRelativeToAGivenMotion) {
    const auto made = [&](const Words& more) {
        const auto result = run_station(with({"--moment", "SRV", "--json"}, more));
        return json_of(result)["grids_made"].get<int>();
    };
    const Words west = {"--storm-motion", "270/20"}, east = {"--storm-motion", "90/20"};
    EXPECT_EQ(made(west), 5);
    const auto bytes = *read_file(out());
    EXPECT_EQ(made(east), 5) << "in a cache of their own";
    EXPECT_NE(*read_file(out()), bytes);
    EXPECT_EQ(made(west), 0);
    EXPECT_EQ(*read_file(out()), bytes);
    // Grids of another motion in a given cache are made again.
    const Words given = {"--cache", (directory_ / "c").string()};
    EXPECT_EQ(made(with(west, given)), 5);
    EXPECT_EQ(made(with(east, given)), 5);
    const auto refused = run_station({"--moment", "VEL", "--storm-motion", "240/15"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("--storm-motion is for the storm-relative velocity, SRV"));
}

TEST_F(ArchiveLoop, GoesOnWhereItWasInterrupted) {
    Words all =
        arguments({"--stations", "KBGM", "--from", "2005-08-22T02:00", "--to", "2005-08-22T04:00",
                   "--threads", "1", "--cache", (directory_ / "c").string()});
    const fs::path grids = directory_ / "c" / "KBGM" / "REF" / "20050822";
    const auto has_one = [&] {
        std::error_code ignored;
        for (const auto& file : fs::directory_iterator(grids, ignored)) {
            if (file.path().extension() == ".scg") return true;
        }
        return false;
    };
    EXPECT_EQ(testing::interrupt_program(STORMCELLAR_PROGRAM, all, has_one), SIGINT);
    EXPECT_FALSE(fs::exists(out()));
    all.emplace_back("--json");
    const auto json = json_of(testing::run_stormcellar(all));
    EXPECT_GE(json["grids_found"], 1);
    EXPECT_EQ(json["grids_found"].get<int>() + json["grids_made"].get<int>(), 5);
    EXPECT_EQ(json["frames"], 5);
}

TEST_F(ArchiveLoop, NamesWhatItLeavesOut) {
    std::ofstream(raw(five_volumes[0]), std::ios::trunc) << "no radar data";
    fs::remove(raw(five_volumes[4]));
    const auto result = run_station({"--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("left out: " + raw(five_volumes[0]).string()));
    EXPECT_THAT(result.err, HasSubstr(raw(five_volumes[4]).string() + ": is gone"));
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["left_out"].size(), 2U);
}

TEST_F(ArchiveLoop, NothingInTheRangeIsNothingThatMatched) {
    const auto range = [&](const std::string& station, const std::string& from,
                           const std::string& to) {
        return run({"--stations", station, "--from", from, "--to", to});
    };
    const auto early = range("KBGM", "1999-01-01T00:00", "1999-01-02T00:00");
    EXPECT_EQ(early.status, 3);
    EXPECT_THAT(early.err, HasSubstr("no volume of these stations"));
    EXPECT_EQ(range("KTLX", "2005-08-22T02:00", "2005-08-22T04:00").status, 3);
    EXPECT_EQ(range("KBGM", "2006-08-22T02:00", "2006-08-22T04:00").status, 3);
    EXPECT_FALSE(fs::exists(out()));
    EXPECT_FALSE(fs::exists(loops()));
}

TEST_F(ArchiveLoop, ASlipInAStationOrADirectoryIsNamed) {
    const auto with_range = [&](const Words& more) { return run(with(more, two_hours)); };
    const auto unknown = with_range({"--stations", "KBGM,KZZZ"});
    EXPECT_EQ(unknown.status, 3);
    EXPECT_THAT(unknown.err, HasSubstr("the catalog has no volume of KZZZ"));
    // 2026-11-29: a mosaic of a derived moment left out every volume.
    EXPECT_THAT(with_range({"--bounds=-77,41,-75,43", "--moment", "VELD"}).err,
                HasSubstr("VELD is made for single stations, not for mosaics"));
    const auto nobody = with_range({"--bounds=10,41,12,43"});
    EXPECT_EQ(nobody.status, 3);
    EXPECT_THAT(nobody.err, HasSubstr("no station in the catalog reaches these bounds"));
    EXPECT_THAT(with_range({"--bounds=-180,-90,180,90"}).err,
                HasSubstr("too wide for a flat projection"));
    // A drop directory is not a cache.
    fs::create_directories(directory_ / "ldm" / "KBGM");
    fs::copy_file(raw(five_volumes[0]), directory_ / "ldm" / "KBGM" / five_volumes[0]);
    const auto drop = run_station({"--cache", (directory_ / "ldm").string()});
    EXPECT_EQ(drop.status, 2);
    EXPECT_THAT(drop.err, HasSubstr("is not a cache: it holds KBGM"));
    const auto no_catalog = testing::run_stormcellar(
        {"loop", "--catalog", (directory_ / "ldm").string(), "--stations", "KBGM", "--from",
         "2005-08-22T02:00", "--to", "2005-08-22T04:00", "-o", out()});
    EXPECT_EQ(no_catalog.status, 1);
    EXPECT_THAT(no_catalog.err, HasSubstr("there is no catalog here"));
    EXPECT_FALSE(fs::exists(out()));
}

// 2026-11-22: if all volumes had grids, the program announced no frames. If a volume had no grid,
// the program announced all frames of the year, though only two frames had volumes.
TEST_F(ArchiveLoop, SaysHowManyMosaicsAreToBeMade) {
    const Words mosaic = words(
        "--bounds=-77,41,-75,43 --spacing-km 4 --levels-km 1,3,5 --domain south --from 2005-01-01 "
        "--to 2005-12-31");
    const auto at = [&](const std::string& interval) {
        return run(with(mosaic, {"--interval", interval}));
    };
    const auto first = at("10min");
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_THAT(first.err, HasSubstr("0 have their grids in"));
    EXPECT_THAT(first.err, ::testing::ContainsRegex("and [1-9][0-9]? mosaics must be made"));
    const auto finer = at("5min");
    ASSERT_EQ(finer.status, 0) << finer.err;
    EXPECT_THAT(finer.err, HasSubstr("5 have their grids in"));
    EXPECT_THAT(finer.err,
                ::testing::ContainsRegex("0 must be read .* and [1-9][0-9]? mosaics must be made"));
}

TEST_F(ArchiveLoop, AGridWhoseFileBrokeSinceStaysAndThatIsSaid) {
    ASSERT_EQ(run_station({}).status, 0);
    std::ofstream(raw(five_volumes[1]), std::ios::trunc) << "no radar data";
    const auto second = run_station({"--json"});
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_THAT(second.err, HasSubstr("the grid that was made from it earlier stays"));
    EXPECT_EQ(nlohmann::json::parse(second.out)["frames"], 5);
}

TEST_F(ArchiveLoop, MakesAMosaicOfTheStationsThatReachTheBounds) {
    const auto json =
        json_of(run({"--bounds=-77,41,-75,43", "--spacing-km", "4", "--levels-km", "1,3,5",
                     "--from", "2005-08-22T02:00", "--to", "2005-08-22T04:00", "--interval",
                     "10min", "--json", "--domain", "south"}));
    EXPECT_EQ(json["domain"], "south");
    EXPECT_EQ(json["frames"], 3);  // 02:50, 03:00 and 03:10
    EXPECT_EQ(json["mosaics_made"], 3);
    EXPECT_EQ(json["from"], "2005-08-22T02:50:00Z");
    const auto other =
        run({"--bounds=10,41,12,43", "--from", "2005-08-22T02:00", "--to", "2005-08-22T04:00"});
    EXPECT_EQ(other.status, 3) << other.err;
}

TEST_F(ArchiveLoop, MakesFramesBetweenTheVolumesOfAStation) {
    const auto json = json_of(run_station({"--interval", "2min", "--json"}));
    EXPECT_EQ(json["frames"], 12);  // 02:48, after the first volume's middle, to 03:10
    EXPECT_EQ(json["interpolated"], 12);
    EXPECT_EQ(json["from"], "2005-08-22T02:48:00Z");
    EXPECT_EQ(json["to"], "2005-08-22T03:10:00Z");
    EXPECT_TRUE(json["between_s"].is_number());
}

TEST_F(ArchiveLoop, ThePrivateCacheGoesWhereThatIsAskedFor) {
    ASSERT_EQ(run_station({"--no-keep-cache"}).status, 0);
    EXPECT_TRUE(fs::is_empty(loops()));
    EXPECT_EQ(run_station({"--no-keep-cache", "--cache", (directory_ / "c").string()}).status, 2);
}

TEST_F(ArchiveLoop, OneProcessFillsACache) {
    const fs::path cache = directory_ / "c";
    auto held = cache::RollingStore::open(real_file_system(), cache, {});
    ASSERT_TRUE(held);
    const auto result = run_station({"--cache", cache.string()});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("another loop of the same grids"));
}

TEST_F(ArchiveLoop, RefusesOptionsThatMakeNoSense) {
    const auto status = [&](const Words& more) { return run(more).status; };
    const auto with_range = [&](const Words& more) { return status(with(more, two_hours)); };
    EXPECT_EQ(with_range({}), 2);  // neither stations nor bounds
    EXPECT_EQ(status({"--stations", "KBGM"}), 2);
    EXPECT_EQ(with_range({"--stations", "kbgm"}), 2);
    EXPECT_EQ(with_range({"--bounds", "1,2,3"}), 2);
    EXPECT_EQ(with_range({"--bounds", "1,5,3,4"}), 2);
    EXPECT_EQ(with_range({"--bounds", "1,2,3,4", "--center", "2,2"}), 2);
    EXPECT_EQ(with_range({"--stations", "KBGM", "--interval", "5 furlongs"}), 2);
    EXPECT_EQ(with_range({"--stations", "KBGM", "--time-method", "magic"}), 2);
    EXPECT_EQ(testing::run_stormcellar(
                  {"loop", "KBGM", "--cache", "x", "--stations", "KBGM", "-o", out()})
                  .status,
              2);
    // The cache "x" does not exist.
    EXPECT_EQ(testing::run_stormcellar({"loop", "--cache", "x", "-o", out()}).status, 1);
}

}  // namespace
}  // namespace stormcellar::cli
