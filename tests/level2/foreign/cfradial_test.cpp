#include "level2/foreign/cfradial.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/level2/foreign/cfradial_files.h"

namespace stormcellar::level2 {
namespace {

using testing::begin_cfradial;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::NetcdfWriter;

Decoded decoded(NetcdfWriter& file) {
    auto made = decode(file.bytes());
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : Decoded{};
}

Error error_of(NetcdfWriter& file) {
    const auto made = decode(file.bytes());
    EXPECT_FALSE(made);
    return made ? Error{} : made.error();
}

// Adds a reflectivity in hundredths of a dBZ, and a velocity as floats.
void add_fields(NetcdfWriter& file) {
    file.array("DBZ", {"time", "range"},
               std::vector<short>{-3000, 0, -32768, 1, 2, 3, 4, 5, 6, 7, 8, 6500}, -32768);
    file.number("DBZ", "scale_factor", NC_FLOAT, 0.01);
    file.number("DBZ", "add_offset", NC_FLOAT, 0);
    const float no = -9999;
    file.array("radial_wind", {"time", "range"},
               std::vector<float>{no, no, no, no, no, no, -10.5F, no, 3.333F, 0, 0, 0}, no);
    file.text("radial_wind", "standard_name", "radial_velocity_of_scatterers_away_from_instrument");
    file.array("SNR", {"time", "range"}, std::vector<float>(12, 1));
}

void expect_fields(const Decoded& file) {
    const Volume& volume = file.volume;
    EXPECT_EQ(volume.station, "CHIV");
    EXPECT_EQ(antenna_position(volume)->altitude_m, 478);
    ASSERT_EQ(volume.sweeps.size(), 2U);
    EXPECT_EQ(format_utc(volume.sweeps[1].radials[1].time), "2018-11-10T12:00:00.750Z");
    EXPECT_FLOAT_EQ(volume.sweeps[1].radials[1].azimuth_deg, 120);
    EXPECT_FLOAT_EQ(volume.sweeps[1].radials[1].nyquist_mps, 12);
    EXPECT_FLOAT_EQ(*volume.sweeps[1].vcp_elevation_deg, 2);
    const SweepMoment& ref = *volume.sweeps[0].find(Moment::ref);
    EXPECT_EQ(ref.first_gate_m, 75);
    EXPECT_EQ(ref.gate_spacing_m, 150);
    EXPECT_FLOAT_EQ(ref.value_of(ref.code(0, 0)), -30);
    EXPECT_FLOAT_EQ(ref.value_of(ref.code(0, 1)), 0);
    EXPECT_EQ(ref.status(0, 2), GateStatus::below_threshold);
    const SweepMoment& last = *volume.sweeps[1].find(Moment::ref);
    EXPECT_FLOAT_EQ(last.value_of(last.code(1, 2)), 65);
    // The first sweep has no velocity at all.
    EXPECT_EQ(volume.sweeps[0].find(Moment::vel), nullptr);
    const SweepMoment& vel = *volume.sweeps[1].find(Moment::vel);
    EXPECT_FLOAT_EQ(vel.value_of(vel.code(0, 0)), -10.5F);
    EXPECT_EQ(vel.status(0, 1), GateStatus::below_threshold);
    EXPECT_NEAR(vel.value_of(vel.code(0, 2)), 3.333F, 0.0051F);
    ASSERT_EQ(file.report.problems.size(), 2U);
    EXPECT_THAT(file.report.problems[0].message, HasSubstr("CHIVO"));
    EXPECT_THAT(file.report.problems[1].message, HasSubstr("SNR"));
}

TEST(CfRadial, ReadsEachFormOfNetcdf) {
    for (const int mode :
         {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4, NC_NETCDF4 | NC_CLASSIC_MODEL}) {
        for (const std::size_t time_size : {4U, 0U}) {  // 0: records
            NetcdfWriter file{mode};
            begin_cfradial(file, time_size);
            add_fields(file);
            expect_fields(decoded(file));
        }
    }
}

TEST(CfRadial, ReadsAGroupForEachSweep) {
    NetcdfWriter file{NC_NETCDF4};
    file.text("", "Conventions", "Cf/Radial");
    file.text("", "version", "2.0");
    file.text("", "instrument_name", "KTLX");
    file.array("latitude", {}, std::vector<double>{35.33});
    file.array("longitude", {}, std::vector<double>{-97.28});
    file.array("altitude", {}, std::vector<double>{390});
    for (int i = 0; i < 11; ++i) {
        file.group(("sweep_" + std::to_string(i)).c_str());
        file.dimension("time", 4);
        file.dimension("range", 3);
        testing::write_coordinates(file, 4, i);
        file.array("sweep_fixed_angle", {}, std::vector<float>{static_cast<float>(i)});
        file.array("DBZH", {"time", "range"}, std::vector<short>(12, static_cast<short>(i)));
    }
    const Volume volume = decoded(file).volume;
    ASSERT_EQ(volume.sweeps.size(), 11U);
    EXPECT_EQ(volume.station, "KTLX");
    for (std::size_t i = 0; i < 11; ++i) {
        EXPECT_FLOAT_EQ(*volume.sweeps[i].vcp_elevation_deg, static_cast<float>(i));
        const SweepMoment& ref = *volume.sweeps[i].find(Moment::ref);
        EXPECT_FLOAT_EQ(ref.value_of(ref.code(3, 2)), static_cast<float>(i));
    }
}

TEST(CfRadial, ReadsRaysOfDifferentLengths) {
    NetcdfWriter file{NC_NETCDF4};
    begin_cfradial(file);
    file.dimension("n_points", 7);
    file.array("ray_n_gates", {"time"}, std::vector<int>{3, 1, 2, 1});
    file.array("ray_start_index", {"time"}, std::vector<int>{0, 3, 4, 6});
    file.array("DBZ", {"n_points"}, std::vector<short>{10, 11, 12, 20, 30, 31, 40});
    const Volume volume = decoded(file).volume;
    const SweepMoment& first = *volume.sweeps.at(0).find(Moment::ref);
    EXPECT_THAT(first.gate_counts, ElementsAre(3, 1));
    EXPECT_FLOAT_EQ(first.value_of(first.code(1, 0)), 20);
    EXPECT_EQ(first.status(1, 1), GateStatus::no_data);
    const SweepMoment& second = *volume.sweeps.at(1).find(Moment::ref);
    EXPECT_FLOAT_EQ(second.value_of(second.code(0, 1)), 31);
}

// xradar writes milliseconds.
TEST(CfRadial, ReadsTimesInEachUnit) {
    for (const char* units :
         {"milliseconds since 2018-11-10T12:00:00+00:00", "s since 2018-11-10 12:00:00.000 UTC"}) {
        NetcdfWriter file{NC_NETCDF4};
        begin_cfradial(file);
        add_fields(file);
        file.text("time", "units", units);
        const UtcTime time = decoded(file).volume.sweeps.at(1).radials.at(1).time;
        const bool is_thousandth = std::string_view{units}.starts_with("milli");
        EXPECT_EQ(format_utc(time),
                  is_thousandth ? "2018-11-10T12:00:00.001Z" : "2018-11-10T12:00:00.750Z");
    }
}

TEST(CfRadial, LeavesRaysWithoutADirectionOut) {
    NetcdfWriter file{NC_NETCDF4};
    begin_cfradial(file);
    add_fields(file);
    std::vector<std::byte> bytes = file.bytes();
    // Makes the azimuth of the second ray, 40 degrees, no number.
    const std::byte degrees_40[] = {std::byte{0}, std::byte{0}, std::byte{0x20}, std::byte{0x42}};
    const auto at =
        std::search(bytes.begin(), bytes.end(), std::begin(degrees_40), std::end(degrees_40));
    ASSERT_NE(at, bytes.end());
    std::fill_n(at, 4, std::byte{0xFF});
    const auto made = decode(bytes);
    ASSERT_TRUE(made) << made.error().message;
    ASSERT_EQ(made->volume.sweeps[0].radials.size(), 1U);
    EXPECT_EQ(made->volume.sweeps[0].find(Moment::ref)->gate_counts.size(), 1U);
    EXPECT_EQ(made->report.problems.back().code, "lost_radials");
    EXPECT_TRUE(made->report.damaged);
}

TEST(CfRadial, LeavesVerticalSectionsOut) {
    NetcdfWriter file{NC_NETCDF4};
    begin_cfradial(file);
    std::string modes = "azimuth_surveillance";
    modes.resize(22);
    modes += "rhi";
    modes.resize(44);
    file.array("sweep_mode", {"sweep", "string_length"},
               std::vector<char>(modes.begin(), modes.end()));
    add_fields(file);
    const Decoded made = decoded(file);
    ASSERT_EQ(made.volume.sweeps.size(), 1U);
    EXPECT_THAT(made.report.problems.back().message, HasSubstr("sweep 1 (rhi)"));
}

TEST(CfRadial, SaysWhyAFileIsNotRead) {
    NetcdfWriter moving{NC_NETCDF4};
    moving.text("", "Conventions", "CF/Radial");
    moving.dimension("time", 2);
    moving.array("latitude", {"time"}, std::vector<double>{1, 2});
    EXPECT_THAT(error_of(moving).message, HasSubstr("moving radar"));

    NetcdfWriter empty{NC_NETCDF4};
    begin_cfradial(empty);
    EXPECT_EQ(error_of(empty).code, ErrorCode::unsupported);

    NetcdfWriter other{0};
    other.text("", "Conventions", "CF-1.8");
    other.dimension("x", 2);
    other.array("height", {"x"}, std::vector<double>{1, 2});
    EXPECT_EQ(error_of(other).code, ErrorCode::not_level2);

    NetcdfWriter bad{NC_NETCDF4};
    begin_cfradial(bad);
    bad.text("time", "units", "weeks since 1970-01-01");
    add_fields(bad);
    EXPECT_THAT(error_of(bad).message, HasSubstr("weeks since"));
}

}  // namespace
}  // namespace stormcellar::level2
