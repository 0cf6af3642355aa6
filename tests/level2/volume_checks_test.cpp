#include "level2/decode/volume_checks.h"

#include <gtest/gtest.h>

namespace stormcellar::level2 {
namespace {

Volume volume_of(const std::vector<std::vector<int>>& azimuth_numbers) {
    Volume volume;
    volume.station = "KTLX";
    for (const auto& numbers : azimuth_numbers) {
        Sweep& sweep = volume.sweeps.emplace_back();
        sweep.elevation_number = static_cast<int>(volume.sweeps.size());
        for (const int number : numbers) {
            Radial& radial = sweep.radials.emplace_back();
            radial.azimuth_number = static_cast<std::uint16_t>(number);
        }
        sweep.radials.back().status = 2;
    }
    return volume;
}

struct Checked {
    bool missing = false;
    std::vector<std::string> messages;
};

Checked check(const Volume& volume, std::string_view code) {
    DecodeReport report;
    Checked outcome;
    outcome.missing = check_volume(volume, {}, ReportWriter{report});
    for (const Problem& problem : report.problems) {
        if (problem.code == code) outcome.messages.push_back(problem.message);
    }
    return outcome;
}

TEST(VolumeChecks, ASoundVolumeHasNoProblem) {
    DecodeReport report;
    EXPECT_FALSE(check_volume(volume_of({{1, 2, 3}, {1, 2}}), {}, ReportWriter{report}));
    EXPECT_TRUE(report.problems.empty());
}

TEST(VolumeChecks, LostRadialsAreCountedAndTheFirstIsNamed) {
    const Checked outcome = check(volume_of({{1, 2, 3}, {3, 4, 9}}), "missing_radials");
    EXPECT_TRUE(outcome.missing);
    EXPECT_EQ(outcome.messages, std::vector<std::string>{
                                    "sweep 1 (elevation number 2) lacks 6 radials, from number 1 "
                                    "on"});
}

TEST(VolumeChecks, MissingRadialsAreCountedBeyond32Bits) {
    std::vector<int> numbers;
    for (int i = 0; i < 5'000'000; ++i)
        numbers.push_back(i % 2 == 0 ? 1000 : 1);
    const Checked outcome = check(volume_of({numbers}), "missing_radials");
    EXPECT_TRUE(outcome.missing);
    EXPECT_EQ(outcome.messages.at(0).find('-'), std::string::npos) << outcome.messages.at(0);
}

TEST(VolumeChecks, NumbersThatNoRadarGivesAreNamedAndMissNothing) {
    const Checked outcome = check(volume_of({{65'535, 1, 2, 1001, 4}}), "odd_numbers");
    EXPECT_EQ(outcome.messages, std::vector<std::string>{"2 radials have a number above 1000"});
    EXPECT_TRUE(outcome.missing) << "number 3 is missing";
}

TEST(VolumeChecks, AVolumeThatIsGivenUpInsideAFileIsPartial) {
    Volume volume = volume_of({{1, 2}, {1, 2}, {1, 2}});
    volume.sweeps[1].elevation_number = 1;
    volume.sweeps[2].elevation_number = 2;
    volume.sweeps[2].radials.back().status = 4;
    DecodeReport report;
    EXPECT_TRUE(check_volume(volume, {.volume_starts = {1}}, ReportWriter{report}));
    Decoded decoded{volume, {}};
    decoded.report.further_volume_starts = {1};
    const std::vector<VolumePart> parts = volumes_in(decoded);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_FALSE(parts[0].complete);
    EXPECT_TRUE(parts[1].complete);
    EXPECT_EQ(parts[1].first_sweep, 1U);
}

TEST(VolumeChecks, TimesThatRunBackByHoursAreNamed) {
    Volume volume = volume_of({{1, 2, 3}, {1, 2, 3}});
    for (Sweep& sweep : volume.sweeps) {
        for (Radial& radial : sweep.radials)
            radial.time = UtcTime{std::chrono::hours{100'000}};
    }
    EXPECT_TRUE(check(volume, "times_run_back").messages.empty());
    volume.sweeps[1].radials[2].time -= std::chrono::minutes{59};
    EXPECT_TRUE(check(volume, "times_run_back").messages.empty());
    volume.sweeps[1].radials[2].time -= std::chrono::hours{3};
    EXPECT_EQ(
        check(volume, "times_run_back").messages,
        std::vector<std::string>{"the radials' times run back by up to 4.0 hours inside sweep 1"});
}

TEST(VolumeChecks, RadialsWithoutANumberAreNotMissed) {
    EXPECT_FALSE(check(volume_of({{0, 0, 0}}), "missing_radials").missing);
}

TEST(VolumeChecks, ARepeatedRecordIsNamed) {
    const Checked outcome = check(volume_of({{1, 2, 3, 2, 3, 4}}), "repeated_radials");
    EXPECT_FALSE(outcome.missing);
    EXPECT_EQ(outcome.messages.size(), 1U);
}

TEST(VolumeChecks, ManySweepsWithGapsAreSummedUp) {
    const Checked outcome =
        check(volume_of(std::vector<std::vector<int>>(50, {1, 3})), "missing_radials");
    EXPECT_EQ(outcome.messages.size(), 9U);
    EXPECT_EQ(outcome.messages.back(), "42 further sweeps lack 42 radials");
}

TEST(VolumeChecks, SweepsWithoutALastRadialAreNamed) {
    Volume volume = volume_of({{1, 2}, {1, 2}, {1, 2}, {1, 2}});
    for (Sweep& sweep : volume.sweeps)
        sweep.radials.back().status = 1;
    volume.sweeps[2].elevation_number = 2;  // the cut of sweep 1 began again
    volume.sweeps[3].elevation_number = 3;
    const Checked outcome = check(volume, "unended_sweeps");
    EXPECT_TRUE(outcome.missing);
    EXPECT_EQ(outcome.messages, std::vector<std::string>{"2 sweeps without a last radial: 0, 2"});
}

TEST(VolumeChecks, CutsThatAreMissingAreNamed) {
    Volume volume = volume_of({{1}, {1}, {1}, {1}});
    volume.sweeps[1].elevation_number = 3;
    volume.sweeps[2].elevation_number = 3;  // the cut began again
    volume.sweeps[3].elevation_number = 2;
    DecodeReport report;
    EXPECT_TRUE(check_volume(volume, {.volume_starts = {3}}, ReportWriter{report}));
    ASSERT_EQ(report.problems.size(), 3U);
    EXPECT_EQ(report.problems[2].code, "given_up");
    EXPECT_EQ(report.problems[0].message, "before sweep 1, cut 2 is missing");
    EXPECT_EQ(report.problems[1].message, "before sweep 3, cut 1 is missing");
    EXPECT_FALSE(check_volume(volume, {.all_cuts = false}, ReportWriter{report}));
}

TEST(VolumeChecks, WhatTheRadarReportsIsPassedOn) {
    RdaStatus status;
    DecodeReport report;
    EXPECT_FALSE(check_volume(volume_of({{1}}), {.status = status}, ReportWriter{report}));
    status.state = RdaState::standby;
    EXPECT_FALSE(check_volume(volume_of({{1}}), {.status = status}, ReportWriter{report}));
    ASSERT_FALSE(report.problems.empty());
    EXPECT_EQ(report.problems.back().code, "radar_trouble");
    EXPECT_NE(report.problems.back().message.find("standby"), std::string::npos);
}

}  // namespace
}  // namespace stormcellar::level2
