// Tests hard cases of CfRadial 2; tests/python/test_formats.py reads real volumes.
#include "export/cfradial2.h"

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

using Cfradial2 = VolumeFile<write_cfradial2>;

TEST_F(Cfradial2, EachSweepIsAGroupInTheOrderOfTheFile) {
    Volume volume = small_volume(
        {small_sweep(4, {small_moment(Moment::ref, {{0, 1, 2}, {3}})}),
         small_sweep(1, {small_moment(Moment::ref, {{9}}), small_moment(Moment::vel, {{5}})})});
    volume.vcp_message = level2::Vcp{};
    volume.vcp_message->cuts.resize(1);
    volume.vcp_message->cuts[0].waveform = 4;
    write(volume);
    Reader root(path_);
    EXPECT_EQ(root.values("sweep_fixed_angle", 2), (Values{2, 0.5}));
    EXPECT_EQ(root.string("time_coverage_start"), "2022-03-17T00:08:52Z");
    EXPECT_EQ(root.number(nullptr, "scan_id"), 212);
    Reader first(path_, "sweep_0");
    EXPECT_EQ(first.values("DBZH", 6), (Values{-1, -1, 2, 3, -1, -1}));
    EXPECT_EQ(first.values("DBZH_status", 6), (Values{1, 2, 0, 0, 3, 3}));
    EXPECT_EQ(first.text("DBZH", "standard_name"), "radar_equivalent_reflectivity_factor_h");
    EXPECT_EQ(first.text("DBZH", "moment"), "REF");
    EXPECT_EQ(first.values("range", 3), (Values{2125, 2375, 2625}));
    EXPECT_EQ(first.values("elevation_number", 1), Values{4});
    EXPECT_EQ(first.string("prt_mode"), "not_set") << "the pattern has no such cut";
    EXPECT_EQ(first.string("sweep_mode"), "azimuth_surveillance");
    EXPECT_FALSE(first.has_variable("VRADH"));
    Reader second(path_, "sweep_1");
    EXPECT_EQ(second.length("time"), 1U);
    EXPECT_EQ(second.length("range"), 1U);
    EXPECT_EQ(second.values("VRADH", 1), Values{5});
    EXPECT_EQ(second.string("prt_mode"), "dual");
    EXPECT_EQ(second.text("time", "units"), "seconds since 2022-03-17T00:08:52Z")
        << "all sweeps count from the first radial of the volume";
}

TEST_F(Cfradial2, LongGatesOfASweepAreRepeatedOrHaveTheirOwnRange) {
    SweepMoment far = small_moment(Moment::ref, {{100, 1}});
    far.first_gate_m = 2500;
    far.gate_spacing_m = 1000;
    const Volume volume = small_volume(
        {small_sweep(1, {far, small_moment(Moment::vel, {{7}})}), small_sweep(2, {far})});
    write(volume);
    Reader mixed(path_, "sweep_0");
    EXPECT_EQ(mixed.values("DBZH", 8), (Values{100, 100, 100, 100, -1, -1, -1, -1}));
    EXPECT_EQ(mixed.values("DBZH_gate_repeats", 1), Values{4});
    EXPECT_EQ(mixed.values("DBZH_first_gate", 1), Values{2500});
    Reader alone(path_, "sweep_1");
    EXPECT_EQ(alone.values("DBZH", 2), (Values{100, -1})) << "no other sweep matters";
    EXPECT_EQ(alone.values("range", 2), (Values{2500, 3500}));
    write(volume, with_all_ranges());
    Reader own(path_, "sweep_0");
    EXPECT_EQ(own.values("DBZH", 2), (Values{100, -1}));
    EXPECT_EQ(own.values("VRADH", 1), Values{7});
    EXPECT_TRUE(own.has_variable("range_2"));
}

TEST_F(Cfradial2, AVolumeWithoutRadialsHasNoGroups) {
    write(small_volume({}));
    Reader root(path_);
    EXPECT_EQ(root.length("sweep"), 0U);
    EXPECT_FALSE(root.has_group("sweep_0"));
}

}  // namespace
}  // namespace stormcellar::netcdf
