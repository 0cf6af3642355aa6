// Damaged files of other formats give a whole volume or an error, and never take much memory.
#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/level2/foreign/cfradial_files.h"
#include "tests/level2/foreign/odim_files.h"

namespace stormcellar::level2 {
namespace {

using ::testing::HasSubstr;
using testing::Hdf5Writer;
using testing::NetcdfWriter;

std::vector<std::byte> odim_file() {
    Hdf5Writer file;
    testing::begin_odim(file);
    const std::string dataset = testing::begin_dataset(file);
    file.group(dataset + "/how").numbers("startazA", {0, 90, 180, 270});
    testing::add_quantity(file, dataset, 1, "DBZH", 4, std::vector<std::uint8_t>(64, 90), 255, 0,
                          2);
    testing::add_quantity(file, dataset, 2, "VRADH", 4, std::vector<float>(64, 90));
    return file.bytes();
}

std::vector<std::byte> cfradial_file(int mode) {
    NetcdfWriter file{mode};
    testing::begin_cfradial(file, 0);
    file.array("DBZ", {"time", "range"}, std::vector<short>(12, 100));
    file.array("VEL", {"time", "range"}, std::vector<float>(12, 10));
    return file.bytes();
}

void expect_whole(const Volume& volume) {
    for (const Sweep& sweep : volume.sweeps) {
        ASSERT_FALSE(sweep.radials.empty());
        for (const Radial& radial : sweep.radials) {
            ASSERT_TRUE(radial.azimuth_deg >= 0 && radial.azimuth_deg <= 360);
            ASSERT_TRUE(std::abs(radial.elevation_deg) <= 90);
            ASSERT_TRUE(std::isfinite(radial.nyquist_mps));
        }
        for (const SweepMoment& moment : sweep.moments) {
            ASSERT_EQ(moment.gate_counts.size(), sweep.radials.size());
            ASSERT_GT(moment.gate_stride, 0);
            ASSERT_EQ(*std::ranges::max_element(moment.gate_counts), moment.gate_stride);
            ASSERT_TRUE(std::isfinite(moment.scale) && std::isfinite(moment.offset));
            ASSERT_EQ(moment.codes8.size() + moment.codes16.size(),
                      sweep.radials.size() * static_cast<std::size_t>(moment.gate_stride));
        }
    }
}

struct Outcomes {
    int whole = 0, failed = 0;
};

// Decodes the file, and expects a good volume or an error with a message.
void decode_damaged(std::vector<std::byte> bytes, Outcomes& outcomes) {
    DecodeOptions options;
    options.output_limit_bytes = std::uint64_t{32} << 20;
    const auto made = decode(bytes, options);
    ++(made ? outcomes.whole : outcomes.failed);
    if (made) {
        expect_whole(made->volume);
    } else {
        EXPECT_FALSE(made.error().message.empty());
        EXPECT_NE(made.error().code, ErrorCode::internal);
    }
}

void decode_with_damage(const std::vector<std::byte>& whole) {
    std::mt19937 random{50};
    Outcomes outcomes;
    for (int run = 0; run < 4000; ++run) {
        std::vector<std::byte> bytes = whole;
        for (unsigned i = 0; i < 1 + random() % 4; ++i) {
            // Keep the signature, so that the file is recognized.
            std::byte& byte = bytes[8 + random() % (bytes.size() - 8)];
            byte = random() % 3 == 0 ? std::byte{0xFF} : byte ^ std::byte(1U << random() % 8);
        }
        decode_damaged(std::move(bytes), outcomes);
    }
    EXPECT_GT(outcomes.whole, 100);
    EXPECT_GT(outcomes.failed, 100);
    Outcomes cut;
    for (std::size_t size = 8; size < whole.size(); size += 1 + whole.size() / 500)
        decode_damaged({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, cut);
    EXPECT_GT(cut.failed, 100);
}

TEST(ForeignDamage, OdimGivesAVolumeOrAnError) {
    decode_with_damage(odim_file());
}

TEST(ForeignDamage, CfradialGivesAVolumeOrAnError) {
    decode_with_damage(cfradial_file(NC_NETCDF4));
}

TEST(ForeignDamage, ClassicNetcdfGivesAVolumeOrAnError) {
    decode_with_damage(cfradial_file(0));
}

TEST(ForeignDamage, HugeArraysTakeNoMemory) {
    NetcdfWriter file{NC_64BIT_DATA};
    testing::begin_cfradial(file);
    std::vector<std::byte> bytes = file.bytes();
    // Makes the range 2^40 gates long. The length of a dimension follows the name of the dimension.
    const std::string name = "range";
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end(),
                                [](std::byte a, char b) { return a == std::byte(b); });
    ASSERT_NE(at, bytes.end());
    *(at + 8 + 2) = std::byte{1};
    const auto made = decode(bytes);
    ASSERT_FALSE(made);

    DecodeOptions small;
    small.output_limit_bytes = 10;
    const auto limited = decode(odim_file(), small);
    ASSERT_FALSE(limited);
    EXPECT_EQ(limited.error().code, ErrorCode::unsupported);
    EXPECT_THAT(limited.error().message, HasSubstr("more than 10 bytes"));
}

TEST(ForeignDamage, GroupsThatHoldThemselvesEnd) {
    Hdf5Writer file;
    testing::begin_odim(file);
    file.group("dataset1").link_to_root("dataset1");
    const auto made = decode(file.bytes());
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message, HasSubstr("more than 8 levels"));
}

TEST(ForeignDamage, CutFilesAreNamedSo) {
    std::vector<std::byte> bytes = odim_file();
    bytes.resize(bytes.size() / 2);
    const auto made = decode(bytes);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::truncated);
}

}  // namespace
}  // namespace stormcellar::level2
