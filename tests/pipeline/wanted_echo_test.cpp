// Tests that echo that is probably not weather is left out of all grids that an Ingestor makes.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "level2/decode/volume_checks.h"
#include "pipeline/ingest/living_sweeps.h"
#include "pipeline/keep/keep_rule.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/pipeline/living_house.h"
#include "tests/pipeline/small_domain.h"

namespace stormcellar::pipeline {
namespace {

using level2::Moment;

constexpr double least = 0.5;
constexpr const char* snow = "volumes/KDMX20220305_232324.trimmed.ar2v";
constexpr const char* single_polarization = "sequence-kbgm/KBGM20050822_024414.gz";
constexpr std::string_view kept_at_half = "probability of weather at least 0.5";

retrieve::DerivedOptions weather_alone() {
    retrieve::DerivedOptions options;
    options.quality = least;
    return options;
}

class WantedEcho : public SmallHouse {
  protected:
    static IngestOptions with_quality() {
        IngestOptions options = small_grid();
        options.moments = {Moment::ref, Moment::veld, Moment::pow};
        options.derived.quality = least;
        options.domains = {small_domain()};
        return options;
    }
    WantedEcho() : SmallHouse(with_quality()) {}
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    cache::GridFile only_grid(const std::string& domain, Moment moment) {
        const auto entries = *store_.list(domain, moment, std::nullopt, std::nullopt);
        EXPECT_EQ(entries.size(), 1U);
        return std::move(*cache::GridFile::open(entries.at(0).path));
    }
};

// Grids of a moment have the cells that `stormcellar grid FILE --quality 0.5` makes. Of the moments
// in the file, only REF is wanted. The other moments are decoded to compute VELD and to judge the
// echo.
TEST_F(WantedEcho, IsInEachGridOfAFileAndTheNotesGiveTheShare) {
    const fs::path path = testing::real_file(snow);
    const auto outcome = ingestor_.ingest(path, true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    ASSERT_EQ(outcome->grids.size(), 3U);
    level2::Volume volume = std::move(level2::decode_file(path)->volume);
    const auto derived = retrieve::add_derived_moments(
        volume, std::array{Moment::ref, Moment::veld, Moment::pow}, weather_alone());
    ASSERT_TRUE(derived);
    const auto antenna = level2::antenna_position(volume).value();
    const grid::SitePosition site{"KDMX", antenna.latitude_deg, antenna.longitude_deg,
                                  antenna.altitude_m};
    for (const Moment moment : {Moment::ref, Moment::veld, Moment::pow}) {
        SCOPED_TRACE(level2::moment_name(moment));
        const cache::GridFile file = only_grid("KDMX", moment);
        const auto geometry = grid::make_column_geometry(site, file.description().spec);
        const auto made = grid::make_grid(volume, site, **geometry, {moment, 0, 1, {}});
        ASSERT_TRUE(made);
        const auto bricks = grid::BrickGrid::from(*made, grid::default_quantization(moment));
        EXPECT_TRUE(std::ranges::equal(file.view().codes, bricks.view().codes));
        EXPECT_TRUE(std::ranges::equal(file.view().states, bricks.view().states));
        EXPECT_EQ(retrieve::quality_in_notes(file.description().provenance.notes),
                  retrieve::quality_in_notes(derived->notes));
    }
}

TEST_F(WantedEcho, IsInMosaicsTooWhoseNotesGiveTheThreshold) {
    for (const std::string& name : {sequence[0], sequence[1]})
        ASSERT_TRUE(ingestor_.ingest(testing::real_file("sequence-kbgm") / name, false));
    const auto own = *store_.list("KBGM", Moment::ref, std::nullopt, std::nullopt);
    const auto partials = *store_.list("north.KBGM", Moment::ref, std::nullopt, std::nullopt);
    const auto frames = *store_.list("north", Moment::ref, std::nullopt, std::nullopt);
    ASSERT_EQ(partials.size(), 2U);
    ASSERT_FALSE(frames.empty());
    const auto note_of = [](const cache::StoreEntry& entry) {
        return retrieve::quality_in_notes(
            cache::GridFile::open(entry.path)->description().provenance.notes);
    };
    EXPECT_EQ(note_of(own.at(0)), note_of(partials.at(0)));
    EXPECT_NE(note_of(own.at(0)).find(" % of the echo left out"), std::string::npos);
    EXPECT_EQ(note_of(frames.at(0)).substr(0, kept_at_half.size()), kept_at_half);
}

struct DifferingEcho {
    std::size_t echo = 0;       // gates of reflectivity with echo, left out or not
    std::size_t differing = 0;  // gates that only one of the two volumes has
};
DifferingEcho differing_echo(const level2::Volume& living, const level2::Volume& final,
                             const level2::Volume& all) {
    DifferingEcho found;
    for (std::size_t i = 0; i < living.sweeps.size(); ++i) {
        const auto& a = living.sweeps[i].find(Moment::ref)->codes8;
        const auto& b = final.sweeps.at(i).find(Moment::ref)->codes8;
        const auto& whole = all.sweeps.at(i).find(Moment::ref)->codes8;
        EXPECT_EQ(a.size(), whole.size());
        for (std::size_t gate = 0; gate < whole.size(); ++gate) {
            found.echo += whole[gate] > 1 ? 1U : 0U;
            found.differing += a[gate] != b[gate] ? 1U : 0U;
        }
    }
    return found;
}

// Lets a file grow by records, reads the living sweeps of REF after each, and compares the last
// sweeps with the complete volume.
DifferingEcho grown(const fs::path& path, std::span<const std::byte> bytes) {
    FollowedFile::Options options;
    options.scratch = path.parent_path();
    std::unique_ptr<FollowedFile> followed;
    level2::Volume newest;
    std::size_t from = 0;
    for (const std::size_t end : synth::piece_ends(bytes)) {
        append_to(path, bytes.subspan(from, end - from));
        from = end;
        if (!followed) followed = std::move(*FollowedFile::begin(path, options));
        EXPECT_TRUE(followed->read_to(end));
        const MomentSet only_ref = MomentSet{}.set(static_cast<std::size_t>(Moment::ref));
        const auto read = [&] {
            auto living = LivingSweeps::read(followed->kept(), nullptr, only_ref, weather_alone());
            EXPECT_TRUE(living);
            newest = living->volume_of(Moment::ref);
            EXPECT_EQ(living->left_out().echo > 0, !newest.sweeps.empty());
        };
        read();
        const std::uint64_t before = followed->kept().shelf->bytes();
        read();
        EXPECT_EQ(followed->kept().shelf->bytes(), before) << "each sweep is judged once";
    }
    level2::Volume all = std::move(level2::decode(bytes)->volume), final = all;
    (void)retrieve::keep_weather(final, least);
    for (level2::Volume* volume : {&all, &final})
        std::erase_if(volume->sweeps, [](const level2::Sweep& sweep) {
            return sweep.find(Moment::ref) == nullptr;
        });
    EXPECT_GE(newest.sweeps.size() + 1, final.sweeps.size());
    return differing_echo(newest, final, all);
}

// With dual polarization, the sweeps of a growing volume are those of the final grid. The last
// sweep is complete only with the volume.
TEST_F(Living, ASweepIsJudgedOnceAndAsInTheWholeVolume) {
    const DifferingEcho dual = grown(directory_ / "KLOT20220317_000842_V06", real_bytes(busy));
    EXPECT_GT(dual.echo, 100'000U);
    EXPECT_EQ(dual.differing, 0U);
}

// Without dual polarization, the sweep above has not come when a sweep is judged.
TEST_F(Living, WithoutDualPolarizationASweepIsJudgedWithoutTheSweepAbove) {
    const auto encoded =
        level2::encode(level2::decode_file(testing::real_file(single_polarization))->volume);
    ASSERT_TRUE(encoded) << encoded.error().message;
    const DifferingEcho single = grown(directory_ / "KBGM20050822_024414", encoded->joined());
    EXPECT_GT(single.echo, 100'000U);
    const double share = static_cast<double>(single.differing) / static_cast<double>(single.echo);
    RecordProperty("share", std::to_string(share));
    EXPECT_GT(share, 0);
    EXPECT_LE(share, 0.1);
}

// The second volume shows sweeps of the first volume that have not come again. The same echo is
// left out of them.
TEST_F(Living, TheFinalGridsOfWeatherDoNotDependOnTheGrowth) {
    const std::vector<Moment> moments = {Moment::ref, Moment::veld};
    House growing(directory_ / "growing", true, {}, moments, least);
    House whole(directory_ / "whole", false, {}, moments, least);
    const std::vector<std::byte> first = real_bytes(busy);
    const auto encoded =
        level2::encode(later(level2::decode(first)->volume, std::chrono::minutes{6}));
    ASSERT_TRUE(encoded) << encoded.error().message;
    const std::vector<std::byte> second = encoded->joined();
    for (const auto& [name, bytes] :
         {std::pair{"KLOT20220317_000842_V06", &first}, {"KLOT20220317_001442_V06", &second}}) {
        const fs::path path = directory_ / name;
        const bool is_first = bytes == &first;
        (void)grow(growing, path, *bytes, is_first ? 1000 : 20);
        if (!is_first) break;
        ASSERT_EQ(whole.ingestor->ingest(path, false)->result(), IngestResult::gridded);
    }
    for (const Moment moment : moments) {
        SCOPED_TRACE(level2::moment_name(moment));
        const auto made = growing.grids("KLOT", moment), expected = whole.grids("KLOT", moment);
        ASSERT_EQ(made.size(), 2U);
        ASSERT_EQ(expected.size(), 1U);
        EXPECT_EQ(*read_file(made[0].path), *read_file(expected[0].path));
        const auto living = cache::GridFile::open(made[1].path);
        ASSERT_TRUE(living);
        const auto& notes = living->description().provenance.notes;
        EXPECT_TRUE(std::ranges::any_of(
            notes, [](const std::string& note) { return note.starts_with(living_note); }));
        EXPECT_EQ(retrieve::quality_in_notes(notes).substr(0, kept_at_half.size()), kept_at_half);
        EXPECT_EQ(retrieve::quality_in_notes(notes).find("; 0.0 %"), std::string::npos);
    }
}

TEST_F(LivingChunks, EndWithoutTheEchoThatTheWholeFileLacks) {
    House growing(directory_ / "growing", true, {}, {Moment::ref}, least);
    House whole(directory_ / "whole weather", false, {}, {Moment::ref}, least);
    const fs::path file = directory_ / "KLOT20220317_000842_V06";
    ASSERT_EQ(whole.ingestor->ingest(file, false)->result(), IngestResult::gridded);
    for (std::size_t i = 0; i < names_.size(); ++i)
        (void)take(growing, i);
    const auto made = cache::GridFile::open(growing.grids("KLOT").at(0).path);
    const auto expected = cache::GridFile::open(whole.grids("KLOT").at(0).path);
    const auto all = cache::GridFile::open(whole_.grids("KLOT").at(0).path);
    ASSERT_TRUE(made && expected && all);
    EXPECT_TRUE(std::ranges::equal(made->view().codes, expected->view().codes));
    EXPECT_TRUE(std::ranges::equal(made->view().states, expected->view().states));
    EXPECT_FALSE(std::ranges::equal(made->view().states, all->view().states));
    EXPECT_EQ(retrieve::quality_in_notes(made->description().provenance.notes),
              retrieve::quality_in_notes(expected->description().provenance.notes));
}

}  // namespace
}  // namespace stormcellar::pipeline
