#include "level2/foreign/odim.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/level2/foreign/odim_files.h"

namespace stormcellar::level2 {
namespace {

using testing::add_quantity;
using testing::begin_dataset;
using testing::begin_odim;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Hdf5Writer;
using Bytes8 = std::vector<std::uint8_t>;

Volume decoded(Hdf5Writer& file, const DecodeOptions& options = {}) {
    auto made = decode(file.bytes(), options);
    EXPECT_TRUE(made) << made.error().message;
    return made ? made->volume : Volume{};
}

std::string error_of(Hdf5Writer& file) {
    const auto made = decode(file.bytes());
    EXPECT_FALSE(made);
    return made ? "" : made.error().message;
}

std::vector<std::uint16_t> codes_of(const SweepMoment& moment, std::size_t radial) {
    std::vector<std::uint16_t> codes;
    for (std::int32_t gate = 0; gate < moment.gate_counts[radial]; ++gate)
        codes.push_back(moment.code(radial, gate));
    return codes;
}

TEST(Odim, ReadsAVolumeOfAnotherCountry) {
    Hdf5Writer file;
    begin_odim(file);
    const std::string dataset = begin_dataset(file);
    file.group(dataset + "/how").number("NI", 24.5F);
    add_quantity<std::uint8_t>(file, dataset, 1, "DBZH", 4,
                               {0, 100, 254, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 0}, 255, 0, 2);
    add_quantity<std::uint16_t>(file, dataset, 2, "VRADH", 4,
                                {0, 1, 65534, 64, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9}, 65535);
    const Volume volume = decoded(file);

    EXPECT_EQ(volume.station, "SKRN");
    const auto antenna = antenna_position(volume);
    ASSERT_TRUE(antenna);
    EXPECT_NEAR(antenna->latitude_deg, 67.8, 1e-5);
    EXPECT_NEAR(antenna->longitude_deg, 20.25, 1e-5);
    EXPECT_EQ(antenna->altitude_m, 646);
    ASSERT_EQ(volume.sweeps.size(), 1U);
    const Sweep& sweep = volume.sweeps[0];
    ASSERT_EQ(sweep.radials.size(), 4U);
    EXPECT_FLOAT_EQ(*sweep.vcp_elevation_deg, 0.5F);
    EXPECT_FLOAT_EQ(sweep.radials[1].azimuth_deg, 135);
    EXPECT_FLOAT_EQ(sweep.radials[1].elevation_deg, 0.5F);
    EXPECT_FLOAT_EQ(sweep.radials[1].nyquist_mps, 24.5F);
    EXPECT_EQ(format_utc(sweep.radials[1].time), "2024-01-02T03:04:08Z");
    EXPECT_EQ(format_utc(*volume.start_time()), "2024-01-02T03:04:05Z");
    EXPECT_TRUE(has_ended(volume));

    const SweepMoment* ref = sweep.find(Moment::ref);
    ASSERT_NE(ref, nullptr);
    EXPECT_EQ(ref->word_size_bits, 8);
    EXPECT_EQ(ref->first_gate_m, 250);
    EXPECT_EQ(ref->gate_spacing_m, 500);
    EXPECT_THAT(codes_of(*ref, 0), ElementsAre(0, 101, 255, 2));
    EXPECT_EQ(ref->status(0, 0), GateStatus::below_threshold);
    EXPECT_EQ(ref->value_of(ref->code(0, 1)), 18);  // 100 * 0.5 - 32
    EXPECT_EQ(ref->value_of(ref->code(0, 2)), 95);
    EXPECT_EQ(ref->value_of(ref->code(0, 3)), -31.5F);
    const SweepMoment* vel = sweep.find(Moment::vel);
    ASSERT_NE(vel, nullptr);
    EXPECT_EQ(vel->word_size_bits, 16);
    EXPECT_THAT(codes_of(*vel, 0), ElementsAre(0, 2, 65535, 65));
    EXPECT_EQ(vel->value_of(vel->code(0, 2)), 32735);
    EXPECT_EQ(vel->value_of(vel->code(0, 3)), 0);
}

TEST(Odim, ReadsEachFormOfHdf5) {
    for (const H5F_libver_t newest : {H5F_LIBVER_V18, H5F_LIBVER_V110}) {
        Hdf5Writer file{newest};
        begin_odim(file, "SCAN");
        const std::string dataset = begin_dataset(file);
        file.group(dataset + "/how");
        for (int i = 0; i < 40; ++i)  // too many attributes for the header of an object
            file.number(("fact" + std::to_string(i)).c_str(), i);
        std::vector<double> starts_deg(720);
        for (std::size_t i = 0; i < starts_deg.size(); ++i)
            starts_deg[i] = static_cast<double>(i) / 2 + 0.1;
        file.numbers("startazA", starts_deg);  // too large for a block of attributes
        add_quantity(file, dataset, 1, "TH", 720, Bytes8(1440, 80), 255, 0, 100);
        const Volume volume = decoded(file);
        ASSERT_EQ(volume.sweeps.size(), 1U);
        EXPECT_EQ(volume.sweeps[0].azimuth_spacing_deg, 0.5F);
        EXPECT_FLOAT_EQ(volume.sweeps[0].radials[7].azimuth_deg, 3.85F);
        EXPECT_THAT(volume.sweeps[0].find(Moment::ref)->codes8, Each(81));
    }
}

TEST(Odim, PutsRaysInOrderOfTime) {
    Hdf5Writer file;
    begin_odim(file);
    std::string dataset = begin_dataset(file);
    file.group(dataset + "/how").numbers("startazT", {1.7e9 + 2, 1.7e9 + 3, 1.7e9, 1.7e9 + 1.25});
    add_quantity(file, dataset, 1, "DBZH", 4, Bytes8{10, 11, 12, 13});
    // This data set was measured before the first data set.
    dataset = begin_dataset(file, {2, 3.0});
    file.group(dataset + "/how").numbers("startazT", {1.6e9, 1.6e9 + 1, 1.6e9 + 2, 1.6e9 + 3});
    add_quantity(file, dataset, 1, "DBZH", 4, Bytes8{20, 21, 22, 23});
    const Volume volume = decoded(file);
    ASSERT_EQ(volume.sweeps.size(), 2U);
    EXPECT_FLOAT_EQ(*volume.sweeps[0].vcp_elevation_deg, 3);
    const Sweep& sweep = volume.sweeps[1];
    EXPECT_THAT(sweep.find(Moment::ref)->codes8, ElementsAre(13, 14, 11, 12));
    EXPECT_FLOAT_EQ(sweep.radials[0].azimuth_deg, 225);
    EXPECT_EQ(seconds_between(sweep.radials[0].time, sweep.radials[1].time), 1.25);
    EXPECT_EQ(sweep.elevation_number, 2);
}

TEST(Odim, BeginsWithTheRayThatWasMeasuredFirst) {
    Hdf5Writer file;
    begin_odim(file);
    const std::string dataset = begin_dataset(file, {});
    file.group("dataset1/how");
    add_quantity(file, dataset, 1, "DBZH", 4, Bytes8{10, 11, 12, 13});
    file.group("dataset2/where").number("elangle", 1.0).number("rscale", 1000.0);
    file.number("rstart", 0.0).number("a1gate", 3);
    file.group("dataset2/what").text("startdate", "20240102").text("starttime", "030500");
    file.text("enddate", "20240102").text("endtime", "030520");
    add_quantity(file, "dataset2", 1, "DBZH", 4, Bytes8{10, 11, 12, 13});
    const Sweep sweep = decoded(file).sweeps.at(1);
    EXPECT_THAT(sweep.find(Moment::ref)->codes8, ElementsAre(14, 11, 12, 13));
    EXPECT_EQ(format_utc(sweep.radials[1].time), "2024-01-02T03:05:05Z");
}

// Until version 2.3, the start of the first gate is in kilometers, since then in meters.
TEST(Odim, KnowsTheUnitOfTheFirstGate) {
    for (const auto& [version, rstart] : {std::pair{"V2_3", 1.5}, {"V2_4", 1500.0}}) {
        Hdf5Writer file;
        begin_odim(file, "PVOL", version);
        add_quantity(file, begin_dataset(file, {1, 0.5, 500, rstart}), 1, "DBZH", 2, Bytes8{9, 9});
        EXPECT_EQ(decoded(file).sweeps.at(0).find(Moment::ref)->first_gate_m, 1750) << version;
    }
}

// The Netherlands have gates of 223.5 m. A gate takes the value of the nearest gate of the file.
TEST(Odim, LaysGatesOnWholeMeters) {
    Hdf5Writer file;
    begin_odim(file);
    Bytes8 values(200);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint8_t>(i + 1);
    add_quantity(file, begin_dataset(file, {1, 0.5, 223.5}), 1, "DBZH", 1, values);
    const Volume volume = decoded(file);
    const SweepMoment& ref = *volume.sweeps.at(0).find(Moment::ref);
    EXPECT_EQ(ref.gate_spacing_m, 224);
    EXPECT_EQ(ref.gate_stride, 200);
    for (std::int32_t gate = 0; gate < ref.gate_stride; ++gate) {
        const double of_file_m = (ref.code(0, gate) - 2 + 0.5) * 223.5;
        EXPECT_LE(std::abs(of_file_m - ref.range_m(gate)), 223.5 / 2 + 0.5) << gate;
    }
}

TEST(Odim, CutsOffWhatWasNotMeasured) {
    Hdf5Writer file;
    begin_odim(file);
    add_quantity(file, begin_dataset(file), 1, "DBZH", 3,
                 Bytes8{255, 9, 255, 0, 255,    //
                        255, 255, 7, 255, 255,  //
                        255, 255, 255, 255, 255});
    const auto made = decode(file.bytes());
    ASSERT_TRUE(made);
    const SweepMoment& ref = *made->volume.sweeps.at(0).find(Moment::ref);
    EXPECT_EQ(ref.first_gate_m, 750);
    EXPECT_THAT(ref.gate_counts, ElementsAre(3, 2, 0));
    EXPECT_THAT(codes_of(ref, 0), ElementsAre(10, 1, 0));
    EXPECT_THAT(codes_of(ref, 1), ElementsAre(1, 8));
    EXPECT_EQ(ref.status(2, 0), GateStatus::no_data);
    EXPECT_EQ(made->report.problems.back().code, "gaps");
}

TEST(Odim, KeepsTheBestQuantityOfAMoment) {
    Hdf5Writer file;
    begin_odim(file);
    const std::string dataset = begin_dataset(file);
    add_quantity(file, dataset, 1, "TH", 1, Bytes8{50});
    add_quantity(file, dataset, 2, "DBZH", 1, Bytes8{60});
    add_quantity(file, dataset, 3, "SQIH", 1, Bytes8{70});
    const auto made = decode(file.bytes());
    ASSERT_TRUE(made);
    const Sweep& sweep = made->volume.sweeps.at(0);
    ASSERT_EQ(sweep.moments.size(), 1U);
    EXPECT_EQ(sweep.find(Moment::ref)->codes8.at(0), 61);
    EXPECT_THAT(made->report.problems.back().message, HasSubstr("SQIH, TH"));
    EXPECT_TRUE(made->report.complete);
}

TEST(Odim, JoinsDataSetsOfOneSweep) {
    Hdf5Writer file;
    begin_odim(file);
    add_quantity(file, begin_dataset(file), 1, "DBZH", 2, Bytes8{9, 9});
    add_quantity(file, begin_dataset(file, {2, 0.5, 250}), 1, "VRADH", 2, Bytes8{9, 9, 9, 9});
    const Volume volume = decoded(file);
    ASSERT_EQ(volume.sweeps.size(), 1U);
    EXPECT_EQ(volume.sweeps[0].find(Moment::ref)->gate_spacing_m, 500);
    EXPECT_EQ(volume.sweeps[0].find(Moment::vel)->gate_spacing_m, 250);
}

TEST(Odim, PacksFloatsInSmallSteps) {
    Hdf5Writer file;
    begin_odim(file);
    const std::vector<float> values = {0, 55.123F, -9999, 200.007F, 1e9F, 64};
    add_quantity(file, begin_dataset(file), 1, "DBZH", 1, values, -9999, 0);
    const auto made = decode(file.bytes());
    ASSERT_TRUE(made);
    const SweepMoment& ref = *made->volume.sweeps.at(0).find(Moment::ref);
    EXPECT_EQ(ref.status(0, 0), GateStatus::below_threshold);
    EXPECT_EQ(ref.status(0, 2), GateStatus::range_folded);
    for (const std::int32_t gate : {1, 3, 5}) {
        const float value = values[static_cast<std::size_t>(gate)] * 0.5F - 32;
        EXPECT_NEAR(ref.value_of(ref.code(0, gate)), value, 0.0051F) << gate;
    }
    EXPECT_EQ(made->report.problems.back().code, "beyond");
}

TEST(Odim, DecodesTheSelectedMomentsAndCuts) {
    Hdf5Writer file;
    begin_odim(file);
    for (const int number : {1, 2}) {
        const std::string dataset = begin_dataset(file, {number, 1.0 * number});
        add_quantity(file, dataset, 1, "DBZH", 1, Bytes8{50});
        add_quantity(file, dataset, 2, "VRADH", 1, Bytes8{60});
    }
    DecodeOptions options;
    options.selection = {{Moment::vel}, {2}};
    const Volume volume = decoded(file, options);
    ASSERT_EQ(volume.sweeps.size(), 1U);
    EXPECT_FLOAT_EQ(*volume.sweeps[0].vcp_elevation_deg, 2);
    ASSERT_EQ(volume.sweeps[0].moments.size(), 1U);
    EXPECT_EQ(volume.sweeps[0].moments[0].moment, Moment::vel);
}

TEST(Odim, ComputesTheNyquistVelocityOfTwoPulseRates) {
    Hdf5Writer file;
    begin_odim(file);
    const std::string dataset = begin_dataset(file);
    file.group("how").number("wavelength", 5.35);
    file.group(dataset + "/how").number("highprf", 1200.0).number("lowprf", 900);
    add_quantity(file, dataset, 1, "VRADH", 1, Bytes8{50});
    EXPECT_NEAR(decoded(file).sweeps.at(0).radials.at(0).nyquist_mps, 48.15, 0.01);
}

TEST(Odim, RefusesWhatIsNoVolume) {
    for (const auto& [object, kind] : {std::pair{"COMP", "'COMP', a composite of several radars"},
                                       {"IMAGE", "'IMAGE', an image"},
                                       {"ELEV", "'ELEV', a vertical section"},
                                       {"VP", "'VP', a vertical profile"}}) {
        Hdf5Writer file;
        begin_odim(file, object);
        EXPECT_THAT(error_of(file), HasSubstr(kind));
    }
}

TEST(Odim, SaysWhyAFileIsNotRead) {
    {
        Hdf5Writer empty;
        begin_odim(empty);
        EXPECT_THAT(error_of(empty), HasSubstr("without a sweep that can be read"));
    }
    Hdf5Writer other;
    other.text("title", "something else");
    const auto made = decode(other.bytes());
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::not_level2);
}

TEST(Odim, KeepsWhatIsWhole) {
    Hdf5Writer file;
    begin_odim(file);
    const std::string dataset = begin_dataset(file);
    Bytes8 noise(400);
    for (std::size_t i = 0; i < noise.size(); ++i)
        noise[i] = static_cast<std::uint8_t>(i * i * 31 + i * 7);
    add_quantity(file, dataset, 1, "DBZH", 2, noise, 255, 0, 2);
    add_quantity(file, dataset, 2, "VRADH", 2, Bytes8(400, 77));
    std::vector<std::byte> bytes = file.bytes();
    // Damages the packed chunk, which begins with the head of zlib.
    const std::byte head[] = {std::byte{0x78}, std::byte{0x9C}};
    const auto at = std::search(bytes.begin(), bytes.end(), std::begin(head), std::end(head));
    ASSERT_NE(at, bytes.end());
    std::fill_n(at + 20, 20, std::byte{0});
    const auto made = decode(bytes);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->volume.sweeps.at(0).find(Moment::ref), nullptr);
    EXPECT_NE(made->volume.sweeps.at(0).find(Moment::vel), nullptr);
    EXPECT_TRUE(made->report.damaged);
    EXPECT_FALSE(made->report.complete);
    EXPECT_THAT(made->report.problems.back().message, HasSubstr("is damaged"));
}

}  // namespace
}  // namespace stormcellar::level2
