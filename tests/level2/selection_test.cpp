// Decoding only what is asked for gives that, and nothing else, of the whole decode.
#include "level2/selection.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/file_system.h"
#include "level2/decode.h"
#include "level2/encode.h"
#include "level2/ldm_framer.h"
#include "tests/level2/same_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

// What the selection leaves of a volume.
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
        options.selection = selection;
        options.threads = threads;
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
                         [](const auto& test) {
                             std::string name = test.param.file;
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return c == '.'; }, '_');
                             return name;
                         });

// A lost or a repeated record moves all that follow: nothing may be skipped then.
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

}  // namespace
}  // namespace stormcellar::level2
