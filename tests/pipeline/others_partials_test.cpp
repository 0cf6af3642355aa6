// Partials that other machines made: the mosaic is what one machine would have made of all volumes,
// and a machine that is late is left out, named, and back as soon as it has caught up.
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/mosaic/mosaic_maker.h"
#include "tests/pipeline/invented_partials.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
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
    // The file of a partial in the directory of a machine.
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
    EXPECT_THAT(take(*one, "buddy", first).partials, IsEmpty()) << "the same, made elsewhere";
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
    // KBGM's newest middle is 02:46, so it is in the frame of 02:50 and not in that of 02:55.
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
    EXPECT_TRUE(cache_of("late") == cache_of("all")) << "nothing tells that it was late";
}

TEST_F(OthersPartials, AStationThatAnotherMachineBringsIsNotLeftOut) {
    const auto one = node("one", std::chrono::minutes{5});
    for (const auto& partial : {first, other_first, other_second, other_third})
        take(*one, "a", partial);
    // A buddy has KBGM, too, and is on time: of "a" nothing is missing but by its own station.
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

TEST_F(OthersPartials, WhatIsDamagedOrCutIsRefused) {
    const auto one = node("one");
    const OthersPartial good = brought("north", first);
    const auto bytes = *read_file(good.file);
    const auto write = [&](std::size_t size, std::size_t altered) {
        auto changed = bytes;
        changed.resize(size);
        if (altered < size) changed[altered] ^= std::byte{1};
        std::ofstream(good.file, std::ios::binary | std::ios::trunc)
            .write(reinterpret_cast<const char*>(changed.data()),
                   static_cast<std::streamsize>(changed.size()));
    };
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size() - 1}) {
        write(size, bytes.size());
        EXPECT_EQ(refused(*one, good).cause(), Cause::data) << size;
    }
    write(bytes.size(), bytes.size() - 1);
    EXPECT_EQ(refused(*one, good).code, ErrorCode::corrupt) << "a code";
    write(bytes.size(), 300);
    EXPECT_EQ(refused(*one, good).code, ErrorCode::corrupt) << "the description";
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
