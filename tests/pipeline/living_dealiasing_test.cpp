// Tests that a growing volume is dealiased sweep by sweep, each sweep once, and as a whole at its
// end.
#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/ingest/living_sweeps.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/pipeline/living_house.h"

namespace stormcellar::pipeline {
namespace {

using level2::Moment;

constexpr const char* rain = "volumes/KLBB20160601_150025_V06";
constexpr const char* rain_name = "KLBB20160601_150025_V06";
constexpr std::uint16_t ambiguous_code = 2;

int velocity_sweeps(const level2::Volume& volume) {
    return static_cast<int>(std::ranges::count_if(volume.sweeps, [](const level2::Sweep& sweep) {
        return sweep.find(Moment::vel) != nullptr;
    }));
}

MomentSet only(Moment moment) {
    return MomentSet{}.set(static_cast<std::size_t>(moment));
}

struct Shares {
    double values = 0, marks = 0;  // of the gates with a velocity
};
Shares differing_shares(const level2::Volume& living, const level2::Volume& final) {
    std::size_t gates = 0, values = 0, marks = 0, next = 0;
    for (const level2::Sweep& sweep : living.sweeps) {
        while (final.sweeps.at(next).radials.front().time != sweep.radials.front().time)
            ++next;
        const auto& a = sweep.find(Moment::veld)->codes16;
        const auto& b = final.sweeps[next].find(Moment::veld)->codes16;
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (a[i] < ambiguous_code) continue;
            ++gates;
            if (a[i] != b[i]) ++(a[i] == ambiguous_code || b[i] == ambiguous_code ? marks : values);
        }
    }
    EXPECT_GT(gates, 100'000U);
    const auto share = [&](std::size_t part) {
        return static_cast<double>(part) / static_cast<double>(gates);
    };
    return {share(values), share(marks)};
}

// A real volume in fragments of one record.
TEST_F(Living, EachSweepIsDealiasedOnceAndNearlyAsInTheWholeVolume) {
    for (const auto& [file, name] :
         {std::pair{rain, rain_name}, std::pair{busy, "KLOT20220317_000842_V06"}}) {
        SCOPED_TRACE(name);
        const std::vector<std::byte> bytes = real_bytes(file);
        const fs::path path = directory_ / name;
        FollowedFile::Options options;
        options.moments = {Moment::veld};
        options.scratch = directory_.path();
        std::unique_ptr<FollowedFile> followed;
        int dealiased = 0;
        std::size_t from = 0, shown = 0;
        level2::Volume newest;
        for (const std::size_t end : synth::piece_ends(bytes)) {
            append_to(path, std::span{bytes}.subspan(from, end - from));
            from = end;
            if (!followed) followed = std::move(*FollowedFile::begin(path, options));
            ASSERT_TRUE(followed->read_to(end));
            auto living = LivingSweeps::read(followed->kept(), nullptr, only(Moment::veld), {});
            ASSERT_TRUE(living) << living.error().message;
            newest = living->volume_of(Moment::veld);
            EXPECT_EQ(living->dealiased(), static_cast<int>(newest.sweeps.size() - shown));
            shown = newest.sweeps.size();
            dealiased += living->dealiased();
        }
        const auto decoded = level2::decode(bytes);
        ASSERT_TRUE(decoded);
        EXPECT_EQ(dealiased, velocity_sweeps(decoded->volume));
        const auto final = retrieve::derived_velocities(decoded->volume, std::array{Moment::veld});
        ASSERT_TRUE(final);
        const Shares differing = differing_shares(newest, final->volume);
        EXPECT_LE(differing.values, 0.001);
        EXPECT_LE(differing.marks, 0.005);
        RecordProperty("values", std::to_string(differing.values));
        RecordProperty("marks", std::to_string(differing.marks));
    }
}

// 2026-11-30: each living grid of AZSH computed the shear of all sweeps again, and the national
// feed fell behind.
TEST_F(Living, EachSweepIsShelvedWithItsShear) {
    const std::vector<std::byte> bytes = real_bytes(rain);
    append_to(directory_ / rain_name, bytes);
    FollowedFile::Options options;
    options.moments = {Moment::veld, Moment::azsh};
    options.scratch = directory_.path();
    const auto followed = FollowedFile::begin(directory_ / rain_name, options);
    ASSERT_TRUE(followed);
    ASSERT_TRUE((*followed)->read_to(bytes.size()));
    const MomentSet moments = only(Moment::veld) | only(Moment::azsh);
    for (const bool is_shelved : {false, true}) {
        auto living = LivingSweeps::read((*followed)->kept(), nullptr, moments, {});
        ASSERT_TRUE(living) << living.error().message;
        EXPECT_EQ(living->dealiased() == 0, is_shelved);
        level2::Volume& made = living->volume_of(Moment::azsh);
        level2::Volume expected = made;
        for (level2::Sweep& sweep : expected.sweeps)
            EXPECT_EQ(std::erase_if(sweep.moments,
                                    [](const auto& one) { return one.moment == Moment::azsh; }),
                      1U);
        ASSERT_TRUE(retrieve::add_from_dealiased(expected, Moment::azsh, {}));
        for (std::size_t i = 0; i < made.sweeps.size(); ++i)
            EXPECT_EQ(made.sweeps[i].find(Moment::azsh)->codes16,
                      expected.sweeps[i].find(Moment::azsh)->codes16);
    }
}

int dealiased_in(const std::vector<IngestOutcome>& outcomes) {
    return std::accumulate(outcomes.begin(), outcomes.end(), 0, [](int sum, const auto& outcome) {
        return sum + outcome.dealiased_sweeps;
    });
}

// The second volume shows sweeps of the first that have not come again. They come from the final
// VELD of the first volume, and are not dealiased again.
TEST_F(Living, TheFinalGridsOfVelocitiesDoNotDependOnTheGrowth) {
    const std::vector<Moment> moments = {Moment::veld, Moment::srv};
    House growing(directory_ / "growing", true, {}, moments);
    House whole(directory_ / "whole", false, {}, moments);
    const std::vector<std::byte> first = real_bytes(rain);
    const auto encoded =
        level2::encode(later(level2::decode(first)->volume, std::chrono::minutes{6}));
    ASSERT_TRUE(encoded) << encoded.error().message;
    const std::vector<std::byte> second = encoded->joined();
    const int sweeps = velocity_sweeps(level2::decode(first)->volume);
    for (const auto& [name, bytes] :
         {std::pair{rain_name, &first}, {"KLBB20160601_150625_V06", &second}}) {
        const auto outcomes = grow(growing, directory_ / name, *bytes);
        EXPECT_EQ(outcomes.back().result(), IngestResult::gridded);
        EXPECT_EQ(dealiased_in(outcomes), sweeps - 1) << "the last sweep ends the volume";
        ASSERT_EQ(whole.ingestor->ingest(directory_ / name, false)->result(),
                  IngestResult::gridded);
    }
    for (const Moment moment : moments) {
        const auto made = growing.grids("KLBB", moment), expected = whole.grids("KLBB", moment);
        ASSERT_EQ(made.size(), 2U);
        ASSERT_EQ(expected.size(), 2U);
        for (std::size_t i = 0; i < made.size(); ++i)
            EXPECT_EQ(*read_file(made[i].path), *read_file(expected[i].path));
    }
}

// A living grid is the same whether its sweeps were dealiased when they came or together later.
TEST_F(Living, DealiasedSweepsDoNotDependOnWhenTheyAreShown) {
    Load load = Load::heavy;
    House prompt(directory_ / "prompt", true, {}, {Moment::veld});
    House hurried(directory_ / "hurried", true, [&] { return load; }, {Moment::veld});
    const std::vector<std::byte> bytes = real_bytes(rain);
    constexpr std::size_t pieces = 30;
    const fs::path often = directory_ / "often" / rain_name;
    const fs::path seldom = directory_ / "seldom" / rain_name;
    fs::create_directories(often.parent_path());
    fs::create_directories(seldom.parent_path());
    const int at_once = dealiased_in(grow(prompt, often, bytes, pieces));
    const int low_ones = dealiased_in(grow(hurried, seldom, bytes, pieces));
    ASSERT_LT(low_ones, at_once);
    load = Load::light;
    append_to(seldom, std::span{bytes}.subspan(fs::file_size(seldom), 1000));
    const auto later_ones = hurried.ingestor->ingest(seldom, false);
    ASSERT_TRUE(later_ones);
    EXPECT_EQ(low_ones + later_ones->dealiased_sweeps, at_once);
    ASSERT_EQ(prompt.grids("KLBB", Moment::veld).size(), 1U);
    ASSERT_EQ(hurried.grids("KLBB", Moment::veld).size(), 1U);
    EXPECT_EQ(*read_file(prompt.grids("KLBB", Moment::veld)[0].path),
              *read_file(hurried.grids("KLBB", Moment::veld)[0].path));
}

TEST_F(LivingChunks, AreDealiasedOnceAndEndAsTheWholeFile) {
    House growing(directory_ / "growing", true, {}, {Moment::veld});
    House whole(directory_ / "whole veld", false, {}, {Moment::veld});
    const fs::path file = directory_ / "KLOT20220317_000842_V06";
    ASSERT_EQ(whole.ingestor->ingest(file, false)->result(), IngestResult::gridded);
    std::vector<IngestOutcome> outcomes;
    for (std::size_t i = 0; i < names_.size(); ++i)
        outcomes.push_back(take(growing, i));
    EXPECT_EQ(outcomes.back().result(), IngestResult::gridded);
    EXPECT_EQ(dealiased_in(outcomes), velocity_sweeps(level2::decode(bytes_)->volume) - 1);
    const auto made = cache::GridFile::open(growing.grids("KLOT", Moment::veld).at(0).path);
    const auto expected = cache::GridFile::open(whole.grids("KLOT", Moment::veld).at(0).path);
    ASSERT_TRUE(made && expected);
    EXPECT_TRUE(std::ranges::equal(made->view().codes, expected->view().codes));
    EXPECT_TRUE(std::ranges::equal(made->view().states, expected->view().states));
}

}  // namespace
}  // namespace stormcellar::pipeline
