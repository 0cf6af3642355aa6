// Tests hard cases of UF; tests/python/test_formats.py reads real volumes.
#include "export/uf.h"

#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/export/netcdf_file.h"
#include "tests/export/small_volume.h"

namespace stormcellar::netcdf {
namespace {

using level2::Moment;
using level2::SweepMoment;
using level2::Volume;
using Words = std::vector<int>;

constexpr int missing = -32768;

class Uf : public VolumeFile<write_uf> {
  protected:
    // Writes the volume, and reads the words of each record. words[i][1] is word 1 of record i.
    void write(const Volume& volume, const VolumeWriteOptions& options = {}) {
        VolumeFile::write(volume, options);
        const auto bytes = *read_file(path_);
        const auto byte = [&](std::size_t at) { return std::to_integer<int>(bytes.at(at)); };
        const auto length = [&](std::size_t at) {
            return static_cast<std::size_t>(byte(at) << 24 | byte(at + 1) << 16 |
                                            byte(at + 2) << 8 | byte(at + 3));
        };
        records_.clear();
        for (std::size_t at = 0; at < bytes.size(); at += length(at) + 8) {
            Words& words = records_.emplace_back(1, 0);
            for (std::size_t i = at + 4; i < at + 4 + length(at); i += 2)
                words.push_back(static_cast<std::int16_t>(byte(i) << 8 | byte(i + 1)));
            EXPECT_EQ(length(at + 4 + length(at)), length(at)) << "the length follows, too";
            EXPECT_EQ(words.at(2), static_cast<int>(words.size()) - 1);
        }
    }
    // Returns the place of the header of a field; 0 if the radial lacks it.
    std::size_t place_of(std::size_t record, std::string_view name) const {
        const Words& words = records_.at(record);
        const auto header = static_cast<std::size_t>(words.at(5));
        for (std::size_t i = 0; i < static_cast<std::size_t>(words.at(header)); ++i) {
            if (words.at(header + 3 + 2 * i) == (name[0] << 8 | name[1]))
                return static_cast<std::size_t>(words.at(header + 4 + 2 * i));
        }
        return 0;
    }
    int header_of(std::size_t record, std::string_view field, std::size_t word) const {
        return records_.at(record).at(place_of(record, field) + word - 1);
    }
    Words gates_of(std::size_t record, std::string_view field) const {
        const auto first = records_.at(record).begin() + header_of(record, field, 1);
        return {first, first + header_of(record, field, 6)};
    }

    std::vector<Words> records_;
};

TEST_F(Uf, WordsAreValuesTimesTheFactor) {
    SweepMoment ratio = small_moment(Moment::rho, {{2, 255}, {3}});
    ratio.scale = 300;
    ratio.offset = -60.5F;
    write(small_volume({small_sweep(1, {small_moment(Moment::ref, {{0, 1, 2, 255}, {66}}), ratio,
                                        small_moment(Moment::cfp, {{7, 8}, {9}})})}));
    ASSERT_EQ(records_.size(), 2U);
    EXPECT_EQ(header_of(0, "DZ", 2), 100);
    EXPECT_EQ(gates_of(0, "DZ"), (Words{missing, missing, -3200, 9450}));
    EXPECT_EQ(gates_of(1, "DZ"), (Words{0}));
    EXPECT_EQ(header_of(0, "RH", 2), 600) << "the least factor that is exact";
    EXPECT_EQ(gates_of(0, "RH"), (Words{125, 631, missing, missing}));
    EXPECT_EQ(gates_of(0, "CF"), (Words{missing, -2900, missing, missing})) << "code 7 is a flag";
}

TEST_F(Uf, HeadersSayWhereAndWhen) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::vel, {{2}, {3}})}),
                                  small_sweep(3, {small_moment(Moment::vel, {{2}})})});
    volume.sweeps[0].radials[0].azimuth_deg = 359.9999F;
    volume.sweeps[0].radials[0].elevation_deg = -0.25F;
    volume.sweeps[0].radials[0].nyquist_mps = 26.12F;
    write(volume);
    const Words& first = records_[0];
    EXPECT_EQ(first[1], 0x5546) << "UF";
    EXPECT_EQ(Words(first.begin() + 3, first.begin() + 11), (Words{46, 46, 46, 1, 116, 1, 1, 1}));
    EXPECT_EQ(first[11], 0x4b54) << "KT";
    EXPECT_EQ(first[19], 35);
    EXPECT_EQ(first[22], -97);
    EXPECT_LE(first[23], 0) << "minutes and seconds have the sign of the angle";
    EXPECT_LE(first[24], 0);
    EXPECT_EQ(Words(first.begin() + 26, first.begin() + 32), (Words{2022, 3, 17, 0, 8, 52}));
    EXPECT_EQ(first[33], 360 * 64);
    EXPECT_EQ(first[34], -16);
    EXPECT_EQ(first[36], 32);
    EXPECT_EQ(first[45], missing);
    EXPECT_EQ(records_[2][10], 2) << "the second sweep";
    EXPECT_EQ(header_of(0, "VR", 4), 2125);
    EXPECT_EQ(header_of(0, "VR", 20), 2612);
    EXPECT_EQ(header_of(1, "VR", 20), missing);
}

// Readers take fields, factors, gates and range of all radials from the first radial.
TEST_F(Uf, AllRadialsHaveAllFieldsOnOneRange) {
    SweepMoment far = small_moment(Moment::ref, {{100, 2}, {4}});
    far.first_gate_m = 2500;
    far.gate_spacing_m = 1000;
    write(small_volume({small_sweep(1, {small_moment(Moment::vel, {{2}})}), small_sweep(2, {far}),
                        small_sweep(3, {small_moment(Moment::ref, {{2, 4}, {6}})})}));
    EXPECT_EQ(gates_of(0, "VR"),
              (Words{-3200, missing, missing, missing, missing, missing, missing, missing}));
    EXPECT_EQ(gates_of(0, "DZ"), Words(8, missing));
    EXPECT_EQ(gates_of(1, "DZ"), (Words{1700, 1700, 1700, 1700, -3200, -3200, -3200, -3200}));
    EXPECT_EQ(gates_of(2, "DZ"), Words(4, -3100));
    EXPECT_EQ(gates_of(2, "VR"), Words(4, missing));
    EXPECT_EQ(gates_of(4, "DZ"), (Words{-3000})) << "the field has as many gates as the radial";
    EXPECT_EQ(header_of(1, "DZ", 5), 250);
}

TEST_F(Uf, WithOwnRangesARadialHasOnlyItsOwnGates) {
    SweepMoment far = small_moment(Moment::ref, {{100, 2}});
    far.first_gate_m = 40'500;
    far.gate_spacing_m = 1000;
    write(small_volume({small_sweep(1, {small_moment(Moment::vel, {{2}})}), small_sweep(2, {far})}),
          with_all_ranges());
    EXPECT_EQ(place_of(0, "DZ"), 0U);
    EXPECT_EQ(gates_of(1, "DZ"), (Words{1700, -3200}));
    EXPECT_EQ(header_of(1, "DZ", 3), 40) << "a word cannot hold 40500 m";
    EXPECT_EQ(header_of(1, "DZ", 4), 500);
    EXPECT_EQ(header_of(1, "DZ", 5), 1000);
}

TEST_F(Uf, ARadarOfNobodyKnowsWhereIsWritten) {
    Volume volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}})})});
    volume.station.clear();
    volume.header.reset();
    write(volume);
    EXPECT_EQ(Words(records_[0].begin() + 19, records_[0].begin() + 26), Words(7, missing));
    EXPECT_EQ(records_[0][37], missing) << "one radial does not tell the speed of the antenna";
}

TEST_F(Uf, RefusesWhatItCannotHold) {
    const auto refuses = [&](const Volume& volume, std::string_view why) {
        const Status written = write_uf(real_file_system(), path_, volume, {});
        ASSERT_FALSE(written) << why;
        EXPECT_EQ(written.error().code, ErrorCode::unsupported);
        EXPECT_NE(written.error().message.find(why), std::string::npos) << written.error().message;
    };
    SweepMoment huge = small_moment(Moment::ref, {{2}});
    huge.scale = 1e-4F;
    refuses(small_volume({small_sweep(1, {huge})}), "REF has values to 1.89e+06");
    huge.scale = std::numeric_limits<float>::quiet_NaN();
    refuses(small_volume({small_sweep(1, {huge})}), "REF has values to inf");
    refuses(small_volume({}), "no radials");
    Volume many = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}})})});
    many.sweeps[0].moments.clear();
    many.sweeps[0].radials.resize(32'768);
    refuses(many, "at most 32767");
    const netcdf::Row row(8000, 2);
    refuses(small_volume(
                {small_sweep(1, {small_moment(Moment::ref, {row}), small_moment(Moment::vel, {row}),
                                 small_moment(Moment::sw, {row}), small_moment(Moment::zdr, {row}),
                                 small_moment(Moment::rho, {row})})}),
            "words");
}

}  // namespace
}  // namespace stormcellar::netcdf
