#include "stormcellar/level2/describe.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/level2/moment_statistics.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

TEST(Describe, HasTheFactsOfAFileMadeByHand) {
    const wire::Bytes bytes = wire::ldm_volume(2, 30);
    const auto json = describe(decode(bytes).value(), {"made-by-hand", bytes.size()});
    EXPECT_EQ(json.at("file"), "made-by-hand");
    EXPECT_EQ(json.at("size"), bytes.size());
    EXPECT_EQ(json.at("container"), "ldm-bzip2");
    EXPECT_EQ(json.at("n_ldm_records"), 3);
    EXPECT_EQ(json.at("n_negative_control_words"), 1);
    EXPECT_EQ(json.at("volume_header").at("time"), "2022-03-17T01:00:00Z");
    EXPECT_EQ(json.at("vcp_source"), "msg5");
    EXPECT_EQ(json.at("n_sweeps"), 2);
    EXPECT_EQ(json.at("n_radials"), 60);
    EXPECT_EQ(json.at("problems").size(), 0);
    EXPECT_TRUE(json.at("corruption").is_null());
    const auto& sweep = json.at("sweeps").at(1);
    EXPECT_EQ(sweep.at("elevation_number"), 2);
    EXPECT_EQ(sweep.at("max_azimuth_step"), 1.0);
    EXPECT_EQ(sweep.at("nyquist_velocity"), 8.32);
    EXPECT_EQ(sweep.at("moments").at("RHO").at("word_size"), 16);
    EXPECT_EQ(sweep.at("moments").at("REF").at("n_codes"), 3000);
}

SweepMoment kind(std::int32_t first_gate_m, std::vector<std::uint16_t> gate_counts,
                 std::vector<std::uint8_t> codes) {
    SweepMoment moment;
    moment.first_gate_m = first_gate_m;
    moment.gate_spacing_m = 250;
    moment.gate_stride = 4;
    moment.scale = 2;
    moment.offset = 66;
    moment.gate_counts = std::move(gate_counts);
    moment.codes8 = std::move(codes);
    return moment;
}

TEST(MomentStatistics, CountsValuesAndNothingElse) {
    Sweep sweep;
    sweep.radials.resize(2);
    sweep.moments.push_back(kind(0, {4, 3}, {0, 1, 66, 70, 2, 0, 7, 99}));
    const auto statistics = moment_statistics(sweep, Moment::ref);
    ASSERT_TRUE(statistics);
    EXPECT_EQ(statistics->radials, 2);
    EXPECT_EQ(statistics->codes, 7) << "the code beyond the second radial's end does not count";
    EXPECT_EQ(statistics->code_0, 2);
    EXPECT_EQ(statistics->code_1, 1);
    EXPECT_EQ(statistics->code_2_to_7, 2);
    EXPECT_EQ(statistics->valid, 4);
    EXPECT_EQ(statistics->min, -32.0);
    EXPECT_EQ(statistics->max, 2.0);
    EXPECT_EQ(statistics->mean, (0.0 + 2.0 - 32.0 - 29.5) / 4);
    EXPECT_EQ(statistics->gates_min, 3);
    EXPECT_EQ(statistics->gates_max, 4);
    EXPECT_FALSE(moment_statistics(sweep, Moment::vel));
}

TEST(MomentStatistics, KindsOfOneMomentAreTakenInTheOrderOfTheRadials) {
    Sweep one;
    one.radials.resize(3);
    one.moments.push_back(kind(0, {4, 4, 4}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    Sweep two = one;
    two.moments = {kind(0, {4, 0, 4}, {1, 2, 3, 4, 0, 0, 0, 0, 9, 10, 11, 12}),
                   kind(500, {0, 4, 0}, {0, 0, 0, 0, 5, 6, 7, 8, 0, 0, 0, 0})};
    const auto together = moment_statistics(one, Moment::ref);
    const auto apart = moment_statistics(two, Moment::ref);
    EXPECT_EQ(apart->crc32, together->crc32);
    EXPECT_EQ(apart->mean, together->mean);
    EXPECT_TRUE(together->geometry_constant);
    EXPECT_FALSE(apart->geometry_constant);
    EXPECT_TRUE(apart->scale_constant);
}

TEST(MomentStatistics, WithoutAValueThereIsNoMean) {
    Sweep sweep;
    sweep.radials.resize(1);
    sweep.moments.push_back(kind(0, {2}, {0, 1, 0, 0}));
    const auto statistics = moment_statistics(sweep, Moment::ref);
    EXPECT_EQ(statistics->valid, 0);
    EXPECT_FALSE(statistics->min || statistics->max || statistics->mean);
}

}  // namespace
}  // namespace stormcellar::level2
