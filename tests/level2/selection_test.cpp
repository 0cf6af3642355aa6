// Tests that decoding a selection gives exactly the selected part of the whole volume.
#include "stormcellar/level2/selection.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "level2/containers/ldm_framer.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/growing_volume.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"
#include "tests/testing/test_name.h"

namespace stormcellar::level2 {
namespace {

// Returns the part of a volume that is selected.
Volume selected(Volume volume, const Selection& selection) {
    std::erase_if(volume.sweeps,
                  [&](const Sweep& sweep) { return !selection.wants_cut(sweep.elevation_number); });
    for (Sweep& sweep : volume.sweeps) {
        std::erase_if(sweep.moments,
                      [&](const SweepMoment& moment) { return !selection.wants(moment.moment); });
    }
    return volume;
}

struct Case {
    const char* file;
    bool can_skip;  // the records are where the pattern says
};

class SelectionReal : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        bytes_ = read_file(*testing::data_directory() / "volumes" / GetParam().file).value();
        whole_ = decode(bytes_).value();
    }
    DecodeReport expect_selected(const Selection& selection, int threads) const {
        DecodeOptions options;
        options.threads = threads;
        options.selection = selection;
        const auto decoded = decode(bytes_, options).value();
        EXPECT_EQ(difference(decoded.volume, selected(whole_.volume, selection)), "");
        return decoded.report;
    }
    std::vector<std::byte> bytes_;
    Decoded whole_;
};

TEST_P(SelectionReal, MomentsAndCuts) {
    expect_selected({{Moment::ref, Moment::rho}, {}}, 1);
    for (const std::vector<int>& cuts : std::vector<std::vector<int>>{{1}, {2, 5}, {99}}) {
        for (const int threads : {1, 2}) {
            const DecodeReport report = expect_selected({{Moment::ref}, cuts}, threads);
            EXPECT_EQ(report.records_skipped > 0, GetParam().can_skip) << cuts.front();
            EXPECT_EQ(report.ldm_records, whole_.report.ldm_records);
            EXPECT_EQ(report.negative_control_words, whole_.report.negative_control_words);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Files, SelectionReal,
                         ::testing::Values(Case{"KLBB20160601_150025_V06", true},
                                           Case{"KTLX20170101_030027_V06", true},
                                           Case{"KDMX20250101_225441_V06", true},
                                           Case{"Level2_TSTL_20220213_2357.ar2v", true},
                                           Case{"KTLX20140101_000624.trimmed.ar2v", false},
                                           Case{"KBBX20060113_170337.gz", false}),
                         [](const auto& test) { return testing::test_name(test.param.file); });

// A lost or repeated record shifts all records after it, so no record may be skipped.
TEST(SelectionRealDamage, ALostRecordVoidsThePlan) {
    STORMCELLAR_NEED_DATA();
    const auto bytes =
        read_file(*testing::data_directory() / "volumes" / "KTLX20170101_030027_V06").value();
    std::vector<LdmPart> parts;
    LdmFramer framer{std::span{bytes}.subspan(24)};
    while (const auto part = framer.next())
        parts.push_back(*part);
    for (const std::size_t lost : {1U, 4U, 13U}) {
        std::vector<std::byte> damaged(bytes.begin(), bytes.begin() + 24);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (i == lost) continue;
            const auto from = bytes.begin() + 24 + static_cast<std::ptrdiff_t>(parts[i].position);
            damaged.insert(damaged.end(), from,
                           from + static_cast<std::ptrdiff_t>(4 + parts[i].bytes.size()));
        }
        const auto whole = decode(damaged).value();
        DecodeOptions options;
        options.selection = {{}, {5}};
        const auto some = decode(damaged, options).value();
        EXPECT_EQ(difference(some.volume, selected(whole.volume, options.selection)), "") << lost;
        EXPECT_EQ(some.report.records_skipped, 0U) << lost;
    }
}

// sound_records() returns the messages of a sound volume with half-degree radials, which tests then
// damage. Record 0 is the metadata; each of three cuts has six records of 120 radials.
constexpr unsigned sweeps = 3;
constexpr unsigned sweep_radials = 720;
constexpr std::size_t records_of_a_cut = 6;
constexpr std::array<float, sweeps> sweep_elevations_deg = {0.5F, 1.5F, 2.5F};

std::vector<wire::Bytes> sound_records() {
    std::vector<wire::Bytes> records = {wire::vcp_frame(212, sweep_elevations_deg)};
    const wire::Bytes messages = wire::radial_messages(sweeps, sweep_radials, 20);
    const std::size_t size = messages.size() / (sweeps * records_of_a_cut);
    for (std::size_t at = 0; at < messages.size(); at += size) {
        const auto part = std::span{messages}.subspan(at, size);
        records.emplace_back(part.begin(), part.end());
    }
    return records;
}

wire::Bytes file_of(const std::vector<wire::Bytes>& records) {
    wire::Bytes file = wire::archive_header();
    for (const wire::Bytes& messages : records)
        file = wire::join({file, wire::ldm_record(messages, &messages == &records.back(), 1)});
    return file;
}

// Decodes these cuts and compares them with the same cuts of the whole volume.
DecodeReport expect_cuts(const wire::Bytes& file, const std::vector<int>& cuts) {
    DecodeOptions options;
    options.selection.elevation_numbers = cuts;
    const auto some = decode(file, options).value();
    EXPECT_EQ(difference(some.volume, selected(decode(file).value().volume, options.selection)),
              "");
    return some.report;
}

TEST(SelectionReport, CountsEachSweepThatIsLeftOutOnce) {
    const wire::Bytes file = file_of(sound_records());
    const std::vector<std::vector<int>> choices = {{1},    {2},    {3},       {1, 2},
                                                   {1, 3}, {2, 3}, {1, 2, 3}, {99}};
    for (const std::vector<int>& cuts : choices) {
        const DecodeReport report = expect_cuts(file, cuts);
        const std::size_t left_out = cuts.front() == 99 ? sweeps : sweeps - cuts.size();
        EXPECT_EQ(report.sweeps_left_out, left_out) << cuts.front() << cuts.size();
        EXPECT_EQ(report.records_skipped > 0, left_out > 0) << cuts.front() << cuts.size();

        DecodeOptions options;
        options.selection.elevation_numbers = cuts;
        GrowingVolume growing{options};  // skips nothing
        ASSERT_TRUE(growing.append(file));
        EXPECT_EQ(growing.finish().value().report.sweeps_left_out, left_out) << cuts.front();
    }
}

// Metadata beside radials may change later sweeps, and skipped records may hold more metadata, so
// the plan is void.
TEST(SelectionPlan, IsVoidWhereMetadataStandBesideRadialsThatAreDecoded) {
    const std::array<float, sweeps> others_deg = {0.5F, 1.5F, 9.0F};
    const std::size_t first_of_cut_3 = 1 + 2 * records_of_a_cut;
    for (const wire::Bytes& extra : {wire::vcp_frame(215, others_deg), wire::archive_header()}) {
        for (const bool before : {true, false}) {
            for (const std::size_t at : {std::size_t{1}, first_of_cut_3}) {
                auto records = sound_records();
                wire::Bytes& record = records.at(at);
                record = before ? wire::join({extra, record}) : wire::join({record, extra});
                const DecodeReport report = expect_cuts(file_of(records), {3});
                EXPECT_EQ(report.records_skipped, 0U) << at << before << extra.size();
            }
        }
    }
}

// The volume takes the position of the radar from the first radial with a volume block, which a
// skipped record may hold.
TEST(SelectionPlan, IsVoidWhereTheFirstRecordHoldsNoVolumeBlock) {
    auto records = sound_records();
    const wire::Bytes name = wire::Writer{}.text("RVOL").bytes;
    const auto for_each_block = [&](wire::Bytes& record, std::size_t offset, char value) {
        for (auto at = record.begin();; ++at) {
            at = std::search(at, record.end(), name.begin(), name.end());
            if (at == record.end()) return;
            *(at + static_cast<std::ptrdiff_t>(offset)) = static_cast<std::byte>(value);
        }
    };
    for_each_block(records[1], 0, 'X');
    constexpr std::size_t site_height_low_byte = 17;
    for_each_block(records[2], site_height_low_byte, 1);
    EXPECT_EQ(expect_cuts(file_of(records), {3}).records_skipped, 0U);
}

// The file has as many records as a whole volume, but some are repeated and others lost.
TEST(SelectionPlan, IsVoidWhereARecordThatCameTwiceStandsForALostOne) {
    const auto sound = sound_records();
    const std::size_t cut_2 = 1 + records_of_a_cut, cut_3 = cut_2 + records_of_a_cut;
    auto restarted = sound;  // cut 1 comes again, cut 2 is lost
    std::copy_n(sound.begin() + 1, records_of_a_cut,
                restarted.begin() + static_cast<std::ptrdiff_t>(cut_2));
    auto repeated = sound;  // the last record of cut 1 comes again, the first of cut 2 is lost
    repeated[cut_2] = sound[cut_2 - 1];
    auto last_twice = sound;  // cut 3 comes twice, cut 2 is lost
    std::copy_n(sound.begin() + static_cast<std::ptrdiff_t>(cut_3), records_of_a_cut,
                last_twice.begin() + static_cast<std::ptrdiff_t>(cut_2));
    EXPECT_EQ(expect_cuts(file_of(restarted), {1}).records_skipped, 0U);
    EXPECT_EQ(expect_cuts(file_of(repeated), {1}).records_skipped, 0U);
    EXPECT_EQ(expect_cuts(file_of(last_twice), {3}).records_skipped, 0U);
}

TEST(SelectionPlan, IsVoidWhereThereAreMoreRecordsThanThePatternHas) {
    auto records = sound_records();
    records.push_back(wire::frame(2));
    EXPECT_EQ(expect_cuts(file_of(records), {3}).records_skipped, 0U);
}

}  // namespace
}  // namespace stormcellar::level2
