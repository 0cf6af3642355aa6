// Tests the keeper of directories into which other machines put partials (grids of one site each,
// from which mosaics are merged). The keeper must take complete partials, wait for incomplete
// partials, and report machines that bring nothing.
#include "daemon/partials/partials_keeper.h"

#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/invented_partials.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using pipeline::InventedPartial;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

const InventedPartial first_of_all{"KBGM", 38, 0, 20};
const InventedPartial early{"KBGM", 44, 0, 20}, later{"KBGM", 50, 0, 25};
const InventedPartial other{"KOKX", 51, 48, 35};

class PartialsKeeperTest : public ::testing::Test {
  protected:
    PartialsKeeperTest() {
        for (const char* name : {"north", "south", "made"})
            fs::create_directory(directory_ / name);
    }
    void start(std::chrono::seconds late_after = std::chrono::seconds{600}) {
        PartialsConfig config;
        config.directories = {directory_ / "north", directory_ / "south"};
        config.late_after = late_after;
        config.stations = stations_;
        sources_ = std::make_shared<pipeline::PartialSources>(late_after);
        mosaics_ =
            std::make_unique<pipeline::MosaicMaker>(&store_, std::vector{pipeline::small_domain()},
                                                    pipeline::FramesWhen::volume_comes, sources_);
        keeper_.emplace(config,
                        PartialsOf{*mosaics_, store_, sources_, std::make_shared<StationRule>(), 1},
                        PartialsTimes{milliseconds{500}, milliseconds{200}});
    }
    // Returns the bytes of a partial and its path below a directory, without writing it.
    std::pair<std::string, fs::path> made(const InventedPartial& partial) {
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / "made", false);
        const fs::path path = pipeline::commit(*store, partial);
        const auto bytes = read_file(path);
        return {{reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                fs::relative(path, directory_ / "made")};
    }
    static void write(const fs::path& path, std::string_view text) {
        fs::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
    }
    // Writes a hidden file and renames it, as rsync does.
    void bring(const std::string& machine, const InventedPartial& partial) {
        const auto [bytes, place] = made(partial);
        const fs::path path = directory_ / machine / place;
        write(path.parent_path() / ("." + path.filename().native() + ".aB3xYz"), bytes);
        fs::rename(path.parent_path() / ("." + path.filename().native() + ".aB3xYz"), path);
    }
    [[nodiscard]] bool is_kept(const InventedPartial& partial) const {
        return fs::exists(*store_.path_of("north." + partial.station, level2::Moment::ref,
                                          pipeline::minute(partial.minute)));
    }
    // Waits until each directory was scanned as a whole this many more times.
    bool is_scanned_again(std::uint64_t times) {
        const std::uint64_t until = keeper_->scans() + 1 + times;  // one scan may be under way
        return testing::eventually([&] { return keeper_->scans() >= until; });
    }
    [[nodiscard]] MachineFacts north() const { return keeper_->facts().at(0); }
    [[nodiscard]] MachineFacts south() const { return keeper_->facts().at(1); }

    std::map<std::string, std::vector<std::string>> stations_;
    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::shared_ptr<pipeline::PartialSources> sources_;
    std::unique_ptr<pipeline::MosaicMaker> mosaics_;
    std::optional<PartialsKeeper> keeper_;
};

TEST_F(PartialsKeeperTest, TakesWhatIsThereAndWhatComesAndMakesFrames) {
    bring("north", early);
    start();
    EXPECT_TRUE(testing::eventually([&] { return is_kept(early); }))
        << "the partial was there at the start";
    bring("north", later);
    bring("south", other);
    EXPECT_TRUE(testing::eventually([&] { return north().taken == 2 && south().taken == 1; }));
    EXPECT_EQ(north().newest, pipeline::minute(52));
    EXPECT_TRUE(north().arrived);
    EXPECT_TRUE(fs::exists(*store_.path_of("north", level2::Moment::ref, pipeline::minute(50))))
        << "the frame between the two volumes";
    keeper_.reset();
    for (const char* machine : {"north", "south"}) {
        for (const auto& entry : fs::recursive_directory_iterator(directory_ / machine)) {
            const bool is_theirs = entry.is_directory() || entry.path().extension() == ".scg";
            EXPECT_TRUE(is_theirs) << entry.path();
        }
    }
}

TEST_F(PartialsKeeperTest, AFileThatIsBeingWrittenIsTakenOnceItIsWhole) {
    start();
    const auto [bytes, place] = made(early);
    const fs::path path = directory_ / "north" / place;
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << std::string_view{bytes}.substr(0, bytes.size() / 2);
    file.flush();
    EXPECT_TRUE(is_scanned_again(1));
    EXPECT_FALSE(is_kept(early));
    EXPECT_EQ(north().refused, 0U) << "a file that may still be arriving is not refused";
    file << std::string_view{bytes}.substr(bytes.size() / 2);
    file.close();
    EXPECT_TRUE(testing::eventually([&] { return is_kept(early); }));
}

TEST_F(PartialsKeeperTest, WhatIsDamagedIsNamedOnceAndTakenWhenItIsReplaced) {
    auto [bytes, place] = made(early);
    const fs::path path = directory_ / "north" / place;
    auto damaged = bytes;
    damaged.back() ^= 1;
    write(path, damaged);
    // Make the file an hour old.
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours{1});
    start();
    EXPECT_TRUE(testing::eventually([&] { return north().refused == 1; }));
    EXPECT_THAT(north().last_problem, HasSubstr("1 of"));
    EXPECT_TRUE(is_scanned_again(3));
    EXPECT_EQ(north().refused, 1U) << "several scans must refuse the file only once";
    bring("north", early);
    EXPECT_TRUE(testing::eventually([&] { return is_kept(early); }));
}

// 2026-11-28: one partial whose codes are not those of its moment, or whose position is impossible,
// prevented all frames near its time, and the log blamed honest stations.
TEST_F(PartialsKeeperTest, APartThatNoMergeTakesIsRefused) {
    std::vector<std::pair<InventedPartial, std::string>> parts(
        4, {{.minute = 44}, "its codes are not those of REF"});
    parts[0].first.has_other_codes = true;
    parts[1] = {{.minute = 44, .latitude_deg = 95}, "is not on the earth"};
    parts[2] = {{.minute = 44, .columns = 24}, "its columns are not whole bricks"};
    parts[3] = {{.minute = 44, .latitude_deg = 20}, "its columns are further than KBGM reaches"};
    for (const auto& [part, why] : parts) {
        bring("south", part);
        const fs::path file = directory_ / "south" / made(part).second;
        // The keeper waits for a younger file, because it may still be incomplete.
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours{1});
        start();
        EXPECT_TRUE(testing::eventually([&] { return south().refused == 1; })) << why;
        EXPECT_THAT(south().last_problem, HasSubstr(why));
        EXPECT_FALSE(is_kept(part)) << why;
        keeper_.reset();
        fs::remove(file);
    }
}

// 2026-11-28: a machine brought partials of 158 invented stations in 40 s, and each frame merged
// all of these partials.
TEST_F(PartialsKeeperTest, StationsThatNobodyKnowsAreRefused) {
    const InventedPartial invented{"QAAA", 44, 0, 20}, listed{"QAAB", 44, 0, 20};
    stations_ = {{"north", {"QAAB"}}};
    bring("south", invented);
    bring("north", listed);
    start();
    EXPECT_TRUE(testing::eventually([&] { return south().refused == 1 && north().taken == 1; }));
    EXPECT_THAT(south().last_problem, HasSubstr("QAAA is not a known station"));
    EXPECT_FALSE(is_kept(invented));
    EXPECT_TRUE(is_kept(listed));
}

// 2026-11-28: any machine could replace partials of another machine's stations.
TEST_F(PartialsKeeperTest, AStationComesFromTheMachinesThatListItAlone) {
    stations_ = {{"north", {"KBGM"}}};
    start();
    bring("south", early);
    EXPECT_TRUE(testing::eventually([&] { return south().refused == 1; }));
    EXPECT_THAT(south().last_problem, HasSubstr("[partials.stations] does not assign KBGM to it"));
    EXPECT_FALSE(is_kept(early));
    bring("north", later);
    bring("south", other);
    EXPECT_TRUE(testing::eventually([&] { return north().taken == 1 && south().taken == 1; }));
    EXPECT_EQ(south().refused, 1U);
}

// 2026-11-28: an empty partial with the time of an honest partial and a later end replaced the
// honest partial in every frame, and nothing was logged.
TEST_F(PartialsKeeperTest, APartThatReplacesThatOfAnotherMachineIsNamed) {
    start();
    bring("north", early);
    bring("north", later);
    ASSERT_TRUE(testing::eventually([&] { return north().taken == 2; }));
    InventedPartial forged = early;
    forged.longer_ms = 1;
    std::string log;
    {
        ::testing::internal::CaptureStderr();
        bring("south", forged);
        EXPECT_TRUE(testing::eventually([&] { return south().replaced == 1; }));
        bring("north", early);
        keeper_.reset();
        log = ::testing::internal::GetCapturedStderr();
    }
    EXPECT_THAT(
        log, HasSubstr("partial of south: north.KBGM 2005-08-22T02:44:00Z replaces one of north"));
}

TEST_F(PartialsKeeperTest, APartThatCameBeforeThatOfAnotherMachineIsNamedToo) {
    InventedPartial forged = early;
    forged.longer_ms = 1;
    start();
    bring("south", forged);
    ASSERT_TRUE(testing::eventually([&] { return south().taken == 1; }));
    bring("north", early);
    EXPECT_TRUE(testing::eventually([&] { return south().replaced == 1; }));
    EXPECT_EQ(north().replaced, 0U);
}

TEST_F(PartialsKeeperTest, TheSamePartOfTwoMachinesReplacesNothing) {
    start();
    bring("north", early);
    ASSERT_TRUE(testing::eventually([&] { return north().taken == 1; }));
    bring("south", early);
    bring("south", later);
    ASSERT_TRUE(testing::eventually([&] { return south().taken == 1; }));
    bring("south", later);
    // The keeper takes the newest partial first, so it takes first_of_all last.
    bring("south", first_of_all);
    EXPECT_TRUE(testing::eventually([&] { return south().taken == 2; }));
    EXPECT_EQ(north().replaced + south().replaced, 0U);
}

TEST_F(PartialsKeeperTest, AVolumeOfTheFutureMakesNoOtherMachineLate) {
    const auto now =
        std::chrono::duration_cast<std::chrono::minutes>(now_utc() - pipeline::minute(0));
    const int minute = static_cast<int>(now.count());
    start(std::chrono::seconds{600});
    bring("north", {"KBGM", minute - 7, 0, 20});
    bring("south", {"KOKX", minute + 5, 48, 35});
    EXPECT_TRUE(testing::eventually([&] { return north().taken == 1 && south().taken == 1; }));
    EXPECT_TRUE(testing::eventually([&] { return south().newest.has_value(); }));
    EXPECT_TRUE(is_scanned_again(1));
    EXPECT_FALSE(north().is_late) << north().why;
}

TEST_F(PartialsKeeperTest, AfterAStartFramesThatLackAPartAreMade) {
    bring("north", early);
    bring("north", later);
    bring("south", other);
    for (const InventedPartial& partial : {early, later, other})
        pipeline::commit(store_, partial);  // a daemon that was killed before it made a frame
    start();
    EXPECT_TRUE(testing::eventually([&] {
        return fs::exists(*store_.path_of("north", level2::Moment::ref, pipeline::minute(50)));
    }));
}

TEST_F(PartialsKeeperTest, OtherFilesAreNotLookedAt) {
    start();
    const auto [bytes, place] = made(early);
    for (const char* name :
         {"status.json", "north.KBGM/REF/20050822/notes.txt",
          "north.KBGM/REF/20050823/north.KBGM_REF_20050822_024400_000.scg",
          "KBGM/REF/20050822/KBGM_REF_20050822_024400_000.scg",
          "elsewhere.KBGM/REF/20050822/elsewhere.KBGM_REF_20050822_024400_000.scg"})
        write(directory_ / "north" / name, bytes);
    fs::create_directory_symlink(directory_ / "made", directory_ / "north" / "linked");
    bring("south", other);
    bring("north", first_of_all);
    EXPECT_TRUE(testing::eventually([&] { return is_kept(other) && north().taken > 0; }));
    EXPECT_TRUE(is_scanned_again(2));
    EXPECT_EQ(north().taken, 1U) << "only the last partial is taken";
    EXPECT_EQ(north().refused, 0U);
}

TEST_F(PartialsKeeperTest, ALostPartialIsTakenAgain) {
    start();
    bring("north", early);
    ASSERT_TRUE(testing::eventually([&] { return north().taken == 1; }));
    cache::StoreEntry entry;
    entry.domain = "north.KBGM";
    entry.time = pipeline::minute(early.minute);
    ASSERT_TRUE(store_.remove(entry));
    EXPECT_TRUE(testing::eventually([&] { return is_kept(early); }));
}

TEST_F(PartialsKeeperTest, AMachineThatBringsNothingIsLateAndComesBack) {
    fs::remove(directory_ / "south");
    start(std::chrono::seconds{2});
    EXPECT_TRUE(testing::eventually([&] { return !south().last_problem.empty(); }))
        << "the directory is not mounted";
    bring("north", early);
    EXPECT_TRUE(testing::eventually([&] {
        bring("north", early);
        return south().is_late && !north().is_late;
    }));
    EXPECT_THAT(south().why, HasSubstr("nothing came for "));
    fs::create_directory(directory_ / "south");
    bring("south", other);
    EXPECT_TRUE(testing::eventually([&] { return !south().is_late; }));
    EXPECT_EQ(south().why, "");
}

TEST_F(PartialsKeeperTest, AMachineThatIsBehindTheOthersIsLate) {
    start(std::chrono::seconds{300});
    bring("north", early);
    bring("south", other);
    EXPECT_TRUE(testing::eventually([&] { return north().is_late; }));
    EXPECT_THAT(north().why, HasSubstr("420 s behind the others"));
    EXPECT_FALSE(south().is_late);
    bring("north", later);
    EXPECT_TRUE(testing::eventually([&] { return !north().is_late; }));
}

}  // namespace
}  // namespace stormcellar::daemon
