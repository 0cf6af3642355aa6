// Tests what a reader finds in a file; tests/export/check_cfradial.py reads real volumes in Python.
#include "stormcellar/export/cfradial.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/export/netcdf_file.h"
#include "tests/export/netcdf_reader.h"
#include "tests/export/small_volume.h"

namespace stormcellar::netcdf {
namespace {

using level2::Moment;
using level2::SweepMoment;
using level2::Volume;
using Values = std::vector<double>;

constexpr double valid = 0, below = 1, folded = 2, none = 3, ambiguous = 4;

// Returns a word without the zeros that fill it up to `string_length` letters.
std::string word(const std::string& letters) {
    return letters.c_str();
}

class Cfradial : public VolumeFile<write_volume> {
  protected:
    static Volume one_moment(SweepMoment moment) {
        return small_volume({small_sweep(1, {std::move(moment)})});
    }
};

TEST_F(Cfradial, EveryGateKeepsItsCodeAndWhyItHasNoValue) {
    write(small_volume({small_sweep(1, {small_moment(Moment::ref, {{0, 1, 2, 255}, {66, 0}, {}})}),
                        small_sweep(2, {small_moment(Moment::vel, {{1, 129}})})}));
    Reader reader(path_);
    EXPECT_EQ(reader.values("REF", 16), (Values{-1, -1, 2, 255, 66, -1, -1, -1,  //
                                                -1, -1, -1, -1, -1, -1, -1, -1}));
    EXPECT_EQ(reader.values("REF_status", 16),
              (Values{below, folded, valid, valid, valid, below, none, none,  //
                      none, none, none, none, none, none, none, none}));
    EXPECT_EQ(reader.values("VEL", 16), (Values{-1, -1, -1, -1, -1, -1, -1, -1,  //
                                                -1, -1, -1, -1, -1, 129, -1, -1}));
    EXPECT_EQ(reader.values("VEL_status", 16)[12], folded);
    EXPECT_EQ(reader.number("REF", "_FillValue"), -1);
    EXPECT_EQ(reader.number("REF", "scale_factor"), 0.5);
    EXPECT_EQ(reader.number("REF", "add_offset"), -33);
    EXPECT_EQ(reader.text("REF", "ancillary_variables"), "REF_status");
    EXPECT_EQ(reader.text("REF_status", "flag_meanings"),
              "valid below_threshold range_folded no_data");
    EXPECT_FALSE(reader.has_attribute("REF_status", "_FillValue")) << "_FillValue hides a state";
    EXPECT_EQ(reader.values("range", 4), (Values{2125, 2375, 2625, 2875}));
}

// Checks the accuracy that stormcellar/export/cfradial.h states, with the scales of real volumes.
// VELD comes beside VEL and must not change the codes and states of VEL.
TEST_F(Cfradial, DealiasedVelocityStandsBesideTheRawVelocity) {
    const SweepMoment raw = small_moment(Moment::vel, {{0, 1, 2, 129, 254}});
    write(one_moment(raw));
    const Values codes = Reader(path_).values("VEL", 5);
    const Values states = Reader(path_).values("VEL_status", 5);
    EXPECT_EQ(codes, (Values{-1, -1, 2, 129, 254}));
    EXPECT_EQ(states, (Values{below, folded, valid, valid, valid}));
    SweepMoment made = wide_moment(Moment::veld, {{0, 1, 2, 32768, 3}});
    made.scale = 100;
    made.offset = 32768;
    write(small_volume({small_sweep(1, {raw, made})}));
    Reader reader(path_);
    EXPECT_EQ(reader.values("VEL", 5), codes);
    EXPECT_EQ(reader.values("VEL_status", 5), states);
    EXPECT_EQ(reader.text("VEL_status", "flag_meanings"),
              "valid below_threshold range_folded no_data");
    EXPECT_EQ(reader.text(nullptr, "field_names"),
              "VEL,VEL_status,VEL_dealiased,VEL_dealiased_status");
    EXPECT_EQ(reader.values("VEL_dealiased_status", 5),
              (Values{below, folded, ambiguous, valid, valid}));
    EXPECT_EQ(reader.text("VEL_dealiased_status", "flag_meanings"),
              "valid below_threshold range_folded no_data ambiguous");
    EXPECT_EQ(reader.numbers("VEL_dealiased_status", "flag_values"), (Values{0, 1, 2, 3, 4}));
    EXPECT_EQ(reader.text("VEL_dealiased", "ancillary_variables"), "VEL_dealiased_status");
    EXPECT_EQ(reader.text("VEL_dealiased", "standard_name"),
              "corrected_radial_velocity_of_scatterers_away_from_instrument");
    const double fill = reader.number("VEL_dealiased", "_FillValue");
    const double scale = reader.number("VEL_dealiased", "scale_factor");
    const double offset = reader.number("VEL_dealiased", "add_offset");
    const Values packed = reader.values("VEL_dealiased", 5);
    for (const std::size_t gate : {0U, 1U, 2U})
        EXPECT_EQ(packed[gate], fill) << gate;
    EXPECT_NEAR(packed[3] * scale + offset, 0, 1e-5);
    EXPECT_NEAR(packed[4] * scale + offset, -327.65, 1e-4);
}

TEST_F(Cfradial, UnpackedValuesAreAsExactAsStated) {
    struct Packing {
        float scale, offset;
        int codes;
    };
    const std::vector<Packing> packings = {{2, 66, 256},      {2, 129, 256},       {1, 129, 256},
                                           {300, -60.5, 256}, {16, 128, 256},      {1, 8, 256},
                                           {32, 418, 65536},  {2.8361F, 2, 65536}, {0, 0, 256}};
    for (const Packing& packing : packings) {
        SweepMoment moment = packing.codes > 256 ? wide_moment(Moment::phi, {{2}})
                                                 : small_moment(Moment::phi, {{2}});
        moment.scale = packing.scale;
        moment.offset = packing.offset;
        write(one_moment(moment));
        Reader reader(path_);
        const double factor = reader.number("PHI", "scale_factor");
        const double offset = reader.number("PHI", "add_offset");
        EXPECT_EQ(reader.number("PHI", "level2_scale"), static_cast<double>(packing.scale));
        EXPECT_EQ(reader.number("PHI", "level2_offset"), static_cast<double>(packing.offset));
        for (int code = 2; code < packing.codes; ++code) {
            const double exact = packing.scale == 0 ? code
                                                    : (code - static_cast<double>(packing.offset)) /
                                                          static_cast<double>(packing.scale);
            ASSERT_NEAR(code * factor + offset, exact, packing.codes > 256 ? 1e-11 : 1e-12)
                << packing.scale << " " << code;
        }
    }
}

TEST_F(Cfradial, SixteenBitCodesReachTheirEnd) {
    write(one_moment(wide_moment(Moment::zdr, {{0, 1, 2, 32768, 65535}})));
    Reader reader(path_);
    EXPECT_EQ(reader.values("ZDR", 5), (Values{-1, -1, 2, 32768, 65535}));
    EXPECT_EQ(reader.values("ZDR_status", 5), (Values{below, folded, valid, valid, valid}));
}

TEST_F(Cfradial, FlagsOfTheClutterFilterAreNoValuesAndNotLost) {
    write(one_moment(small_moment(Moment::cfp, {{0, 1, 2, 7, 8, 80}, {9}})));
    Reader reader(path_);
    EXPECT_EQ(reader.values("CFP", 12), (Values{-1, -1, -1, -1, 8, 80, 9, -1, -1, -1, -1, -1}));
    EXPECT_EQ(reader.values("CFP_status", 12),
              (Values{16, 17, 18, 23, valid, valid, valid, none, none, none, none, none}));
    EXPECT_EQ(reader.text("CFP_status", "flag_meanings").substr(0, 27),
              "valid no_data filter_flag_0");
}

TEST_F(Cfradial, GatesStayOnTheirOwnRange) {
    SweepMoment far = small_moment(Moment::ref, {{100, 101}});
    far.first_gate_m = -375;
    far.gate_spacing_m = 1000;
    VolumeWriteOptions options;
    options.ranges = RangeAxes::of_each_geometry;
    write(small_volume(
              {small_sweep(1, {small_moment(Moment::ref, {{2}, {3}})}), small_sweep(2, {far})}),
          options);
    Reader reader(path_);
    EXPECT_EQ(reader.values("range", 1), Values{2125});
    EXPECT_EQ(reader.values("range_2", 2), (Values{-375, 625}));
    EXPECT_EQ(reader.values("REF", 3), (Values{2, 3, -1}));
    EXPECT_EQ(reader.values("REF_2", 6), (Values{-1, -1, -1, -1, 100, 101}));
    EXPECT_EQ(reader.text("REF_2", "coordinates"), "elevation azimuth range_2");
    EXPECT_EQ(reader.text("REF_2", "moment"), "REF");
    EXPECT_EQ(reader.number("range_2", "meters_to_center_of_first_gate"), -375);
    EXPECT_EQ(reader.number("range_2", "meters_between_gates"), 1000);
    EXPECT_EQ(reader.text(nullptr, "field_names"), "REF,REF_status,REF_2,REF_2_status");
}

TEST_F(Cfradial, OnOneRangeLongGatesAreRepeatedAndSoMarked) {
    SweepMoment far = small_moment(Moment::ref, {{100, 1}});
    far.first_gate_m = 2500;
    far.gate_spacing_m = 1000;
    write(small_volume(
        {small_sweep(1, {small_moment(Moment::ref, {{2, 3}, {4}})}), small_sweep(2, {far})}));
    Reader reader(path_);
    EXPECT_FALSE(reader.has_variable("range_2"));
    EXPECT_EQ(reader.values("range", 8), (Values{2125, 2375, 2625, 2875, 3125, 3375, 3625, 3875}));
    EXPECT_EQ(reader.values("REF", 24), (Values{2,   3,   -1,  -1,  -1, -1, -1, -1,  //
                                                4,   -1,  -1,  -1,  -1, -1, -1, -1,  //
                                                100, 100, 100, 100, -1, -1, -1, -1}));
    EXPECT_EQ(reader.values("REF_status", 24)[20], folded);
    EXPECT_EQ(reader.values("REF_status", 24)[23], folded);
    EXPECT_EQ(reader.values("REF_status", 24)[2], none);
    EXPECT_EQ(reader.values("REF_gate_repeats", 2), (Values{1, 4}));
    EXPECT_EQ(reader.values("REF_gate_start", 2), (Values{0, 0}));
    EXPECT_EQ(reader.values("REF_first_gate", 2), (Values{2125, 2500}));
}

TEST_F(Cfradial, GatesOfOneLengthAreNotMarked) {
    write(one_moment(small_moment(Moment::ref, {{2, 3}})));
    EXPECT_FALSE(Reader(path_).has_variable("REF_gate_repeats"));
}

TEST_F(Cfradial, SweepsAndRadialsAreWhereTheirIndicesSay) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}, {3}, {4}})}),
                                  small_sweep(4, {small_moment(Moment::ref, {{5}, {6}})})});
    volume.sweeps[1].radials[1].nyquist_mps = 27.5F;
    volume.sweeps[0].radials[0].horizontal_noise_dbm = -80.5F;
    volume.sweeps[1].radials[1].status = 0x84;
    write(volume);
    Reader reader(path_);
    EXPECT_EQ(reader.values("sweep_number", 2), (Values{0, 1}));
    EXPECT_EQ(reader.values("sweep_start_ray_index", 2), (Values{0, 3}));
    EXPECT_EQ(reader.values("sweep_end_ray_index", 2), (Values{2, 4}));
    EXPECT_EQ(reader.values("elevation_number", 2), (Values{1, 4}));
    EXPECT_EQ(reader.values("fixed_angle", 2), (Values{0.5, 2}));
    EXPECT_EQ(word(reader.letters("sweep_mode", 64).substr(32)), "azimuth_surveillance");
    EXPECT_EQ(reader.values("azimuth", 5), (Values{0.5, 1.5, 2.5, 0.5, 1.5}));
    EXPECT_EQ(reader.values("elevation", 5), (Values{0.5, 0.5625, 0.625, 2, 2.0625}));
    EXPECT_EQ(reader.values("radial_status", 5)[4], 0x84);
    EXPECT_EQ(reader.values("azimuth_number", 5), (Values{1, 2, 3, 1, 2}));
    const double fill = static_cast<double>(NC_FILL_FLOAT);
    EXPECT_EQ(reader.values("nyquist_velocity", 5), (Values{fill, fill, fill, fill, 27.5}));
    EXPECT_EQ(reader.values("radar_measured_sky_noise", 5)[0], -80.5);
    EXPECT_FALSE(reader.has_variable("unambiguous_range")) << "no radial has an unambiguous range";
    EXPECT_EQ(reader.values("volume_number", 1), Values{116});
    EXPECT_EQ(reader.number(nullptr, "scan_id"), 212);
}

TEST_F(Cfradial, TimeCountsFromTheWholeSecondBeforeTheFirstRadial) {
    write(small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}, {3}})}),
                        small_sweep(2, {small_moment(Moment::ref, {{2}})})}));
    Reader reader(path_);
    EXPECT_EQ(reader.text("time", "units"), "seconds since 2022-03-17T00:08:52Z");
    EXPECT_EQ(word(reader.letters("time_coverage_start", 32)), "2022-03-17T00:08:52Z");
    EXPECT_EQ(word(reader.letters("time_coverage_end", 32)), "2022-03-17T00:09:03Z");
    const Values time = reader.values("time", 3);
    EXPECT_NEAR(time[0], 0.596, 1e-9);
    EXPECT_NEAR(time[1], 0.696, 1e-9);
    EXPECT_NEAR(time[2], 10.596, 1e-9);
    EXPECT_EQ(reader.text(nullptr, "ray_times_increase"), "true");
}

TEST_F(Cfradial, AnImpossibleTimeMovesNothingElse) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}, {3}, {4}})})});
    volume.sweeps[0].radials[1].time = UtcTime{} - std::chrono::hours(1);
    write(volume);
    Reader reader(path_);
    EXPECT_EQ(reader.text("time", "units"), "seconds since 2022-03-17T00:08:52Z");
    EXPECT_EQ(reader.text(nullptr, "ray_times_increase"), "false");
    EXPECT_LT(reader.values("time", 3)[1], -1e9) << "decoded times do not change";
}

TEST_F(Cfradial, AVolumeWithoutRadialsIsAFileWithoutRadials) {
    write(small_volume({}), {"KTLX_FILE", false, {"metadata without radials"}});
    Reader reader(path_);
    EXPECT_EQ(reader.length("time"), 0U);
    EXPECT_EQ(reader.length("sweep"), 0U);
    EXPECT_EQ(reader.length("range"), 0U);
    EXPECT_EQ(reader.text("time", "units"), "seconds since 2022-03-17T00:08:42Z")
        << "the header gives this time";
    EXPECT_EQ(reader.text(nullptr, "volume"), "partial");
    EXPECT_EQ(reader.text(nullptr, "notes"), "metadata without radials");
    EXPECT_NEAR(reader.values("latitude", 1)[0], 35.333, 0.01)
        << "the station table gives the latitude";
}

TEST_F(Cfradial, AVolumeOfNobodyKnowsWhereIsWritten) {
    Volume volume = one_moment(small_moment(Moment::ref, {{2}}));
    volume.station.clear();
    volume.header.reset();
    volume.vcp.reset();
    write(volume);
    Reader reader(path_);
    for (const char* name : {"latitude", "longitude", "altitude"}) {
        EXPECT_EQ(reader.number(name, "_FillValue"), NC_FILL_DOUBLE) << name;
        EXPECT_EQ(reader.values(name, 1), Values{NC_FILL_DOUBLE}) << name;
    }
    EXPECT_EQ(reader.number("volume_number", "_FillValue"), -1);
    EXPECT_EQ(reader.values("volume_number", 1), Values{-1});
    EXPECT_EQ(reader.text(nullptr, "instrument_name"), "unknown");
    EXPECT_FALSE(reader.has_attribute(nullptr, "scan_id"));
}

TEST_F(Cfradial, WithoutAVcpTheFixedAngleIsTheMedianElevation) {
    Volume volume = one_moment(small_moment(Moment::ref, {{2}, {3}, {4}}));
    volume.sweeps[0].vcp_elevation_deg.reset();
    volume.sweeps[0].radials[0].elevation_deg = 65;
    write(volume);
    EXPECT_EQ(Reader(path_).values("fixed_angle", 1), Values{0.625});
}

TEST_F(Cfradial, SaysWhereItComesFromInPlainCharacters) {
    VolumeWriteOptions options;
    options.source_file = "KTLX\n\xff";
    options.notes = {"first", "sec\x1bond"};
    write(one_moment(small_moment(Moment::ref, {{2}})), options);
    Reader reader(path_);
    EXPECT_EQ(reader.text(nullptr, "Conventions"), "CF-1.7 CF/Radial instrument_parameters");
    EXPECT_EQ(reader.text(nullptr, "version"), "1.4");
    EXPECT_EQ(reader.text(nullptr, "source_file"), "KTLX\\x0a\\xff");
    EXPECT_EQ(reader.text(nullptr, "notes"), "first\nsec\\x1bond");
    EXPECT_EQ(reader.text(nullptr, "instrument_name"), "KTLX");
    EXPECT_EQ(reader.text(nullptr, "volume"), "complete");
}

TEST_F(Cfradial, TheSameVolumeGivesTheSameBytes) {
    expect_the_same_bytes([&](FileSystem& file_system) {
        return write_volume(file_system, path_,
                            one_moment(small_moment(Moment::ref, {{2, 3}, {4}})));
    });
}

TEST_F(Cfradial, AFailedWriteLeavesTheOldFileAlone) {
    expect_the_old_file_stays([&](FileSystem& file_system) {
        return write_volume(file_system, path_, one_moment(small_moment(Moment::ref, {{2}})));
    });
}

TEST_F(Cfradial, RefusesWhatMakesNoSense) {
    Volume volume = one_moment(small_moment(Moment::ref, {{2}}));
    VolumeWriteOptions options;
    options.deflate_level = 10;
    const auto level = write_volume(real_file_system(), path_, volume, options);
    ASSERT_FALSE(level);
    EXPECT_EQ(level.error().code, ErrorCode::bad_argument);
    volume.sweeps[0].moments[0].codes8.clear();
    const auto arrays = write_volume(real_file_system(), path_, volume);
    ASSERT_FALSE(arrays);
    EXPECT_EQ(arrays.error().code, ErrorCode::bad_argument);
    EXPECT_NE(arrays.error().message.find(path_.string()), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace stormcellar::netcdf
