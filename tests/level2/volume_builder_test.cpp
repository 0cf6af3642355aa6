#include "level2/decode/volume_builder.h"

#include <gtest/gtest.h>

#include "level2/decode/fragment_builder.h"
#include "tests/level2/no_limits.h"
#include "tests/level2/same_volume.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t rows = 8;

struct Spec {
    int elevation_number = 1;
    int status = 1;
    std::uint16_t gates = 4;
    std::int32_t first_gate_m = 0;
    int word_size_bits = 8;
    bool has_ref = true;
};

class VolumeBuilderTest : public ::testing::Test {
  protected:
    // Adds a radial with the codes 10, 11, 12 ...
    bool add(const Spec& spec) {
        RadialMessage message;
        message.elevation_number = spec.elevation_number;
        message.azimuth_spacing_deg = 1;
        message.radial.status = static_cast<std::uint8_t>(spec.status);
        codes_.clear();
        for (unsigned i = 0; i < spec.gates; ++i) {
            if (spec.word_size_bits == 16) codes_.push_back(std::byte{1});
            codes_.push_back(static_cast<std::byte>(10 + i));
        }
        MomentBlock block;
        block.gates = spec.gates;
        block.first_gate_m = spec.first_gate_m;
        block.word_size_bits = spec.word_size_bits;
        block.codes = codes_;
        if (spec.has_ref && !message.add(block)) return false;
        return builder_.add(message);
    }
    // Ends the fragment; later radials belong to the next fragment.
    void end_fragment() { EXPECT_TRUE(volume_.append(builder_.take())); }
    Volume finish() {
        end_fragment();
        volume_.report_data().message_counts[31] = 1;  // the builder gets only radials
        Decoded decoded = volume_.finish("").value();
        report_ = std::move(decoded.report);
        return std::move(decoded.volume);
    }

    Selection selection_;
    ArrayRoom room_{ample};
    FragmentBuilder builder_{room_, rows, selection_};
    VolumeBuilder volume_{ample};
    DecodeReport report_;
    std::vector<std::byte> codes_;
};

std::vector<std::size_t> radials_of(const Volume& volume) {
    std::vector<std::size_t> counts;
    for (const Sweep& sweep : volume.sweeps)
        counts.push_back(sweep.radials.size());
    return counts;
}

TEST_F(VolumeBuilderTest, SweepsBeginAtStatus0And3And5AndAtANewElevationNumber) {
    for (const Spec& spec : {Spec{1, 3}, Spec{1, 1}, Spec{1, 2}, Spec{2, 0}, Spec{2, 0}, Spec{3, 1},
                             Spec{3, 1}, Spec{4, 5}, Spec{4, 4}}) {
        EXPECT_TRUE(add(spec));
    }
    EXPECT_EQ(radials_of(finish()), (std::vector<std::size_t>{3, 1, 1, 2, 2}));
    EXPECT_FALSE(report_.complete) << "the sweep of cut 3 has no last radial";
    EXPECT_TRUE(report_.further_volume_starts.empty());
}

TEST_F(VolumeBuilderTest, RowsHaveTheLengthOfTheLongestRadial) {
    for (const std::uint16_t gates : std::vector<std::uint16_t>{4, 6, 7, 2})
        EXPECT_TRUE(add({1, 1, gates}));
    const Volume volume = finish();
    const SweepMoment& ref = volume.sweeps.at(0).moments.at(0);
    EXPECT_EQ(ref.gate_stride, 7);
    EXPECT_EQ(ref.gate_counts, (std::vector<std::uint16_t>{4, 6, 7, 2}));
    EXPECT_EQ(ref.codes8.size(), 28);
    for (std::size_t radial = 0; radial < 4; ++radial) {
        for (std::int32_t gate = 0; gate < 7; ++gate) {
            const int expected = gate < ref.gate_counts[radial] ? 10 + gate : 0;
            EXPECT_EQ(ref.code(radial, gate), expected) << radial << " " << gate;
        }
    }
}

TEST_F(VolumeBuilderTest, CodesOf16BitsAreBigEndian) {
    Spec spec{.word_size_bits = 16};
    EXPECT_TRUE(add(spec));
    const Volume volume = finish();
    EXPECT_EQ(volume.sweeps[0].moments[0].code(0, 3), 256 + 13);
    EXPECT_TRUE(volume.sweeps[0].moments[0].codes8.empty());
}

TEST_F(VolumeBuilderTest, ADifferentGeometryIsAnotherKindOfTheMoment) {
    EXPECT_TRUE(add({1, 3, 4, 0}));
    EXPECT_TRUE(add({1, 1, 4, 1000}));
    EXPECT_TRUE(add({1, 1, 4, 0}));
    const Volume volume = finish();
    const auto& moments = volume.sweeps.at(0).moments;
    ASSERT_EQ(moments.size(), 2);
    EXPECT_EQ(moments[0].gate_counts, (std::vector<std::uint16_t>{4, 0, 4}));
    EXPECT_EQ(moments[1].gate_counts, (std::vector<std::uint16_t>{0, 4, 0}));
    EXPECT_EQ(moments[1].status(0, 0), GateStatus::no_data);
    EXPECT_EQ(moments[1].code(1, 2), 12);
}

TEST_F(VolumeBuilderTest, RadialsWithoutTheMomentHaveNoGates) {
    Spec without{.has_ref = false};
    EXPECT_TRUE(add({}));
    EXPECT_TRUE(add(without));
    const Volume volume = finish();
    EXPECT_EQ(volume.sweeps[0].moments[0].gate_counts, (std::vector<std::uint16_t>{4, 0}));
    EXPECT_EQ(volume.sweeps[0].moments[0].codes8.size(), 8);
}

// KBBX20060113 has four volumes in one file. The volumes have lost the radials at their ends.
TEST_F(VolumeBuilderTest, AFallingElevationNumberBeginsAnotherVolume) {
    for (const int number : {1, 2, 3, 1, 2})
        EXPECT_TRUE(add({number}));
    (void)finish();
    EXPECT_EQ(report_.further_volume_starts, (std::vector<std::size_t>{3}));
}

TEST_F(VolumeBuilderTest, ARestartedCutIsNotAnotherVolumeButAStartOfVolumeIs) {
    EXPECT_TRUE(add({1, 3}));
    EXPECT_TRUE(add({2, 0}));
    EXPECT_TRUE(add({2, 0}));
    EXPECT_TRUE(add({2, 3}));
    (void)finish();
    EXPECT_EQ(report_.further_volume_starts, (std::vector<std::size_t>{3}));
}

TEST_F(VolumeBuilderTest, AHeaderBeforeAnyRadialIsTheSameVolumes) {
    builder_.further_header({"AR2V0006.842", 1, 2, "KCCX"});
    EXPECT_TRUE(add({1, 3}));
    builder_.further_header({"AR2V0006.843", 3, 4, "KCCX"});
    EXPECT_TRUE(add({2, 1}));
    (void)finish();
    EXPECT_EQ(report_.further_volume_starts, (std::vector<std::size_t>{1}));
    ASSERT_EQ(report_.further_headers.size(), 1);
    EXPECT_EQ(report_.further_headers[0].header.filename, "AR2V0006.843");
}

// Wherever fragments end between radials, the sweeps are the same.
TEST_F(VolumeBuilderTest, FragmentsMayEndAnywhere) {
    const std::vector<Spec> specs = {{1, 3, 4}, {1, 1, 6}, {1, 1, 3, 1000},  {1, 2, 9},
                                     {2, 0, 5}, {2, 1, 5}, {2, 1, 5, 0, 16}, {2, 4, 7}};
    for (const Spec& spec : specs)
        EXPECT_TRUE(add(spec));
    const Volume whole = finish();
    ASSERT_EQ(radials_of(whole), (std::vector<std::size_t>{4, 4}));
    for (unsigned ends = 0; ends < 256; ++ends) {
        volume_ = VolumeBuilder{ample};
        for (std::size_t i = 0; i < specs.size(); ++i) {
            EXPECT_TRUE(add(specs[i]));
            if (((ends >> i) & 1U) != 0) end_fragment();
        }
        EXPECT_EQ(difference(finish(), whole), "") << ends;
        EXPECT_TRUE(report_.complete);
    }
}

TEST_F(VolumeBuilderTest, KindsOfManyFragmentsStandInOneSweep) {
    for (int i = 0; i < 40; ++i) {
        EXPECT_TRUE(add({1, 1, 4, i * 250}));
        end_fragment();
    }
    const Volume volume = finish();
    EXPECT_EQ(volume.sweeps.at(0).moments.size(), 40U);
    EXPECT_EQ(volume.sweeps.at(0).radials.size(), 40U);
    EXPECT_EQ(volume.sweeps.at(0).moments.at(39).gate_counts.at(39), 4U);
}

TEST_F(VolumeBuilderTest, ACutThatIsNotAskedForGivesNoSweep) {
    selection_.elevation_numbers = {2, 4};
    for (const Spec& spec :
         {Spec{1, 3}, Spec{1, 1}, Spec{1, 2}, Spec{2, 0}, Spec{2, 2}, Spec{3, 0}, Spec{3, 4}}) {
        EXPECT_TRUE(add(spec));
        end_fragment();
    }
    const Volume volume = finish();
    EXPECT_EQ(radials_of(volume), (std::vector<std::size_t>{2}));
    EXPECT_EQ(report_.sweeps_left_out, 2U);
    EXPECT_TRUE(report_.complete) << "the decoder saw the end but does not keep its radial";
}

TEST_F(VolumeBuilderTest, AMomentThatIsNotAskedForIsLeftOut) {
    selection_.moments = {Moment::vel};
    EXPECT_TRUE(add({1, 3}));
    const Volume volume = finish();
    EXPECT_EQ(volume.radial_count(), 1U);
    EXPECT_TRUE(volume.sweeps.at(0).moments.empty());
}

// Returns how many radials a fragment takes, at most `most`. `block_of(i)` returns the moment of
// radial i.
template <class BlockOf>
int radials_taken(std::size_t room_bytes, int most, BlockOf block_of) {
    ArrayRoom room{room_bytes};
    FragmentBuilder builder{room, rows, everything};
    int taken = 0;
    for (; taken < most; ++taken) {
        RadialMessage message;
        message.elevation_number = 1;
        EXPECT_TRUE(message.add(block_of(taken)));
        if (!builder.add(message)) break;
    }
    return taken;
}

// One radial with very many gates makes every row long, so a radial of 4 gates takes 65,535 codes.
TEST(FragmentBuilderLimit, RowsOfLyingLengthStopAtTheLimit) {
    const std::vector<std::byte> codes(65'535);
    const int taken = radials_taken(10'000'000, 100'000, [&](int number) {
        MomentBlock block;
        block.gates = number == 0 ? 65'535 : 4;
        block.codes = std::span{codes}.first(block.gates);
        return block;
    });
    EXPECT_GT(taken, 100);
    EXPECT_LT(taken, 160);
}

// Each radial has another scale, so it needs its own table, which has a row for every radial of the
// sweep.
TEST(FragmentBuilderLimit, RowsOfManyKindsStopAtTheLimitOfASweep) {
    const std::vector<std::byte> codes(1000);
    const int taken = radials_taken(ample, 1000, [&](int number) {
        return MomentBlock{.gates = 1000, .scale = static_cast<float>(1 + number), .codes = codes};
    });
    EXPECT_GT(taken, 200) << "200 radials of 200 kinds take 200 x 200 x 1000 bytes";
    EXPECT_LT(taken, 270);
}

TEST_F(VolumeBuilderTest, TheEndOfAVolumeIsKnownThoughItsRadialHasBadData) {
    EXPECT_TRUE(add({1, 3}));
    EXPECT_TRUE(add({1, 0x84}));
    const Volume volume = finish();
    EXPECT_TRUE(report_.complete);
    EXPECT_TRUE(has_ended(volume));
}

}  // namespace
}  // namespace stormcellar::level2
