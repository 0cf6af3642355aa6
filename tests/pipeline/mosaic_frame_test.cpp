// Tests mosaics (frames) of several sites, with real and synthetic volumes.
#include "pipeline/mosaic/mosaic_frame.h"

#include <gtest/gtest.h>

#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/level2/decode.h"
#include "tests/pipeline/small_domain.h"
#include "tests/testing/data.h"

namespace stormcellar::pipeline {
namespace {

struct SiteVolume {
    level2::Volume volume;
    grid::SitePosition site;
};

SiteVolume load(const std::string& name) {
    auto decoded = level2::decode_path(testing::real_file(name));
    EXPECT_TRUE(decoded);
    const auto antenna = level2::antenna_position(decoded->volume);
    SiteVolume source{std::move(decoded->volume), {}};
    source.site = {source.volume.station, antenna->latitude_deg, antenna->longitude_deg,
                   antenna->altitude_m};
    return source;
}

grid::GridSpec northeast() {
    return coarse_spec(41.8, -75, 200);
}

// Makes frames of a domain in the northeast from real volumes.
class RealFrames : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    void add(const std::string& name) {
        const SiteVolume source = load(name);
        PartialOptions options;
        options.quantization = grid::default_quantization(level2::Moment::ref);
        auto made = make_partial(source.volume, source.site, northeast(), options, geometries_);
        ASSERT_TRUE(made) << made.error().message;
        ASSERT_TRUE(*made);
        (*made)->description.provenance.source_files = {name};
        partials_.push_back(std::move(**made));
    }
    [[nodiscard]] std::vector<PartialView> views() const {
        std::vector<PartialView> views;
        for (const MadePartial& partial : partials_)
            views.push_back({&partial.description, partial.bricks.view()});
        return views;
    }
    Result<MosaicFrame> frame(UtcTime instant, FrameOptions options = {}) {
        return make_frame(northeast(), views(), instant, options, geometries_);
    }

    GeometryCache geometries_{8};
    std::vector<MadePartial> partials_;
};

std::vector<std::uint16_t> all_codes(const grid::BrickView& view) {
    std::vector<std::uint16_t> codes;
    for (int ix = 0; ix < view.spec->nx; ++ix) {
        for (int iy = 0; iy < view.spec->ny; ++iy) {
            for (int iz = 0; iz < view.spec->nz(); ++iz) {
                const auto status = view.status(ix, iy, iz);
                codes.push_back(
                    status == grid::CellStatus::value
                        ? view.code_at(view.offset_x(ix) + view.offset_y(iy) + view.offset_z(iz))
                        : static_cast<std::uint16_t>(status));
            }
        }
    }
    return codes;
}

TEST_F(RealFrames, OrderOfArrivalAndThreadsChangeNoBit) {
    for (const char* name : {"KBGM20100911_012056_V03", "KDIX20100911_011759_V03",
                             "KENX20100911_011108_V03", "KOKX20100911_011047_V03"}) {
        add(std::string("mosaic-northeast/") + name + ".gz");
    }
    const UtcTime instant = *parse_utc("2010-09-11T01:22:00Z", UtcTime{});
    const auto one = frame(instant);
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_TRUE(one->description.provenance.provisional)
        << "the frame is provisional, because no site has a later volume";
    EXPECT_EQ(one->description.sites.size(), 4U);
    EXPECT_EQ(one->description.time, instant);
    std::reverse(partials_.begin(), partials_.end());
    FrameOptions options;
    options.threads = 4;
    const auto other = frame(instant, options);
    ASSERT_TRUE(other);
    EXPECT_EQ(all_codes(one->mosaic.cells.view()), all_codes(other->mosaic.cells.view()));
}

TEST_F(RealFrames, BetweenTwoVolumesNeitherStands) {
    add("sequence-kbgm/KBGM20050822_024414.gz");
    add("sequence-kbgm/KBGM20050822_025001.gz");
    const UtcTime before = views()[0].middle(), after = views()[1].middle();
    const UtcTime instant = before + (after - before) / 2;
    FrameOptions nearest;
    nearest.time = grid::TimeMethod::nearest;
    const auto made = frame(instant), stands = frame(instant, nearest);
    ASSERT_TRUE(made && stands);
    EXPECT_FALSE(made->description.provenance.provisional);
    EXPECT_NE(all_codes(made->mosaic.cells.view()), all_codes(stands->mosaic.cells.view()));
    EXPECT_EQ(made->description.provenance.source_files.size(), 2U);
    EXPECT_EQ(stands->description.provenance.source_files.size(), 1U);
    EXPECT_NE(made->description.provenance.effects.find("time: advected"), std::string::npos);
}

TEST_F(RealFrames, ASiteWithoutAVolumeNearTheInstantIsLeftOut) {
    add("sequence-kbgm/KBGM20050822_024414.gz");
    const UtcTime late = views()[0].middle() + std::chrono::minutes{16};
    const auto none = frame(late);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::not_found);
    EXPECT_TRUE(frame(late - std::chrono::minutes{2}));
}

TEST_F(RealFrames, ASiteThatDoesNotReachTheDomainHasNoPartial) {
    const SiteVolume source = load("volumes/KTLX19990503_235621.gz");
    const auto made = make_partial(source.volume, source.site, northeast(), {}, geometries_);
    ASSERT_TRUE(made);
    EXPECT_FALSE(*made);
}

TEST(Brackets, AreTheNearestOfEachSiteOnEitherSide) {
    std::vector<cache::GridDescription> all(5);
    const UtcTime start{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1}};
    const auto set = [&](std::size_t at, const char* icao, int minute) {
        all[at].sites = {{icao, 0, 0, 0}};
        all[at].start_time = all[at].end_time = start + std::chrono::minutes{minute};
    };
    set(0, "KBBB", 0);
    set(1, "KBBB", 5);
    set(2, "KBBB", 10);
    set(3, "KAAA", 30);
    set(4, "KCCC", 7);
    std::vector<PartialView> views;
    for (const auto& description : all)
        views.push_back({&description, {}});
    const auto brackets =
        brackets_of(views, start + std::chrono::minutes{7}, std::chrono::minutes{15});
    ASSERT_EQ(brackets.size(), 2U);  // KAAA is too late
    EXPECT_EQ(brackets[0].before, 1U);
    EXPECT_EQ(brackets[0].after, 2U);
    EXPECT_EQ(brackets[1].before, 4U);  // a volume at the instant counts as before the instant
    EXPECT_FALSE(brackets[1].after);
}

}  // namespace
}  // namespace stormcellar::pipeline
