#include "stormcellar/export/volume_format.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/export/netcdf_file.h"
#include "tests/export/small_volume.h"

namespace stormcellar::volume_export {
namespace {

using level2::Moment;
using netcdf::small_moment;
using netcdf::small_sweep;
using netcdf::small_volume;

TEST(VolumeFormat, IsFoundByItsOptionOrTheEndingOfAName) {
    const auto of = [](std::string_view name) {
        const VolumeFormat* format = volume_format_of(name);
        return format == nullptr ? "" : format->option;
    };
    EXPECT_EQ(of("/b.h5/a.nc"), "cfradial") << "the first format with this ending";
    EXPECT_EQ(of("a.h5"), "odim");
    EXPECT_EQ(of("a.hdf"), "odim");
    EXPECT_EQ(of("a.uf"), "uf");
    EXPECT_EQ(of("a.grib"), "");
    EXPECT_EQ(volume_format_named("cfradial2")->name, "CfRadial 2");
    EXPECT_EQ(volume_format_named("CfRadial"), nullptr);
}

TEST(VolumeFormat, EachIsListed) {
    std::set<std::string_view> options;
    for (const VolumeFormat& format : volume_formats()) {
        EXPECT_TRUE(options.insert(format.option).second) << format.option;
        EXPECT_NE(known_volume_formats().find(format.option), std::string::npos);
        for (const std::string_view ending : format.endings) {
            EXPECT_NE(known_volume_formats().find(ending), std::string::npos) << ending;
            EXPECT_EQ(std::ranges::count(volume_endings(), ending), 1) << ending;
        }
    }
}

class EachVolumeFormat : public netcdf::NetcdfFile {};

TEST_F(EachVolumeFormat, GivesTheSameBytesAndKeepsTheOldFileOnFailure) {
    const auto volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2, 3}, {4}})})});
    for (const VolumeFormat& format : volume_formats()) {
        SCOPED_TRACE(format.name);
        const auto write = [&](FileSystem& file_system) {
            return format.write(file_system, path_, volume, {});
        };
        expect_the_same_bytes(write);
        expect_the_old_file_stays(write);
    }
}

TEST_F(EachVolumeFormat, RefusesWhatMakesNoSense) {
    const auto good = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}})})});
    auto no_codes = good;
    no_codes.sweeps[0].moments[0].codes8.clear();
    auto no_radials = good;
    no_radials.sweeps[0].radials.clear();
    for (const VolumeFormat& format : volume_formats()) {
        for (const auto& volume : {no_codes, no_radials}) {
            const Status written = format.write(real_file_system(), path_, volume, {});
            ASSERT_FALSE(written) << format.name;
            EXPECT_EQ(written.error().code, ErrorCode::bad_argument) << format.name;
            EXPECT_NE(written.error().message.find(path_.string()), std::string::npos);
        }
        netcdf::VolumeWriteOptions options;
        options.deflate_level = 10;
        const bool packs = format.option != "uf";
        EXPECT_EQ(format.write(real_file_system(), path_, good, options).has_value(), !packs);
    }
}

// Volumes of metadata alone are valid Level II.
TEST_F(EachVolumeFormat, VolumesWithoutRadialsAreFilesUnlessTheFormatIsAListOfRadials) {
    const auto volume = small_volume({});
    for (const VolumeFormat& format : volume_formats()) {
        const Status written = format.write(real_file_system(), path_, volume, {});
        if (format.option != "uf") {
            EXPECT_TRUE(written) << format.name << ": " << written.error().message;
            continue;
        }
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().code, ErrorCode::unsupported);
    }
}

}  // namespace
}  // namespace stormcellar::volume_export
