// Tests hard cases of ODIM_H5; tests/python/test_formats.py reads real volumes.
#include "export/odim.h"

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

class Odim : public NetcdfFile {
  protected:
    Reader write(const Volume& volume, const std::string& group,
                 const VolumeWriteOptions& options = {}) {
        const Status written = write_odim(real_file_system(), path_, volume, options);
        EXPECT_TRUE(written) << written.error().message;
        return Reader(path_, group);
    }
};

TEST_F(Odim, GatesWithoutAValueAreUndetectOrNodata) {
    const auto volume =
        small_volume({small_sweep(1, {small_moment(Moment::ref, {{0, 1, 2, 255}, {66}, {}}),
                                      wide_moment(Moment::veld, {{0, 1, 2, 3}, {65535}, {}}),
                                      small_moment(Moment::cfp, {{0, 1, 7, 8}, {9}, {}})})});
    EXPECT_EQ(write(volume, "dataset1/data1").values("data", 12),
              (Values{0, 1, 2, 255, 66, 1, 1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(Reader(path_, "dataset1/data2").values("data", 12),
              (Values{0, 1, 1, 3, 65535, 1, 1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(Reader(path_, "dataset1/data3").values("data", 12),
              (Values{1, 1, 1, 8, 9, 1, 1, 1, 1, 1, 1, 1}));
    Reader what(path_, "dataset1/data1/what");
    EXPECT_EQ(what.number(nullptr, "gain"), 0.5);
    EXPECT_EQ(what.number(nullptr, "offset"), -33);
    EXPECT_EQ(what.number(nullptr, "undetect"), 0);
    EXPECT_EQ(what.number(nullptr, "nodata"), 1);
}

TEST_F(Odim, RowsAreByAzimuthAndA1gateIsTheFirstRadial) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}, {3}, {4}})})});
    volume.sweeps[0].radials[0].azimuth_deg = 359.75F;
    volume.sweeps[0].radials[1].azimuth_deg = 0.25F;
    volume.sweeps[0].radials[2].azimuth_deg = 359.75F;  // the sweep overlaps itself
    Reader how = write(volume, "dataset1/how");
    EXPECT_EQ(how.numbers(nullptr, "startazA"), (Values{359.75, 359.25, 359.25}));
    EXPECT_EQ(how.numbers(nullptr, "stopazA"), (Values{0.75, 0.25, 0.25}));
    EXPECT_EQ(how.numbers(nullptr, "elangles"), (Values{0.5625, 0.5, 0.625}));
    const Values times = how.numbers(nullptr, "startazT");
    EXPECT_NEAR(times[0] - times[1], 0.1, 1e-6);
    EXPECT_NEAR(times[2] - times[1], 0.2, 1e-6);
    EXPECT_EQ(Reader(path_, "dataset1/data1").values("data", 3), (Values{3, 2, 4}));
    EXPECT_EQ(Reader(path_, "dataset1/where").number(nullptr, "a1gate"), 1);
}

TEST_F(Odim, EachGeometryOfASweepIsADataset) {
    SweepMoment far = small_moment(Moment::ref, {{100, 101}});
    far.first_gate_m = -375;
    far.gate_spacing_m = 1000;
    SweepMoment coarse = small_moment(Moment::vel, {{9}});
    coarse.scale = 1;
    const auto volume =
        small_volume({small_sweep(1, {far, small_moment(Moment::vel, {{2}}), coarse}),
                      small_sweep(2, {small_moment(Moment::sw, {{5}})})});
    Reader first = write(volume, "dataset1/where");
    EXPECT_EQ(first.number(nullptr, "rstart"), -875);
    EXPECT_EQ(first.number(nullptr, "rscale"), 1000);
    EXPECT_EQ(first.number(nullptr, "nbins"), 2);
    EXPECT_EQ(Reader(path_, "dataset2/where").number(nullptr, "rstart"), 2000);
    EXPECT_EQ(Reader(path_, "dataset2/data1/what").number(nullptr, "gain"), 0.5);
    EXPECT_EQ(Reader(path_, "dataset3/data1/what").number(nullptr, "gain"), 1);
    for (const int dataset : {1, 2, 3, 4}) {
        Reader how(path_, "dataset" + std::to_string(dataset) + "/how");
        EXPECT_EQ(how.number(nullptr, "scan_index"), dataset < 4 ? 1 : 2);
    }
    EXPECT_FALSE(Reader(path_).has_group("dataset5"));
}

TEST_F(Odim, NyquistVelocitiesThatDifferAreAllThere) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::vel, {{2}, {3}})})});
    EXPECT_FALSE(write(volume, "dataset1/how").has_attribute(nullptr, "NI")) << "unknown";
    for (level2::Radial& radial : volume.sweeps[0].radials)
        radial.nyquist_mps = 25;
    EXPECT_EQ(write(volume, "dataset1/how").number(nullptr, "NI"), 25);
    EXPECT_FALSE(Reader(path_, "dataset1/how").has_attribute(nullptr, "nyquist_velocities"));
    volume.sweeps[0].radials[1].nyquist_mps = 30;
    EXPECT_EQ(write(volume, "dataset1/how").numbers(nullptr, "nyquist_velocities"),
              (Values{25, 30}));
}

TEST_F(Odim, ARadarOfNobodyKnowsWhereAndASweepWithoutMomentsAreWritten) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{}, {}})})});
    volume.station.clear();
    volume.header.reset();
    Reader where = write(volume, "where", {"x", false, {"lost", "bytes"}});
    EXPECT_TRUE(std::isnan(where.number(nullptr, "lat")));
    EXPECT_STREQ(Reader(path_, "what").text(nullptr, "source").c_str(), "CMT:unknown radar");
    EXPECT_STREQ(Reader(path_, "how").text(nullptr, "comment").c_str(), "lost\nbytes");
    EXPECT_STREQ(Reader(path_, "how").text(nullptr, "volume").c_str(), "partial");
    EXPECT_EQ(Reader(path_, "dataset1/where").number(nullptr, "nrays"), 2);
    EXPECT_FALSE(Reader(path_, "dataset1").has_group("data1"));
}

TEST_F(Odim, RefusesMoreRadialsThanAnAttributeHolds) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}})})});
    volume.sweeps[0].moments.clear();
    volume.sweeps[0].radials.resize(8100);
    EXPECT_EQ(write(volume, "dataset1/how").numbers(nullptr, "elangles").size(), 8100U);
    volume.sweeps[0].radials.resize(8101);
    const Status refused = write_odim(real_file_system(), path_, volume, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace stormcellar::netcdf
