#include <array>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

TEST(SplitVolumes, AnOrdinaryFileIsOneVolume) {
    auto decoded = decode(wire::ldm_volume(3, 5)).value();
    const auto volumes = split_volumes(std::move(decoded));
    ASSERT_EQ(volumes.size(), 1);
    EXPECT_EQ(volumes[0].sweeps.size(), 3);
    EXPECT_EQ(volumes[0].vcp, 212);
    EXPECT_TRUE(volumes[0].block);
}

TEST(SplitVolumes, AFileWithoutRadialsIsOneVolume) {
    auto decoded = decode(wire::join({wire::archive_header(), wire::frame(2)})).value();
    EXPECT_EQ(split_volumes(std::move(decoded)).size(), 1);
}

TEST(SplitVolumes, AFurtherHeaderGoesWithItsVolume) {
    const wire::Bytes first = wire::ldm_volume(2, 5);
    wire::Bytes second = wire::ldm_volume(3, 4);
    const wire::Bytes header = wire::archive_header("AR2V0006.117");
    std::copy(header.begin(), header.end(), second.begin());
    const auto volumes = split_volumes(decode(wire::join({first, second})).value());
    ASSERT_EQ(volumes.size(), 2);
    EXPECT_EQ(volumes[0].sweeps.size(), 2);
    EXPECT_EQ(volumes[1].sweeps.size(), 3);
    EXPECT_EQ(volumes[0].header->filename, "AR2V0006.116");
    EXPECT_EQ(volumes[1].header->filename, "AR2V0006.117");
    EXPECT_EQ(volumes[1].station, "KTLX");
}

// The file has four volumes and one header. The name of each volume comes from its own start time.
TEST(SplitVolumes, VolumesUnderOneHeaderStartAtTheirFirstRadials) {
    STORMCELLAR_NEED_DATA();
    auto decoded =
        decode_file(*testing::data_directory() / "volumes" / "KBBX20060113_170337.gz").value();
    const std::size_t radials = decoded.volume.radial_count();
    const auto volumes = split_volumes(std::move(decoded));
    ASSERT_EQ(volumes.size(), 4);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        EXPECT_EQ(volumes[i].sweeps.size(), 17);
        sum += volumes[i].radial_count();
        if (i == 0) continue;
        EXPECT_EQ(volumes[i].start_time(), volumes[i].sweeps.front().radials.front().time);
        EXPECT_GT(volumes[i].start_time(), volumes[i - 1].start_time());
    }
    EXPECT_EQ(sum, radials);
}

// The two volumes have different patterns.
TEST(SplitVolumes, EachHasThePatternThatCameWithIt) {
    const std::array<float, 2> low = {0.5F, 1.5F};
    const std::array<float, 3> high = {0.5F, 3.5F, 9.0F};
    const auto record = [](unsigned pattern, std::span<const float> elevations_deg) {
        return wire::ldm_record(wire::vcp_frame(pattern, elevations_deg));
    };
    const auto volumes = split_volumes(
        decode(wire::join({wire::archive_header(), record(212, low),
                           wire::ldm_record(wire::radial_messages(2, 4)), record(35, high),
                           wire::ldm_record(wire::radial_messages(3, 4), true)}))
            .value());
    ASSERT_EQ(volumes.size(), 2);
    ASSERT_TRUE(volumes[0].vcp_message && volumes[1].vcp_message);
    EXPECT_EQ(volumes[0].vcp, 212);
    EXPECT_EQ(volumes[0].vcp_message->cuts.size(), 2U);
    EXPECT_EQ(volumes[1].vcp, 35);
    EXPECT_EQ(volumes[1].vcp_source, VcpSource::message_5);
    EXPECT_EQ(volumes[1].vcp_message->cuts.size(), 3U);
}

// 2026-11-21: if a selection left nothing of a volume, the next volume got its header and pattern.
TEST(SplitVolumes, ASelectionKeepsTheHeadersOfTheVolumesThatHoldIt) {
    const auto volume = [](std::string_view filename, unsigned sweeps) {
        wire::Bytes bytes = wire::ldm_volume(sweeps, 4);
        const wire::Bytes header = wire::archive_header(filename);
        std::copy(header.begin(), header.end(), bytes.begin());
        return bytes;
    };
    wire::Bytes headless = volume("AR2V0006.000", 4);
    headless.erase(headless.begin(), headless.begin() + 24);
    const wire::Bytes file =
        wire::join({volume("AR2V0006.001", 2), volume("AR2V0006.002", 3), volume("AR2V0006.003", 2),
                    volume("AR2V0006.004", 3), volume("AR2V0006.005", 2), headless,
                    volume("AR2V0006.007", 1)});
    auto whole = split_volumes(decode(file).value());
    ASSERT_EQ(whole.size(), 7);
    std::erase_if(whole, [](const Volume& each) { return each.sweeps.size() < 3; });
    DecodeOptions options;
    options.selection.elevation_numbers = {3};
    const auto some = split_volumes(decode(file, options).value());
    ASSERT_EQ(some.size(), whole.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
        EXPECT_EQ(some[i].sweeps.size(), 1U);
        EXPECT_EQ(some[i].header->filename, whole[i].header->filename) << i;
        ASSERT_TRUE(some[i].vcp_message) << i;
        EXPECT_EQ(some[i].vcp_message->cuts.size(), whole[i].vcp_message->cuts.size()) << i;
    }
}

TEST(SplitVolumes, ASelectionOfNothingIsOneVolumeWithoutSweeps) {
    DecodeOptions options;
    options.selection.elevation_numbers = {99};
    const wire::Bytes two = wire::join({wire::ldm_volume(2, 4), wire::ldm_volume(3, 4)});
    const auto volumes = split_volumes(decode(two, options).value());
    ASSERT_EQ(volumes.size(), 1);
    EXPECT_TRUE(volumes[0].sweeps.empty());
    EXPECT_EQ(volumes[0].vcp_message->cuts.size(), 2U);
}

}  // namespace
}  // namespace stormcellar::level2
