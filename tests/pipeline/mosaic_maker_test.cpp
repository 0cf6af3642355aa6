// Updates mosaics (frames) whenever a volume comes, and compares them with mosaics that are merged
// once from all volumes.
#include "pipeline/mosaic/mosaic_maker.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "grid/plan/grid_effects.h"
#include "stormcellar/level2/decode.h"
#include "tests/pipeline/small_domain.h"
#include "tests/testing/data.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

struct Loaded {
    level2::Volume volume;
    grid::SitePosition site;
    std::string file;
};

Loaded load_volume(const std::string& name) {
    level2::DecodeOptions options;
    options.fallback_station = name.substr(0, 4);
    const auto path = testing::real_file("sequence-kbgm") / name;
    auto decoded = level2::decode(*read_file(path), options);
    EXPECT_TRUE(decoded);
    const auto antenna = level2::antenna_position(decoded->volume);
    Loaded loaded{std::move(decoded->volume), {}, name};
    loaded.site = {loaded.volume.station, antenna->latitude_deg, antenna->longitude_deg,
                   antenna->altitude_m};
    return loaded;
}

// Returns the names of these volumes of the sequence, as in the provenance of grids.
std::vector<std::string> volumes_of(const std::vector<std::size_t>& numbers) {
    std::vector<std::string> volumes;
    for (const std::size_t number : numbers)
        volumes.push_back(sequence.at(number).substr(0, sequence.at(number).find('.')));
    return volumes;
}

class MosaicKeeperTest : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    // Takes in a volume, which is incomplete if it has no header.
    Kept take(const Loaded& loaded) {
        VolumeSource source{loaded.volume, loaded.site, loaded.file};
        source.partial = !loaded.volume.header;
        auto kept = keeper_.take_in(source, 2);
        EXPECT_TRUE(kept) << kept.error().message;
        return kept ? std::move(*kept) : Kept{};
    }
    [[nodiscard]] std::vector<cache::StoreEntry> frames() const {
        return *store_.list("north", level2::Moment::ref, std::nullopt, std::nullopt);
    }
    [[nodiscard]] static std::vector<std::byte> codes_of(const cache::GridFile& file) {
        const auto codes = file.view().codes;
        return {codes.begin(), codes.end()};
    }
    [[nodiscard]] static cache::GridFile open(const fs::path& path) {
        return std::move(*cache::GridFile::open(path));
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    MosaicMaker keeper_{&store_, {small_domain()}};
};

TEST_F(MosaicKeeperTest, FramesStandAtWholeIntervalsAndAreReplacedAsVolumesCome) {
    take(load_volume(sequence[0]));
    EXPECT_EQ(store_.list("north.KBGM", level2::Moment::ref, std::nullopt, std::nullopt)->size(),
              1U);
    // The middle of the first volume is 02:46:50, so no frame is due yet.
    const std::size_t first = frames().size();
    const Kept second = take(load_volume(sequence[1]));
    EXPECT_GE(frames().size(), first);
    ASSERT_EQ(second.frames.size(), 1U);
    const auto frame = open(second.frames[0]);
    EXPECT_EQ(format_utc(frame.description().time), "2005-08-22T02:50:00Z");
    EXPECT_FALSE(frame.description().provenance.provisional);
    EXPECT_EQ(frame.description().provenance.revision, 2);
    EXPECT_EQ(frame.description().provenance.source_files, volumes_of({0, 1}));

    // A third volume gives the frame of 02:55, and does not change the frame of 02:50.
    const Kept third = take(load_volume(sequence[2]));
    ASSERT_EQ(third.frames.size(), 1U);
    EXPECT_EQ(format_utc(open(third.frames[0]).description().time), "2005-08-22T02:55:00Z");
    for (const cache::StoreEntry& entry : frames())
        EXPECT_TRUE(open(entry.path).verify());
}

TEST_F(MosaicKeeperTest, AVolumeOfChunksWhoseHeaderComesLateStandsOnce) {
    const auto partials = [&] {
        return *store_.list("north.KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    };
    Loaded whole = load_volume(sequence[0]);
    whole.file = "20050822-024414-001-S";
    Loaded cut = load_volume(sequence[0]);
    cut.volume.header.reset();
    cut.file = "20050822-024414-002-I";
    ASSERT_NE(cut.volume.start_time(), whole.volume.start_time());
    take(cut);
    ASSERT_EQ(partials().size(), 1U);
    EXPECT_EQ(partials()[0].time, cut.volume.start_time());
    take(whole);
    ASSERT_EQ(partials().size(), 1U);
    EXPECT_EQ(partials()[0].time, whole.volume.start_time());

    // If scour has deleted the first chunk, the remaining chunks remove no grid.
    take(cut);
    const auto stand = partials();
    EXPECT_TRUE(std::any_of(stand.begin(), stand.end(), [&](const cache::StoreEntry& entry) {
        return entry.time == whole.volume.start_time();
    }));
}

TEST_F(MosaicKeeperTest, FramesSayWhatTheirRadarsReported) {
    take(load_volume(sequence[0]));
    const Loaded loaded = load_volume(sequence[1]);
    VolumeSource source{loaded.volume, loaded.site, loaded.file};
    source.radar_troubles = {"KBGM: standby"};
    const auto kept = keeper_.take_in(source, 2);
    ASSERT_TRUE(kept);
    ASSERT_EQ(kept->frames.size(), 1U);
    EXPECT_EQ(open(kept->partials.at(0)).description().provenance.radar_troubles,
              source.radar_troubles);
    EXPECT_EQ(open(kept->frames[0]).description().provenance.radar_troubles, source.radar_troubles);
}

TEST_F(MosaicKeeperTest, AVolumeThatComesLateReplacesTheFramesAboutIt) {
    take(load_volume(sequence[0]));
    const Kept last = take(load_volume(sequence[2]));
    ASSERT_EQ(last.frames.size(), 2U);  // 02:50 and 02:55, from volumes 11 minutes apart
    const Kept late = take(load_volume(sequence[1]));
    EXPECT_EQ(late.frames, last.frames);
    for (const auto& path : late.frames) {
        const auto frame = open(path);
        EXPECT_EQ(frame.description().provenance.revision, 2);
        const auto& volumes = frame.description().provenance.source_files;
        EXPECT_NE(std::ranges::find(volumes, volumes_of({1}).front()), volumes.end());
    }
}

TEST_F(MosaicKeeperTest, AFrameIsWhatTheSameVolumesMakeWithoutTheStore) {
    GeometryCache geometries(4);
    std::vector<MadePartial> partials;
    for (const std::string& name : {sequence[0], sequence[1]}) {
        const Loaded loaded = load_volume(name);
        take(loaded);
        PartialOptions options;
        const accuracy::Chain chain = grid::effects_of(level2::Moment::ref);
        options.gridder.method =
            grid::scene_choice(chain, grid::default_choice(chain, small_domain().spec, 0.95))
                .method;
        options.quantization = grid::default_quantization(level2::Moment::ref);
        auto made =
            make_partial(loaded.volume, loaded.site, small_domain().spec, options, geometries);
        ASSERT_TRUE(made && *made);
        partials.push_back(std::move(**made));
    }
    std::vector<PartialView> views;
    for (const MadePartial& partial : partials)
        views.push_back({&partial.description, partial.bricks.view()});
    ASSERT_EQ(frames().size(), 1U);
    const auto kept = open(frames()[0].path);
    const auto made =
        make_frame(small_domain().spec, views, kept.description().time, {}, geometries);
    ASSERT_TRUE(made);
    const grid::Grid a = grid::to_dense(made->mosaic.cells.view());
    const grid::Grid b = grid::to_dense(kept.view());
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.values, b.values);
}

// With a single site, all bricks are merged again, but the frame still counts as updated.
TEST_F(MosaicKeeperTest, AFrameThatIsReplacedIsBroughtUpToDate) {
    take(load_volume(sequence[0]));
    EXPECT_EQ(take(load_volume(sequence[2])).updated, 0U) << "there was no frame to update";
    EXPECT_EQ(take(load_volume(sequence[1])).updated, 2U);
    const auto updated = open(frames()[0].path);
    const auto bytes_of_updated = *read_file(frames()[0].path);
    fs::remove(frames()[0].path);
    std::vector<std::string> problems;
    const auto whole =
        keeper_.make_again({"north", level2::Moment::ref, updated.description().time}, 1, problems);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_FALSE(whole->merged);
    EXPECT_EQ(whole->stations, std::vector<std::string>{"KBGM"});
    EXPECT_EQ(*read_file(whole->path), bytes_of_updated)
        << "the bytes must not depend on how often the frame was made";
}

// An altered code would be copied with a new checksum, and the damage would never be noticed.
TEST_F(MosaicKeeperTest, ADamagedFrameIsNotCopiedFrom) {
    take(load_volume(sequence[0]));
    const auto path = take(load_volume(sequence[1])).frames.at(0);
    const auto good = codes_of(open(path));
    testing::alter_last_byte_of(path);
    std::vector<std::string> problems;
    const auto again = keeper_.make_again(
        {"north", level2::Moment::ref, open(path).description().time}, 1, problems);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_FALSE(again->merged);
    EXPECT_EQ(codes_of(open(path)), good);
}

TEST_F(MosaicKeeperTest, ADamagedPartialIsLeftOutAndNamed) {
    take(load_volume(sequence[0]));
    const auto damaged = take(load_volume(sequence[1])).partials.at(0);
    testing::alter_last_byte_of(damaged);
    const Kept third = take(load_volume(sequence[2]));
    ASSERT_EQ(third.problems.size(), 1U);
    EXPECT_TRUE(third.problems[0].starts_with(damaged.native())) << third.problems[0];
    ASSERT_EQ(third.frames.size(), 1U);
    EXPECT_EQ(open(third.frames[0]).description().provenance.source_files, volumes_of({0, 2}));
}

TEST_F(MosaicKeeperTest, MissingFramesAreThoseBetweenPartialsThatStand) {
    for (const std::string& name : sequence)
        take(load_volume(name));
    const auto all = frames();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_TRUE(missing_frames(store_, keeper_.domains(), std::chrono::hours{6})->empty());
    fs::remove(all[1].path);
    const auto one = missing_frames(store_, keeper_.domains(), std::chrono::hours{6});
    ASSERT_EQ(one->size(), 1U);
    EXPECT_EQ(one->at(0), (cache::GridName{"north", level2::Moment::ref, all[1].time}));
    fs::remove(all[0].path);
    const auto both = missing_frames(store_, keeper_.domains(), std::chrono::hours{6});
    ASSERT_EQ(both->size(), 2U);
    EXPECT_EQ(both->at(1).time, all[0].time) << "the newest frame should come first";
    EXPECT_EQ(missing_frames(store_, keeper_.domains(), std::chrono::minutes{1})->size(), 1U);
    std::vector<std::string> problems;
    ASSERT_TRUE(keeper_.make_again(both->at(0), 1, problems));
    EXPECT_TRUE(missing_frames(store_, keeper_.domains(), std::chrono::hours{6})->empty())
        << "a frame older than all others counts as evicted";
}

TEST_F(MosaicKeeperTest, WhatCannotBeMadeAgainSaysWhy) {
    take(load_volume(sequence[0]));
    std::vector<std::string> problems;
    const auto again = [&](const std::string& domain, const char* time) {
        const auto made = keeper_.make_again(
            {domain, level2::Moment::ref, *parse_utc(time, UtcTime{})}, 1, problems);
        return made ? std::string{} : made.error().message;
    };
    EXPECT_EQ(again("south", "2005-08-22T02:50:00Z"),
              "the configuration has no domain south of REF");
    EXPECT_EQ(again("north", "2005-08-22T02:51:00Z"),
              "north has frames every 300 s, so none at 2005-08-22T02:51:00Z");
    EXPECT_EQ(again("north", "2005-08-22T04:00:00Z"),
              "no site has a volume within 15 minutes of 2005-08-22T04:00:00Z");
}

TEST_F(MosaicKeeperTest, ADomainThatTakesNotTheStationKeepsNothing) {
    Domain other = small_domain();
    other.stations = {"KTLX"};
    MosaicMaker keeper(&store_, {other});
    const Loaded loaded = load_volume(sequence[0]);
    const auto kept = keeper.take_in({loaded.volume, loaded.site, loaded.file}, 1);
    ASSERT_TRUE(kept);
    EXPECT_TRUE(kept->partials.empty());
    EXPECT_TRUE(store_.domains()->empty());
}

}  // namespace
}  // namespace stormcellar::pipeline
