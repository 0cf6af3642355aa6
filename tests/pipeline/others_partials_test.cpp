// Tests partials (grids of one site each, from which mosaics are merged) that other machines made.
// The frames of the mosaic equal the frames that one machine makes from all volumes. A late machine
// is left out and named, until it has caught up.
#include <fstream>
#include <functional>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/mosaic/mapped_partials.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "tests/pipeline/invented_partials.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const InventedPartial first{"KBGM", 44, 0, 20}, second{"KBGM", 50, 0, 25}, third{"KBGM", 56, 0, 30};
const InventedPartial other_first{"KOKX", 45, 48, 35}, other_second{"KOKX", 51, 48, 40},
    other_third{"KOKX", 57, 48, 45};

class OthersPartials : public ::testing::Test {
  protected:
    struct Node {
        cache::StoreWriter store;
        std::shared_ptr<PartialSources> sources;
        MosaicMaker mosaics;
        Node(const fs::path& cache, std::chrono::seconds late_after)
            : store(*cache::StoreWriter::open(real_file_system(), cache, true)),
              sources(std::make_shared<PartialSources>(late_after)),
              mosaics(&store, {small_domain()}, FramesWhen::volume_comes, sources) {}
    };
    std::unique_ptr<Node> node(const std::string& name,
                               std::chrono::seconds late_after = std::chrono::minutes{10}) {
        return std::make_unique<Node>(directory_ / name, late_after);
    }
    // Writes a partial into the directory of a machine.
    OthersPartial brought(const std::string& machine, const InventedPartial& partial) {
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / machine, false);
        const fs::path file = commit(*store, partial);
        return {file,
                {"north." + partial.station, level2::Moment::ref, minute(partial.minute)},
                machine};
    }
    Kept take(Node& node, const std::string& machine, const InventedPartial& partial) {
        auto kept = node.mosaics.take_partial(brought(machine, partial), 1);
        EXPECT_TRUE(kept) << kept.error().message;
        return kept ? std::move(*kept) : Kept{};
    }
    Error refused(Node& node, const OthersPartial& partial) {
        const auto kept = node.mosaics.take_partial(partial, 1);
        EXPECT_FALSE(kept);
        return kept ? Error{} : kept.error();
    }
    // Returns how many frames were made again.
    static int mended(Node& node) {
        int count = 0;
        std::vector<std::string> problems;
        for (int i = 0; i < 1000; ++i) {
            const auto looked = node.mosaics.make_stale(1, problems);
            EXPECT_TRUE(looked) << looked.error().message;
            if (!looked || !*looked) break;
            if ((*looked)->made) ++count;
        }
        EXPECT_THAT(problems, IsEmpty());
        return count;
    }
    [[nodiscard]] std::map<fs::path, std::vector<std::byte>> cache_of(const std::string& name) {
        std::map<fs::path, std::vector<std::byte>> files;
        for (const auto& entry : fs::recursive_directory_iterator(directory_ / name)) {
            if (entry.is_regular_file())
                files[fs::relative(entry.path(), directory_ / name)] = *read_file(entry.path());
        }
        return files;
    }
    static grid::Provenance frame_of(Node& node, int minutes) {
        const auto path = node.store.path_of("north", level2::Moment::ref, minute(minutes));
        const auto file = cache::GridFile::open(*path);
        EXPECT_TRUE(file) << file.error().message;
        return file ? file->description().provenance : grid::Provenance{};
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(OthersPartials, MakeTheSameCacheInAnyOrderAndFromAnyMachine) {
    const auto one = node("one"), two = node("two");
    for (const auto& partial : {first, other_first, second, other_second, third, other_third})
        take(*one, "all", partial);
    for (const auto& partial : {other_third, other_first, other_second})
        take(*two, "south", partial);
    for (const auto& partial : {third, second, first})
        take(*two, "north", partial);
    const auto ours = cache_of("one"), theirs = cache_of("two");
    EXPECT_EQ(ours.size(), 8U) << "six partials, and frames of 02:50 and 02:55";
    EXPECT_TRUE(ours == theirs);
    EXPECT_TRUE(
        ours.at("north.KBGM/REF/20050822/north.KBGM_REF_20050822_024400_000.scg") ==
        cache_of("north").at("north.KBGM/REF/20050822/north.KBGM_REF_20050822_024400_000.scg"));
    EXPECT_THAT(frame_of(*one, 50).left_out, IsEmpty());
}

TEST_F(OthersPartials, WhatTheCacheHasIsTakenOnce) {
    const auto one = node("one");
    EXPECT_EQ(take(*one, "north", first).partials.size(), 1U);
    EXPECT_THAT(take(*one, "north", first).partials, IsEmpty());
    EXPECT_THAT(take(*one, "buddy", first).partials, IsEmpty())
        << "the same partial from another machine changes nothing";
    EXPECT_EQ(one->sources->newest_of("buddy"), minute(46));
}

TEST_F(OthersPartials, OfTwoGridsOfAVolumeTheSameOneCountsInAnyOrder) {
    InventedPartial changed = first;
    changed.value = 22;
    const auto one = node("one"), two = node("two");
    take(*one, "north", first);
    take(*one, "buddy", changed);
    take(*two, "buddy", changed);
    take(*two, "north", first);
    EXPECT_TRUE(cache_of("one") == cache_of("two"));
}

TEST_F(OthersPartials, AMachineThatIsLateIsLeftOutNamedAndComesBack) {
    const auto late = node("late", std::chrono::minutes{5}), all = node("all");
    for (const auto& partial : {first, other_first, other_second, other_third})
        take(*late, partial.station == "KBGM" ? "a" : "b", partial);
    // The middle of KBGM's newest volume is 02:46, so KBGM is in the frame of 02:50, but not of
    // 02:55.
    EXPECT_THAT(frame_of(*late, 50).stations, ElementsAre("KBGM", "KOKX"));
    EXPECT_THAT(frame_of(*late, 50).left_out, IsEmpty());
    EXPECT_THAT(frame_of(*late, 55).stations, ElementsAre("KOKX"));
    EXPECT_THAT(frame_of(*late, 55).left_out,
                ElementsAre("a (KBGM): nothing since 2005-08-22T02:46:00Z"));

    take(*late, "a", second);
    EXPECT_THAT(frame_of(*late, 55).stations, ElementsAre("KBGM", "KOKX"));
    EXPECT_THAT(frame_of(*late, 55).left_out, IsEmpty());
    for (const auto& partial : {first, other_first, second, other_second, other_third})
        take(*all, "x", partial);
    EXPECT_TRUE(cache_of("late") == cache_of("all"))
        << "the frames should not show that a machine was late";
}

TEST_F(OthersPartials, AStationThatAnotherMachineBringsIsNotLeftOut) {
    const auto one = node("one", std::chrono::minutes{5});
    for (const auto& partial : {first, other_first, other_second, other_third})
        take(*one, "a", partial);
    // The machine "buddy" brings KBGM, too, and is on time, so no station is left out because "a"
    // is late.
    take(*one, "buddy", second);
    EXPECT_THAT(frame_of(*one, 55).stations, ElementsAre("KBGM", "KOKX"));
    EXPECT_THAT(frame_of(*one, 55).left_out, IsEmpty());
}

TEST_F(OthersPartials, WhatIsNoPartOfADomainIsRefused) {
    const auto one = node("one");
    OthersPartial good = brought("north", first);
    const auto named = [&](const std::string& domain, UtcTime time) {
        OthersPartial partial = good;
        partial.name.domain = domain;
        partial.name.time = time;
        return partial;
    };
    EXPECT_EQ(refused(*one, named("south.KBGM", good.name.time)).code, ErrorCode::bad_argument);
    EXPECT_EQ(refused(*one, named("north", good.name.time)).code, ErrorCode::bad_argument);
    EXPECT_EQ(refused(*one, named("north.KOKX", good.name.time)).code, ErrorCode::corrupt);
    EXPECT_EQ(refused(*one, named("north.KBGM", minute(1))).code, ErrorCode::corrupt);
    Domain others = small_domain();
    others.spec.spacing_m = 2000;
    MosaicMaker finer(&one->store, {others});
    const auto kept = finer.take_partial(good, 1);
    ASSERT_FALSE(kept);
    EXPECT_THAT(kept.error().message, HasSubstr("both machines must have the same [[domain]]"));
    others = small_domain();
    others.stations = {"KOKX"};
    EXPECT_FALSE(MosaicMaker(&one->store, {others}).take_partial(good, 1));
    EXPECT_THAT(cache_of("one"), IsEmpty());
}

// 2026-11-28: a daemon that was killed between a partial and its frames never made the frames.
TEST_F(OthersPartials, FramesThatAKilledDaemonDidNotMakeAreMade) {
    const auto whole = node("whole"), killed = node("killed");
    for (const auto& partial : {first, other_first, second, other_second, third, other_third})
        take(*whole, "all", partial);
    for (const auto& partial : {first, other_first, second, other_second, third})
        take(*killed, "all", partial);
    commit(killed->store, other_third);  // and then the daemon is killed
    ASSERT_FALSE(cache_of("killed") == cache_of("whole"));

    const auto again = node("killed");
    for (const auto& partial : {other_third, third, second, first})
        EXPECT_THAT(take(*again, "all", partial).partials, IsEmpty());
    EXPECT_GT(mended(*again), 0);
    EXPECT_TRUE(cache_of("killed") == cache_of("whole"));
    for (const auto& partial : {other_third, third, second, first})
        take(*again, "all", partial);
    EXPECT_EQ(mended(*again), 0) << "current frames should not be made again";
}

// 2026-11-28: forged partials kept the thread busy for three minutes without a heartbeat.
TEST_F(OthersPartials, EachFrameOfAPartIsABeat) {
    const auto merging = node("merging");
    take(*merging, "a", first);
    auto partial = brought("a", third);
    std::size_t beats = 0;
    partial.beat = [&] { ++beats; };
    const auto kept = merging->mosaics.take_partial(partial, 1);
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_GT(kept->frames.size(), 1U);
    EXPECT_GE(beats, kept->frames.size());
}

TEST_F(OthersPartials, AFrameWhosePartsLeftTheCacheStays) {
    const auto one = node("one");
    for (const auto& partial : {first, other_first, second, other_second, third, other_third})
        take(*one, "all", partial);
    const auto frame = one->store.path_of("north", level2::Moment::ref, minute(50));
    const auto before = *read_file(*frame);
    fs::remove(*one->store.path_of("north.KOKX", level2::Moment::ref, minute(45)));
    take(*one, "all", second);
    EXPECT_EQ(mended(*one), 0);
    EXPECT_TRUE(*read_file(*frame) == before);
}

// 2026-11-28: the notes of forged partials exceeded the limit of a frame's file, so that no frame
// was written. 65,000 notes kept the thread busy for minutes. Partials of the year 9998 made the
// other machines late.
TEST_F(OthersPartials, PartsThatSayWhatNoneSaysAreRefused) {
    const auto one = node("one");
    using Change = std::function<void(grid::Grid&)>;
    const auto many = [](std::vector<std::string>& texts) {
        for (int i = 0; i < 30'000; ++i)
            texts.push_back(fmt::format("{:08}", i));
    };
    const std::vector<std::pair<Change, const char*>> changes = {
        {[&](grid::Grid& grid) { many(grid.provenance.notes); }, "more notes"},
        {[&](grid::Grid& grid) { many(grid.provenance.radar_troubles); }, "more notes"},
        {[&](grid::Grid& grid) { many(grid.provenance.source_files); }, "more names"},
        {[](grid::Grid& grid) { grid.provenance.effects = std::string(900'000, 'x'); },
         "more text"},
        {[](grid::Grid& grid) { grid.provenance.notes = {std::string(2000, 'x')}; }, "more text"},
        {[](grid::Grid& grid) { grid.end_time += std::chrono::hours{24 * 365 * 7990}; },
         "not of the time of its name"},
        {[](grid::Grid& grid) { grid.start_time -= std::chrono::hours{2}; },
         "not of the time of its name"},
        {[](grid::Grid& grid) { std::swap(grid.start_time, grid.end_time); },
         "not of the time of its name"},
    };
    auto store = cache::StoreWriter::open(real_file_system(), directory_ / "evil", false);
    for (const auto& [change, why] : changes) {
        grid::Grid grid = grid_of(first);
        change(grid);
        const fs::path file = commit(*store, "KBGM", grid);
        const Error error = refused(
            *one, {file, {"north.KBGM", level2::Moment::ref, minute(first.minute)}, "evil"});
        EXPECT_THAT(error.message, HasSubstr(why));
        EXPECT_THAT(error.message, HasSubstr(file.native()))
            << "the message should name the partial";
    }
    grid::Grid future = grid_of(first);
    future.time = future.start_time = now_utc() + std::chrono::hours{1};
    future.end_time = future.start_time + std::chrono::minutes{4};
    const fs::path file = commit(*store, "KBGM", future);
    EXPECT_THAT(
        refused(*one, {file, {"north.KBGM", level2::Moment::ref, future.time}, "evil"}).message,
        HasSubstr("of the future"));
    EXPECT_FALSE(one->sources->newest_of("evil"));
    EXPECT_FALSE(fs::exists(directory_ / "one" / "north.KBGM"))
        << "the directory should be made only for a partial that is kept";
}

TEST_F(OthersPartials, AFrameOfPartsWithManyNotesIsMade) {
    const auto one = node("one");
    for (const auto& [partial, letter] : {std::pair{first, 'a'}, std::pair{other_first, 'b'}}) {
        grid::Grid grid = grid_of(partial);
        for (int i = 0; i < 60'000; ++i)
            grid.provenance.notes.push_back(fmt::format("{}{:07}", letter, i));
        commit(one->store, partial.station, grid);
    }
    const Kept kept = take(*one, "all", second);
    take(*one, "all", other_second);
    EXPECT_THAT(kept.problems, IsEmpty());
    const auto notes = frame_of(*one, 50).notes;
    EXPECT_LT(notes.size(), 20'000U);
    EXPECT_THAT(notes.back(), HasSubstr("more notes"));
}

// 2026-11-28: 930 partials of a station within an hour were kept, and each new partial opened all
// of them.
TEST_F(OthersPartials, AStationHasNoMorePartsOfAnHourThanARadarMakes) {
    const auto one = node("one");
    take(*one, "all", other_first);
    for (int i = 0; i < 130; ++i) {
        grid::Grid grid = grid_of({"KBGM", 44, 0, 20});
        grid.time = grid.start_time = minute(44) + std::chrono::seconds{i};
        grid.end_time = grid.time + std::chrono::minutes{4};
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / "evil", false);
        const fs::path file = commit(*store, "KBGM", grid);
        const auto kept = one->mosaics.take_partial(
            {file, {"north.KBGM", level2::Moment::ref, grid.time}, "evil"}, 1);
        ASSERT_TRUE(kept) << kept.error().message;
    }
    const auto standing =
        one->store.list("north.KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_TRUE(standing);
    EXPECT_EQ(standing->size(), 120U);
    std::vector<std::string> problems;
    const Domain domain = small_domain();
    const auto open = MappedPartials::open(one->store, domain, level2::Moment::ref, minute(31),
                                           minute(61), problems);
    ASSERT_TRUE(open);
    EXPECT_LE(open->views().size(), 25U) << "each open partial takes a descriptor";
}

TEST_F(OthersPartials, WhatIsDamagedOrCutIsRefused) {
    const auto one = node("one");
    const OthersPartial good = brought("north", first);
    const auto bytes = *read_file(good.file);
    const auto write = [&](std::size_t size, std::size_t altered) {
        auto changed = bytes;
        changed.resize(size);
        if (altered < size) changed[altered] ^= std::byte{1};
        testing::write_bytes(good.file, changed);
    };
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size() - 1}) {
        write(size, bytes.size());
        EXPECT_EQ(refused(*one, good).cause(), Cause::data) << size;
    }
    write(bytes.size(), bytes.size() - 1);
    EXPECT_EQ(refused(*one, good).code, ErrorCode::corrupt) << "a code was changed";
    write(bytes.size(), 300);
    EXPECT_EQ(refused(*one, good).code, ErrorCode::corrupt) << "the description was changed";
    EXPECT_THAT(cache_of("one"), IsEmpty());
    write(bytes.size(), bytes.size());
    EXPECT_TRUE(one->mosaics.take_partial(good, 1));
}

TEST(LateMachine, NamesAFewOfItsStations) {
    LateMachine machine{"north", {"KFWS"}, minute(4)};
    EXPECT_EQ(machine.text(), "north (KFWS): nothing since 2005-08-22T02:04:00Z");
    for (const char* station : {"KAAA", "KBBB", "KCCC", "KDDD", "KEEE", "KGGG", "KHHH"})
        machine.stations.insert(station);
    EXPECT_EQ(machine.text(),
              "north (KAAA KBBB KCCC KDDD KEEE KFWS and 2 more): nothing since "
              "2005-08-22T02:04:00Z");
}

}  // namespace
}  // namespace stormcellar::pipeline
