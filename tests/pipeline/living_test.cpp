// Tests the grids of volumes that grow record by record (living grids), and that no living grid is
// left at the end.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/checksum.h"
#include "pipeline/ingest/followed_files.h"
#include "pipeline/keep/sweep_shelf.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "stormcellar/level2/volume_difference.h"
#include "tests/pipeline/living_house.h"

namespace stormcellar::pipeline {
namespace {

TEST_F(Living, EverySweepIsShownAndTheEndIsThatOfTheWholeFile) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    const std::vector<IngestOutcome> outcomes = grow(house_, path, bytes);
    ASSERT_GT(outcomes.size(), 20U);
    std::size_t shown = 0;
    for (std::size_t i = 0; i + 1 < outcomes.size(); ++i) {
        EXPECT_EQ(outcomes[i].result(), IngestResult::incomplete) << i;
        shown += outcomes[i].living.size();
    }
    EXPECT_EQ(outcomes.back().result(), IngestResult::gridded);
    const level2::Volume volume = level2::decode(bytes)->volume;
    EXPECT_EQ(shown, volume.sweeps.size() - 1);  // the last sweep ends the volume

    // A second House, with its own catalog and cache, ingests the complete file.
    House whole(directory_ / "whole", false);
    ASSERT_EQ(whole.ingestor->ingest(path, false)->result(), IngestResult::gridded);
    ASSERT_EQ(house_.grids("KLOT").size(), 1U);
    ASSERT_EQ(whole.grids("KLOT").size(), 1U);
    EXPECT_EQ(*read_file(house_.grids("KLOT")[0].path), *read_file(whole.grids("KLOT")[0].path));
    const auto rows = house_.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    const auto same = whole.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    ASSERT_EQ(rows->size(), 1U);
    EXPECT_EQ(rows->at(0).state, same->at(0).state);
    EXPECT_EQ(rows->at(0).volume.sweep_count, same->at(0).volume.sweep_count);
    EXPECT_EQ(rows->at(0).volume.radial_count, same->at(0).volume.radial_count);
}

// 2026-11-28: two records in the wrong order at the boundary of two sweeps split the volume in two.
// The first part got no more living grids, and its final grid was nearly empty.
TEST_F(Living, RecordsInTheWrongOrderGiveTheGridsOfTheRightOrder) {
    const std::vector<std::byte> right = real_bytes(busy);
    const std::vector<std::size_t> ends = synth::piece_ends(right);
    std::vector<std::byte> bytes(right.begin(), right.begin() + static_cast<long>(ends[0]));
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const std::size_t pair = i % 2 == 1 ? i + 1 : i - 1;
        const std::size_t piece = pair < ends.size() ? pair : i;
        bytes.insert(bytes.end(), right.begin() + static_cast<long>(ends[piece - 1]),
                     right.begin() + static_cast<long>(ends[piece]));
    }
    ASSERT_EQ(bytes.size(), right.size());
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    const auto outcomes = grow(house_, path, bytes);
    EXPECT_EQ(outcomes.back().result(), IngestResult::gridded);
    const auto sweeps = level2::decode(right)->volume.sweeps.size();
    std::size_t shown = 0;
    for (const IngestOutcome& outcome : outcomes)
        shown += outcome.living.size();
    EXPECT_GE(shown, sweeps - 1) << "each sweep but the last should be shown";

    House whole(directory_ / "whole", false);
    const fs::path right_path = directory_ / "right" / path.filename();
    fs::create_directories(right_path.parent_path());
    append_to(right_path, right);
    date(right_path);
    ASSERT_EQ(whole.ingestor->ingest(right_path, false)->result(), IngestResult::gridded);
    ASSERT_EQ(house_.grids("KLOT").size(), 1U);
    EXPECT_EQ(*read_file(house_.grids("KLOT")[0].path), *read_file(whole.grids("KLOT")[0].path));
    const auto rows = house_.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    ASSERT_EQ(rows->size(), 1U);
    EXPECT_EQ(rows->at(0).volume.sweep_count, static_cast<int>(sweeps));
    EXPECT_TRUE(rows->at(0).volume.complete);
}

// Ingests two volumes record by record. After each record, the grids of each moment must equal the
// grids of a House that grids only this moment, even while old sweeps stand in for some moments.
TEST_F(Living, SeveralMomentsAreThoseOfOneEach) {
    using level2::Moment;
    const std::vector<Moment> moments = {Moment::ref, Moment::vel, Moment::rho, Moment::veld};
    House together(directory_ / "together", true, {}, moments);
    std::vector<std::unique_ptr<House>> alone;
    for (const Moment moment : moments) {
        alone.push_back(
            std::make_unique<House>(directory_ / std::string(level2::moment_name(moment)), true,
                                    std::function<Load()>{}, std::vector{moment}));
    }
    const std::vector<std::byte> first = real_bytes(busy);
    const auto encoded =
        level2::encode(later(level2::decode(first)->volume, std::chrono::minutes{12}));
    ASSERT_TRUE(encoded) << encoded.error().message;
    const std::vector<std::byte> second = encoded->joined();
    std::size_t shown_together = 0;
    std::size_t shown_alone = 0;
    const auto compare = [&](const fs::path& path) {
        auto outcome = together.ingestor->ingest(path, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        shown_together += outcome->living.size();
        for (std::size_t i = 0; i < moments.size(); ++i) {
            auto one = alone[i]->ingestor->ingest(path, false);
            ASSERT_TRUE(one) << one.error().message;
            shown_alone += one->living.size();
            EXPECT_EQ(one->result(), outcome->result());
            const auto expected = alone[i]->grids("KLOT", moments[i]);
            const auto made = together.grids("KLOT", moments[i]);
            ASSERT_EQ(made.size(), expected.size());
            if (made.empty()) continue;
            EXPECT_EQ(*read_file(made.back().path), *read_file(expected.back().path))
                << level2::moment_name(moments[i]);
        }
    };
    for (const auto& [name, bytes] :
         {std::pair{"KLOT20220317_000842_V06", &first}, {"KLOT20220317_002042_V06", &second}}) {
        std::size_t from = 0;
        for (const std::size_t end : synth::piece_ends(*bytes)) {
            append_to(directory_ / name, std::span{*bytes}.subspan(from, end - from));
            from = end;
            date(directory_ / name);
            ASSERT_NO_FATAL_FAILURE(compare(directory_ / name));
        }
    }
    EXPECT_GT(shown_together, 20U);
    EXPECT_EQ(shown_together, shown_alone)
        << "a moment should be shown only when it has new sweeps";
    for (const Moment moment : moments)
        EXPECT_EQ(together.grids("KLOT", moment).size(), 2U);
}

// The living grid must equal the grid of a volume that this test composes: old sweeps of the last
// volume, followed by the new sweeps.
TEST_F(Living, TheLastVolumeStandsUntilItsSweepsComeAgain) {
    const std::vector<std::byte> first_bytes = real_bytes(busy);
    const fs::path first_path = directory_ / "KLOT20220317_000842_V06";
    ASSERT_EQ(grow(house_, first_path, first_bytes).back().result(), IngestResult::gridded);
    const level2::Volume first = level2::decode(first_bytes)->volume;
    const level2::Volume second = later(first, std::chrono::minutes{12});
    const auto encoded = level2::encode(second);
    ASSERT_TRUE(encoded) << encoded.error().message;
    const std::vector<std::byte> second_bytes = encoded->joined();
    const auto outcomes = grow(house_, directory_ / "KLOT20220317_002042_V06", second_bytes, 30);
    std::size_t shown = 0;
    for (const IngestOutcome& outcome : outcomes)
        shown += outcome.living.size();
    ASSERT_GT(shown, 1U);
    const auto grids = house_.grids("KLOT");
    ASSERT_EQ(grids.size(), 2U);
    const auto file = cache::GridFile::open(grids.back().path);
    ASSERT_TRUE(file) << file.error().message;
    const cache::GridDescription& made = file->description();
    EXPECT_TRUE(made.provenance.partial);
    ASSERT_EQ(made.provenance.notes.size(), 1U);
    EXPECT_TRUE(made.provenance.notes[0].starts_with("living: ")) << made.provenance.notes[0];
    // The grid has each elevation once: low elevations from the new volume, high elevations from
    // the volume before.
    const UtcTime second_start = second.header->time();
    std::size_t fresh = 0;
    for (std::size_t i = 0; i < made.provenance.sweeps.size(); ++i) {
        const grid::SweepTime& sweep = made.provenance.sweeps[i];
        const bool is_new = sweep.start >= second_start;
        fresh += is_new ? 1 : 0;
        if (i > 0 && is_new) {
            EXPECT_GE(made.provenance.sweeps[i - 1].start, second_start)
                << "an old sweep at " << sweep.elevation_deg << " degrees below a new sweep";
        }
    }
    EXPECT_GE(fresh, 1U);
    EXPECT_LT(fresh, made.provenance.sweeps.size());

    level2::Volume by_hand = second;
    by_hand.sweeps.clear();
    std::vector<level2::Sweep> news(second.sweeps.begin(),
                                    second.sweeps.begin() + static_cast<std::ptrdiff_t>(shown));
    for (const level2::Sweep& old : first.sweeps) {
        const bool again = std::any_of(news.begin(), news.end(), [&](const level2::Sweep& s) {
            return s.find(level2::Moment::ref) != nullptr &&
                   std::abs(s.mean_elevation_deg() - old.mean_elevation_deg()) < 0.2;
        });
        if (!again && old.find(level2::Moment::ref) != nullptr) by_hand.sweeps.push_back(old);
    }
    by_hand.sweeps.insert(by_hand.sweeps.end(), news.begin(), news.end());
    const auto geometry = grid::make_column_geometry(made.sites.front(), made.spec);
    ASSERT_TRUE(geometry);
    const auto expected = grid::make_grid(by_hand, made.sites.front(), **geometry, {});
    ASSERT_TRUE(expected);
    const grid::BrickView view = file->view();
    std::size_t differ = 0;
    for (int z = 0; z < made.spec.nz(); ++z) {
        for (int y = 0; y < made.spec.ny; ++y) {
            for (int x = 0; x < made.spec.nx; ++x) {
                const auto at = expected->spec.index(x, y, z);
                differ += view.status(x, y, z) != expected->status[at] ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(differ, 0U);
}

TEST_F(Living, WithoutTimeLowSweepsAreShownAndTheOthersTogetherLater) {
    Load load = Load::heavy;
    House house(directory_ / "hurried", true, [&] { return load; });
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    const auto outcomes = grow(house, path, bytes, 40);
    const auto shown = [](const IngestOutcome& outcome) { return !outcome.living.empty(); };
    const auto left_out = [](const IngestOutcome& outcome) { return outcome.living_left_out; };
    // The volume has two cuts at 0.5 degrees, then higher cuts, and 0.5 degrees again among them
    // (SAILS).
    EXPECT_GT(std::count_if(outcomes.begin(), outcomes.end(), shown), 0);
    EXPECT_GT(std::count_if(outcomes.begin(), outcomes.end(), left_out), 0);
    ASSERT_TRUE(outcomes.back().living_left_out) << "without time, a high last sweep is left out";
    EXPECT_TRUE(outcomes.back().living.empty());
    load = Load::light;
    append_to(path, std::span{bytes}.subspan(fs::file_size(path), 1000));
    const auto outcome = house.ingestor->ingest(path, false);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->living.size(), 1U);
    EXPECT_FALSE(outcome->living_left_out);
    EXPECT_EQ(house.grids("KLOT").size(), 1U);
}

TEST_F(Living, NoSweepIsShownWhileVolumesAreLate) {
    Load load = Load::late;
    House house(directory_ / "late", true, [&] { return load; });
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    for (const IngestOutcome& outcome : grow(house, path, bytes, 10))
        EXPECT_TRUE(outcome.living.empty());
    load = Load::heavy;
    append_to(path, std::span{bytes}.subspan(fs::file_size(path), 1000));
    const auto outcome = house.ingestor->ingest(path, false);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->living.size(), 1U) << "a low sweep of before is still to be shown";
}

TEST_F(Living, AFileThatIsRewrittenMeanwhileIsReadAsItIs) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const std::vector<std::byte> other = real_bytes("volumes/KLBB20160601_150025_V06");
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    grow(house_, path, bytes, 20);
    const std::size_t size = fs::file_size(path);
    // Overwrite the file in place, so that it is the same file but longer.
    ASSERT_GT(other.size(), size);
    std::fstream(path, std::ios::binary | std::ios::in | std::ios::out)
        .write(reinterpret_cast<const char*>(other.data()),
               static_cast<std::streamsize>(other.size()));
    ASSERT_EQ(fs::file_size(path), other.size());
    const auto outcome = house_.ingestor->ingest(path, true);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_EQ(outcome->station, "KLBB");
    EXPECT_FALSE(outcome->partial);
}

TEST_F(Living, AVolumeThatStopsIsWhatItIsWhenReadWhole) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    grow(house_, path, bytes, 25);
    append_to(path, std::span{bytes}.subspan(fs::file_size(path), 777));
    date(path);
    const auto outcome = house_.ingestor->ingest(path, true);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_TRUE(outcome->partial);
    House whole(directory_ / "whole", false);
    ASSERT_EQ(whole.ingestor->ingest(path, true)->result(), IngestResult::gridded);
    EXPECT_EQ(*read_file(house_.grids("KLOT")[0].path), *read_file(whole.grids("KLOT")[0].path));
}

TEST_F(Living, WhereNoPlaceIsLeftANewcomerIsNotFollowed) {
    FollowedFiles files(FollowedFile::Options{{}, {level2::Moment::ref}, {}, directory_ / "living"},
                        GrowingLimits{.count = 3, .station_count = 2});
    const auto a = files.begin("/drop/a", "KTLX", "KTLX");
    const auto b = files.begin("/drop/b", "KTLX", "KTLX");
    ASSERT_TRUE(a && b);
    EXPECT_FALSE(files.begin("/drop/c", "KTLX", "KTLX")) << "a station may have two files";
    EXPECT_TRUE(files.begin("/drop/d", "KOKX", "KOKX"));
    EXPECT_FALSE(files.begin("/drop/e", "KOKX", "KOKX")) << "there may be three files in total";
    EXPECT_EQ(files.find("/drop/a"), a);
    EXPECT_EQ(files.take_given_up(), 0U) << "active files must not be given up";
    EXPECT_TRUE(files.begin("/drop/f", "KBGM", "KBGM"))
        << "the new station should take a place from the station with two files";
    EXPECT_EQ(files.take_given_up(), 1U);
    EXPECT_EQ(files.find("/drop/a"), nullptr);
    files.forget("/drop/b");
    EXPECT_TRUE(files.begin("/drop/g", "KOKX", "KOKX"));
}

TEST_F(Living, BeyondTheBytesTheOldestLastVolumeGoes) {
    const level2::Volume volume = level2::decode(real_bytes(busy))->volume;
    const auto last_of = [&](const char* station, int minutes) {
        auto kept = std::make_shared<ShelvedVolume>();
        kept->shelf = SweepShelf::make_in(directory_.path()).value();
        (void)kept->shelf->put(volume.sweeps.front());
        kept->facts = later(volume, std::chrono::minutes{minutes});
        kept->facts.sweeps.clear();
        kept->facts.station = station;
        return kept;
    };
    const auto a = last_of("KAAA", 5);
    const std::uint64_t of_one = a->shelf->bytes();
    FollowedFiles files(FollowedFile::Options{{}, {level2::Moment::ref}, {}, directory_ / "living"},
                        GrowingLimits{.shelf_bytes = 2 * of_one});
    files.keep_last(a);
    files.keep_last(last_of("KBBB", 1));
    EXPECT_TRUE(files.last_of("KAAA") && files.last_of("KBBB"));
    files.keep_last(last_of("KCCC", 3));
    EXPECT_FALSE(files.last_of("KBBB"));
    EXPECT_TRUE(files.last_of("KAAA") && files.last_of("KCCC"));
    EXPECT_EQ(files.take_given_up(), 0U);

    // 2026-11-25: no real volume ever replaced a volume of the year 2040.
    const auto years = std::chrono::duration_cast<std::chrono::minutes>(std::chrono::years{25});
    files.keep_last(last_of("KAAA", static_cast<int>(years.count())));
    EXPECT_EQ(files.last_of("KAAA"), a);
}

TEST_F(Living, GrowthIsToldByTheRecords) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    append_to(path, std::span{bytes}.first(24));
    EXPECT_TRUE(FollowedFile::growing(path));
    append_to(path, std::span{bytes}.subspan(24, 1'000'000));
    EXPECT_TRUE(FollowedFile::growing(path));
    append_to(path, std::span{bytes}.subspan(1'000'024));
    EXPECT_FALSE(FollowedFile::growing(path));  // its last record ends the file
    EXPECT_FALSE(FollowedFile::growing(testing::real_file("volumes/KLIX20050828_180149.gz")));
    EXPECT_FALSE(FollowedFile::growing(directory_.path()));
    EXPECT_FALSE(FollowedFile::growing(directory_ / "nothing"));
}

TEST_F(Living, SweepsComeBackFromTheShelfBitForBit) {
    for (const char* name : {busy, "volumes/KTLX19990503_235621.gz"}) {
        const level2::Volume volume = level2::decode(real_bytes(name))->volume;
        const auto shelf = SweepShelf::make_in(directory_.path());
        ASSERT_TRUE(shelf);
        std::vector<SweepShelf::Place> places;
        for (const level2::Sweep& sweep : volume.sweeps)
            places.push_back((*shelf)->put(sweep).value());
        level2::Volume back = volume;
        for (std::size_t i = 0; i < places.size(); ++i)
            back.sweeps[i] = (*shelf)->get(places[i]).value();
        EXPECT_EQ(level2::difference(volume, back), "") << name;
        EXPECT_GT((*shelf)->bytes(), 0U);
        // Reading from a damaged place gives an error, not a sweep.
        SweepShelf::Place beyond = places.back();
        beyond.offset += 1'000'000'000;
        EXPECT_FALSE((*shelf)->get(beyond));
        SweepShelf::Place shifted = places.back();
        shifted.offset -= 1;
        EXPECT_FALSE((*shelf)->get(shifted));
    }
    EXPECT_FALSE(SweepShelf::make_in(directory_ / "nowhere"));
}

TEST(Xxh3Stream, IsThatOfAllBytesWhereverTheyAreCut) {
    std::vector<std::byte> bytes(100'000);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::byte>(i * i >> 3U);
    for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{999}, bytes.size()}) {
        Xxh3Stream stream;
        stream.append(std::span{bytes}.first(cut));
        stream.append(std::span{bytes}.subspan(cut));
        EXPECT_EQ(stream.value(), xxh3_64(bytes));
    }
    EXPECT_EQ(Xxh3Stream{}.value(), xxh3_64({}));
}

}  // namespace
}  // namespace stormcellar::pipeline
