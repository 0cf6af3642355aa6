// Tests frames (mosaics) that are updated when a volume comes. They must equal frames that are
// merged whole, bit for bit, with real volumes of three sites in every order of arrival.
#include "pipeline/mosaic/frame_parts.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "level2/decode/volume_checks.h"
#include "pipeline/mosaic/instant_cache.h"
#include "stormcellar/base/version.h"
#include "stormcellar/level2/decode.h"
#include "tests/pipeline/small_domain.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

using grid::GridWindow;
using std::chrono::milliseconds;
using std::chrono::minutes;

const UtcTime instant = *parse_utc("2010-09-11T01:20:00Z", UtcTime{});

grid::GridSpec domain() {
    return coarse_spec(41.4, -75.6, 220);
}

// A partial, and the time of its volume's middle relative to the instant.
struct Source {
    std::string file, icao;
    minutes middle;
};
const std::vector<Source> sources = {
    {"sequence-kbgm/KBGM20050822_024414.gz", "KBGM", minutes{-3}},
    {"sequence-kbgm/KBGM20050822_025001.gz", "KBGM", minutes{3}},
    {"mosaic-northeast/KDOX20100911_012056_V04.gz", "KDOX", minutes{-4}},
    {"mosaic-northeast/KDOX20100911_012056_V04.gz", "KDOX", minutes{2}},
    {"mosaic-northeast/KTYX20100911_012210_V04.gz", "KTYX", minutes{-1}},
};

void shift(cache::GridDescription& description, milliseconds by) {
    for (UtcTime* time : {&description.time, &description.start_time, &description.end_time})
        *time += by;
    for (grid::SweepTime& sweep : description.provenance.sweeps)
        sweep.start += by;
}

MadePartial make(const Source& source, GeometryCache& geometries) {
    level2::DecodeOptions decoding;
    decoding.fallback_station = source.icao;
    auto decoded = level2::decode(*read_file(testing::real_file(source.file)), decoding);
    const auto antenna = level2::antenna_position(decoded->volume);
    PartialOptions options;
    options.quantization = grid::default_quantization(level2::Moment::ref);
    options.reach_m = 200'000;  // KTYX and KDOX then have no common brick
    auto made = make_partial(
        decoded->volume,
        {source.icao, antenna->latitude_deg, antenna->longitude_deg, antenna->altitude_m}, domain(),
        options, geometries);
    MadePartial partial = std::move(**made);
    partial.description.provenance.source_files = {source.file};
    const PartialView view{&partial.description, {}};
    shift(partial.description, instant + source.middle - view.middle());
    return partial;
}

std::vector<std::byte> bytes_of(const cache::GridDescription& description,
                                const grid::BrickView& view) {
    const testing::TemporaryDirectory directory;
    EXPECT_TRUE(write_grid_file(real_file_system(), directory / "frame.scg", description, view));
    return *read_file(directory / "frame.scg");
}

class FrameParts : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        if (!testing::data_directory()) return;
        geometries_ = new GeometryCache(8);
        partials_ = new std::vector<MadePartial>;
        for (const Source& source : sources)
            partials_->push_back(make(source, *geometries_));
    }
    static void TearDownTestSuite() {
        delete partials_;
        delete geometries_;
    }
    void SetUp() override { STORMCELLAR_NEED_DATA(); }

    static PartialView view(std::size_t at) {
        return {&partials_->at(at).description, partials_->at(at).bricks.view()};
    }
    static std::vector<PartialView> views(const std::vector<std::size_t>& which) {
        std::vector<PartialView> all;
        for (const std::size_t at : which)
            all.push_back(view(at));
        return all;
    }
    static MosaicFrame frame(const std::vector<std::size_t>& which,
                             const MosaicFrame* previous = nullptr, FrameOptions options = {},
                             InstantCache* instants = nullptr) {
        options.threads = 2;
        const PreviousFrame before =
            previous == nullptr
                ? PreviousFrame{}
                : PreviousFrame{&previous->description, previous->mosaic.cells.view()};
        auto made = make_frame(domain(), views(which), instant, options, *geometries_,
                               {previous == nullptr ? nullptr : &before, instants});
        EXPECT_TRUE(made) << made.error().message;
        return std::move(*made);
    }
    static std::vector<std::byte> bytes(const MosaicFrame& of) {
        return bytes_of(of.description, of.mosaic.cells.view());
    }

    static inline GeometryCache* geometries_ = nullptr;
    static inline std::vector<MadePartial>* partials_ = nullptr;
};

// Each new volume updates the earlier frame, in all 120 orders of five volumes.
TEST_F(FrameParts, AFrameBroughtUpToDateHasTheBytesOfOneMadeWhole) {
    // The bytes of whole frames, by their volumes.
    std::map<std::vector<std::size_t>, std::vector<std::byte>> whole;
    const auto whole_of = [&](std::vector<std::size_t> which) -> const std::vector<std::byte>& {
        std::sort(which.begin(), which.end());
        const auto found = whole.find(which);
        if (found != whole.end()) return found->second;
        const MosaicFrame made = frame(which);
        EXPECT_FALSE(made.merged);
        return whole[which] = bytes(made);
    };
    std::vector<std::size_t> order(sources.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    InstantCache instants(std::size_t{64} << 20U);
    int updated = 0, orders = 0;
    do {
        std::optional<MosaicFrame> stands;
        for (std::size_t count = 1; count <= order.size(); ++count) {
            const std::vector<std::size_t> come(order.begin(),
                                                order.begin() + static_cast<std::ptrdiff_t>(count));
            MosaicFrame now =
                frame(come, stands ? &*stands : nullptr, {}, orders % 2 == 0 ? &instants : nullptr);
            if (now.merged) ++updated;
            EXPECT_EQ(now.merged.has_value(), count > 1);
            ASSERT_EQ(bytes(now), whole_of(come)) << ::testing::PrintToString(come);
            stands = std::move(now);
        }
        ++orders;
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(updated, 120 * 4);
    EXPECT_EQ(whole.size(), 31U) << "every set of volumes should occur";
}

// The test alters codes without changing the table. If the frames stay the same, the codes were not
// read.
TEST_F(FrameParts, ASitesGridForAnInstantIsMadeOnce) {
    InstantCache instants(std::size_t{64} << 20U);
    const MosaicFrame made = frame({0, 1, 2, 3, 4}, nullptr, {}, &instants);
    EXPECT_GT(instants.bytes(), 0U);
    std::vector<PartialView> altered = views({0, 1, 2, 3, 4});
    const std::vector<std::byte> spoilt(altered[0].view.codes.size(), std::byte{99});
    altered[0].view.codes = spoilt;
    FrameOptions options;
    const auto again =
        make_frame(domain(), altered, instant, options, *geometries_, {nullptr, &instants});
    ASSERT_TRUE(again);
    EXPECT_EQ(bytes(*again), bytes(made));
    const auto without = make_frame(domain(), altered, instant, options, *geometries_);
    ASSERT_TRUE(without);
    EXPECT_NE(bytes(*without), bytes(made));
    options.time = grid::TimeMethod::blend;
    const auto other =
        make_frame(domain(), altered, instant, options, *geometries_, {nullptr, &instants});
    ASSERT_TRUE(other);
    EXPECT_NE(bytes(*other), bytes(frame({0, 1, 2, 3, 4}, nullptr, options)))
        << "a frame by another recipe must not reuse the grid";
}

TEST_F(FrameParts, OnlyWindowsOfSitesThatChangedAreMerged) {
    const MosaicFrame before = frame({0, 2, 3, 4});
    const MosaicFrame now = frame({0, 1, 2, 3, 4}, &before);
    const GridWindow kbgm = *grid::window_of(domain(), partials_->at(0).description.spec);
    ASSERT_TRUE(now.merged);
    for (const GridWindow& window : *now.merged)
        EXPECT_EQ(window, kbgm);
    EXPECT_LT(kbgm.nx * kbgm.ny, 0.5 * domain().nx * domain().ny) << "most bricks should be copied";
    EXPECT_TRUE(frame({0, 1, 2, 3, 4}, &now).merged->empty())
        << "unchanged partials need no merging";
}

TEST_F(FrameParts, WhatASiteThatIsGoneShowedGoes) {
    const MosaicFrame before = frame({0, 1, 2, 3, 4});
    const MosaicFrame now = frame({0, 1, 4}, &before);
    ASSERT_TRUE(now.merged);
    EXPECT_EQ(bytes(now), bytes(frame({0, 1, 4})));
    EXPECT_NE(bytes(now), bytes(before));
}

TEST_F(FrameParts, AFrameByOtherRulesIsNotCopiedFrom) {
    const MosaicFrame before = frame({0, 1, 2});
    FrameOptions shorter;
    shorter.overlap.length_m = 100'000;
    EXPECT_FALSE(frame({0, 1, 2, 3}, &before, shorter).merged);
    FrameOptions still;
    still.time = grid::TimeMethod::nearest;
    EXPECT_FALSE(frame({0, 1, 2, 3}, &before, still).merged);
    MosaicFrame older = frame({0, 1, 2});
    older.description.provenance.software_version = "0.0.1";
    EXPECT_FALSE(frame({0, 1, 2, 3}, &older).merged);
    MosaicFrame unknown = frame({0, 1, 2});
    unknown.description.provenance.parts.clear();
    EXPECT_FALSE(frame({0, 1, 2, 3}, &unknown).merged)
        << "a frame without recorded parts cannot be updated";
}

TEST_F(FrameParts, AFingerprintIsOfAllThatCountsAndOfNothingElse) {
    const PartialView stands = view(2);
    const std::uint64_t fingerprint = fingerprint_of(stands);
    const auto with = [&](auto change) {
        cache::GridDescription description = *stands.description;
        change(description);
        return fingerprint_of({&description, stands.view});
    };
    using Description = cache::GridDescription;
    EXPECT_EQ(with([](Description& of) { of.provenance.source_files = {"other"}; }), fingerprint);
    EXPECT_EQ(with([](Description& of) { of.provenance.notes = {"a note"}; }), fingerprint);
    EXPECT_NE(with([](Description& of) { of.sites.front().altitude_m += 1; }), fingerprint);
    EXPECT_NE(with([](Description& of) { of.start_time += milliseconds{1}; }), fingerprint);
    EXPECT_NE(with([](Description& of) { of.provenance.sweeps.back().degrees_per_s += 1; }),
              fingerprint);
    EXPECT_NE(with([](Description& of) { of.spec.offset_x_cells += 16; }), fingerprint);
    std::vector<grid::BrickEntry> bricks(stands.view.bricks.begin(), stands.view.bricks.end());
    grid::BrickView altered = stands.view;
    altered.bricks = bricks;
    EXPECT_EQ(fingerprint_of({stands.description, altered}), fingerprint);
    const auto stored = std::find_if(bricks.begin(), bricks.end(), [](const grid::BrickEntry& one) {
        return one.kind == grid::BrickKind::stored;
    });
    ASSERT_NE(stored, bricks.end());
    stored->packed_bytes = 77;
    EXPECT_EQ(fingerprint_of({stands.description, altered}), fingerprint)
        << "packed sizes are facts of the file, not of the cells";
    stored->checksum ^= 1;
    EXPECT_NE(fingerprint_of({stands.description, altered}), fingerprint);
}

// A partial in a file has the same fingerprint as in memory, so cache and command line agree.
TEST_F(FrameParts, AFileHasTheFingerprintOfWhatWasWritten) {
    const testing::TemporaryDirectory directory;
    for (const auto packing : {cache::Packing::none, cache::Packing::lz4}) {
        const PartialView written = view(4);
        ASSERT_TRUE(write_grid_file(real_file_system(), directory / "part.scg",
                                    *written.description, written.view, packing));
        const auto file = cache::GridFile::open(directory / "part.scg");
        ASSERT_TRUE(file);
        EXPECT_EQ(fingerprint_of({&file->description(), file->view()}), fingerprint_of(written));
    }
}

TEST(ChangedWindows, AreThoseOfSitesWhosePartsDiffer) {
    const GridWindow west{0, 0, 32, 32}, east{64, 0, 32, 32}, moved{48, 0, 32, 32};
    const grid::FramePart a{"KAAA", instant, 1, west}, a2{"KAAA", instant + minutes{5}, 2, west};
    const grid::FramePart b{"KBBB", instant, 3, east}, b2{"KBBB", instant, 4, moved};
    using Parts = std::vector<grid::FramePart>;
    using Windows = std::vector<GridWindow>;
    EXPECT_EQ(changed_windows(Parts{a, b}, Parts{a, b}), Windows{});
    EXPECT_EQ(changed_windows(Parts{a, b}, Parts{a, a2, b}), (Windows{west, west, west}));
    EXPECT_EQ(changed_windows(Parts{a, b}, Parts{a, b2}), (Windows{east, moved}));
    EXPECT_EQ(changed_windows(Parts{a}, Parts{a, b}), Windows{east});
    EXPECT_EQ(changed_windows(Parts{a, b}, Parts{b}), Windows{west});
}

TEST(ShareBricks, IsByBricksNotByCells) {
    EXPECT_TRUE(share_bricks({0, 0, 16, 16}, {0, 0, 16, 16}));
    EXPECT_FALSE(share_bricks({0, 0, 16, 16}, {16, 0, 16, 16}));
    EXPECT_FALSE(share_bricks({0, 0, 16, 16}, {0, 16, 16, 16}));
    EXPECT_TRUE(share_bricks({0, 0, 17, 16}, {31, 0, 1, 16}))
        << "both windows use the second brick";
}

}  // namespace
}  // namespace stormcellar::pipeline
