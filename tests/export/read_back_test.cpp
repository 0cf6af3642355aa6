// Volumes that are written in other formats and read back have the same gates.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/export/volume_format.h"
#include "stormcellar/level2/decode.h"
#include "tests/export/small_volume.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::volume_export {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::SweepMoment;
using level2::Volume;

level2::Decoded written_and_read(const Volume& volume, std::string_view format,
                                 netcdf::VolumeWriteOptions options = {}) {
    const testing::TemporaryDirectory directory;
    const auto path = directory.path() / "file";
    const VolumeFormat* found = volume_format_named(format);
    EXPECT_NE(found, nullptr) << format;
    if (found == nullptr) return {};
    const Status written = found->write(real_file_system(), path, volume, options);
    EXPECT_TRUE(written) << written.error().message;
    auto read = level2::decode_file(path);
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : level2::Decoded{};
}

// ODIM_H5 has one mark for range folded, flags and gates that are missing.
GateStatus odim_status(GateStatus status) {
    return status == GateStatus::range_folded ? GateStatus::no_data : status;
}

const SweepMoment* same_kind(const level2::Sweep& sweep, const SweepMoment& wanted) {
    const auto found = std::ranges::find_if(sweep.moments, [&](const SweepMoment& one) {
        return one.moment == wanted.moment && one.gate_spacing_m == wanted.gate_spacing_m &&
               (one.first_gate_m - wanted.first_gate_m) % wanted.gate_spacing_m == 0;
    });
    return found == sweep.moments.end() ? nullptr : &*found;
}

// Returns the number of gates that differ in status, or in value by more than float can tell.
std::int64_t differing_gates(const SweepMoment& a, const SweepMoment& b, bool is_odim) {
    std::int64_t differing = 0;
    const std::int32_t shift = (b.first_gate_m - a.first_gate_m) / a.gate_spacing_m;
    // Every seventh radial of a large sweep is enough.
    const std::size_t step = a.gate_counts.size() > 100 ? 7 : 1;
    for (std::size_t radial = 0; radial < a.gate_counts.size(); radial += step) {
        for (std::int32_t gate = 0; gate < a.gate_stride; ++gate) {
            GateStatus was = a.status(radial, gate), is = b.status(radial, gate - shift);
            if (is_odim) was = odim_status(was), is = odim_status(is);
            bool same = was == is;
            if (same && was == GateStatus::valid) {
                const float before = a.value_of(a.code(radial, gate));
                const float after = b.value_of(b.code(radial, gate - shift));
                same = std::abs(before - after) <= 1e-6F * std::max(1.0F, std::abs(before));
            }
            if (!same) ++differing;
        }
    }
    return differing;
}

void expect_same_gates(const Volume& before, const Volume& after, bool is_odim) {
    EXPECT_EQ(after.station, before.station);
    ASSERT_EQ(after.sweeps.size(), before.sweeps.size());
    for (std::size_t i = 0; i < before.sweeps.size(); ++i) {
        const level2::Sweep &was = before.sweeps[i], &is = after.sweeps[i];
        SCOPED_TRACE(i);
        EXPECT_EQ(is.elevation_number, was.elevation_number);
        ASSERT_EQ(is.radials.size(), was.radials.size());
        for (std::size_t k = 0; k < was.radials.size(); ++k) {
            ASSERT_EQ(is.radials[k].time, was.radials[k].time) << k;
            ASSERT_NEAR(is.radials[k].azimuth_deg, was.radials[k].azimuth_deg, 1e-4F) << k;
            ASSERT_EQ(is.radials[k].elevation_deg, was.radials[k].elevation_deg) << k;
            ASSERT_EQ(is.radials[k].nyquist_mps, was.radials[k].nyquist_mps) << k;
        }
        for (const SweepMoment& moment : was.moments) {
            if (std::ranges::count(moment.gate_counts, 0U) ==
                static_cast<std::ptrdiff_t>(moment.gate_counts.size()))
                continue;
            if (is_odim && moment.moment == Moment::cfp) continue;  // flags are not written
            const SweepMoment* found = same_kind(is, moment);
            ASSERT_NE(found, nullptr) << level2::moment_name(moment.moment);
            EXPECT_EQ(differing_gates(moment, *found, is_odim), 0)
                << level2::moment_name(moment.moment);
        }
    }
}

Volume small_volume_of_each_kind() {
    using netcdf::small_moment;
    Volume volume = netcdf::small_volume(
        {netcdf::small_sweep(1,
                             {small_moment(Moment::ref, {{0, 1, 2, 255}, {66, 0}, {}}),
                              netcdf::wide_moment(Moment::phi, {{2, 3, 1000}, {0, 1}, {65, 9}})}),
         netcdf::small_sweep(2, {small_moment(Moment::vel, {{129, 0, 1, 5}, {7}, {2}}),
                                 small_moment(Moment::sw, {{9, 0, 1, 5}, {7}, {2}})})});
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.nyquist_mps = 26.5F;
    return volume;
}

TEST(ReadBack, SmallVolumesKeepTheirGates) {
    const Volume volume = small_volume_of_each_kind();
    for (const char* format : {"cfradial", "cfradial2", "odim"}) {
        SCOPED_TRACE(format);
        const auto read = written_and_read(volume, format);
        expect_same_gates(volume, read.volume, format == std::string_view{"odim"});
        EXPECT_TRUE(read.report.complete);
    }
}

TEST(ReadBack, PartialVolumesStayPartial) {
    netcdf::VolumeWriteOptions options;
    options.complete = false;
    for (const char* format : {"cfradial", "cfradial2", "odim"})
        EXPECT_FALSE(written_and_read(small_volume_of_each_kind(), format, options).report.complete)
            << format;
}

TEST(ReadBack, RealVolumesKeepTheirGates) {
    STORMCELLAR_NEED_DATA();
    // Super-resolution with 16-bit codes, legacy gates of two lengths, and TDWR.
    for (const char* name :
         {"KLOT20220317_000842_V06", "KTLX19990503_235621.gz", "Level2_TSTL_20220213_2357.ar2v"}) {
        const auto decoded = level2::decode_file(testing::real_file("volumes") / name);
        ASSERT_TRUE(decoded) << decoded.error().message;
        for (const char* format : {"cfradial", "cfradial2", "odim"}) {
            SCOPED_TRACE(std::string{name} + " as " + format);
            const auto read = written_and_read(decoded->volume, format);
            expect_same_gates(decoded->volume, read.volume, format == std::string_view{"odim"});
        }
        netcdf::VolumeWriteOptions options;
        options.ranges = netcdf::RangeAxes::of_each_geometry;
        expect_same_gates(decoded->volume,
                          written_and_read(decoded->volume, "cfradial", options).volume, false);
    }
}

}  // namespace
}  // namespace stormcellar::volume_export
