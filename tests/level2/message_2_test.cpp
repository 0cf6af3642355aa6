#include "level2/messages/message_2.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "level2/containers/archive_header.h"
#include "level2/containers/gzip_stream.h"
#include "level2/containers/ldm_framer.h"
#include "stormcellar/base/file_system.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

constexpr unsigned open_channel = 8, legacy_channel = 0;
constexpr unsigned legacy_day = 13'013;           // 2005-08-17
using Numbers = std::map<std::size_t, unsigned>;  // by the number of the halfword in the ICD

// Returns the halfwords of a radar that operates without trouble and sends everything.
Numbers healthy() {
    return {{1, 16}, {2, 2}, {3, 4}, {4, 2}, {5, 1066}, {7, 28}, {8, 212}, {11, 4}, {24, 3}};
}

MessageHeader header_of(std::size_t halfwords, unsigned channel = open_channel,
                        unsigned day = wire::day) {
    MessageHeader header;
    header.type = 2;
    header.size_halfwords = static_cast<std::uint16_t>(halfwords + 8);
    header.channel = static_cast<std::uint8_t>(channel);
    header.date = static_cast<std::uint16_t>(day);
    return header;
}

wire::Bytes body_of(const Numbers& numbers, std::size_t halfwords) {
    wire::Bytes body(2 * halfwords);
    for (const auto& [halfword, number] : numbers) {
        if (halfword <= halfwords) wire::overwrite_u16(body, 2 * (halfword - 1), number);
    }
    return body;
}

RdaStatus status_of(const Numbers& numbers, std::size_t halfwords = 40,
                    unsigned channel = open_channel, unsigned day = wire::day) {
    const auto status =
        read_rda_status(header_of(halfwords, channel, day), body_of(numbers, halfwords));
    return status.value();
}

using Phrases = std::vector<std::string>;

TEST(Message2, SixtyHalfwordsAreReadFieldByField) {
    Numbers numbers = healthy();
    for (const auto& [halfword, number] :
         Numbers{{3, 8},       {6, 65460}, {9, 4},   {10, 2310}, {12, 2},      {13, 0b10'1011},
                 {14, 58},     {16, 3},    {17, 1},  {18, 2},    {19, 20'541}, {20, 1208},
                 {21, 20'531}, {22, 79},   {23, 80}, {25, 4},    {26, 2},      {27, 431},
                 {40, 32'974}, {41, 1},    {59, 35}, {60, 11}}) {
        numbers[halfword] = number;
    }
    const RdaStatus status = status_of(numbers, 60);
    EXPECT_FALSE(status.legacy);
    EXPECT_EQ(status.state, RdaState::operate);
    EXPECT_EQ(status.operability, rda_operability::on_line);
    EXPECT_EQ(status.control, 8);
    EXPECT_EQ(status.power, rda_power::utility_power_available);
    EXPECT_EQ(status.transmitter_w, 1066);
    EXPECT_FLOAT_EQ(status.horizontal_correction_db, -0.76F);
    EXPECT_FLOAT_EQ(status.vertical_correction_db.value(), 0.8F);
    EXPECT_EQ(status.data_enabled, 28);
    EXPECT_EQ(status.vcp, 212);
    EXPECT_FALSE(status.vcp_is_local);
    EXPECT_EQ(status.control_request, 4);
    EXPECT_FLOAT_EQ(status.build.value(), 23.1F);
    EXPECT_EQ(status.mode, RdaMode::operational);
    EXPECT_EQ(status.super_resolution, true);
    EXPECT_EQ(status.clutter_decision, true);
    EXPECT_EQ(status.clutter_decision_segments, 0b10101);
    EXPECT_EQ(status.avset, true);
    EXPECT_EQ(status.elevation_correction, true);
    EXPECT_EQ(status.log_data, true);
    EXPECT_EQ(status.time_series_recording, true);
    EXPECT_EQ(status.rho_hv_test, true);
    EXPECT_EQ(status.performance_check, 2);
    EXPECT_EQ(status.downloaded_vcp, 35);
    EXPECT_EQ(status.version, 11);
    EXPECT_EQ(status.acknowledged, 3);
    EXPECT_FALSE(status.controlling_channel);
    EXPECT_EQ(status.spot_blanking, 2);
    EXPECT_EQ(format_utc(status.bypass_map_time.value()), "2026-03-28T20:08:00Z");
    EXPECT_EQ(format_utc(status.clutter_map_time.value()), "2026-03-18T01:19:00Z");
    EXPECT_EQ(status.transition_power, 3);
    EXPECT_EQ(status.rms_control, 4);
    ASSERT_EQ(status.alarms.size(), 2);
    EXPECT_EQ(status.alarms[0].code, 431);
    EXPECT_FALSE(status.alarms[0].cleared);
    EXPECT_EQ(status.alarms[1].code, 206);
    EXPECT_TRUE(status.alarms[1].cleared);
    EXPECT_FALSE(status.interference_pulses_per_s);
    EXPECT_EQ(rda_troubles(status), Phrases{"alarm 431"});
}

TEST(Message2, EachBuildHasItsFields) {
    const auto of_build = [](unsigned number, std::size_t halfwords) {
        Numbers numbers = healthy();
        numbers[10] = number;
        numbers[14] = 4;
        return status_of(numbers, halfwords);
    };
    const RdaStatus build_9 = of_build(90, 40);
    EXPECT_FLOAT_EQ(build_9.build.value(), 9.0F) << "before build 11.2, the number is in tenths";
    EXPECT_FALSE(build_9.super_resolution);
    EXPECT_FALSE(build_9.avset);
    EXPECT_FALSE(build_9.vertical_correction_db);
    const RdaStatus build_11 = of_build(1140, 40);
    EXPECT_FLOAT_EQ(build_11.build.value(), 11.4F);
    EXPECT_EQ(build_11.super_resolution, false);
    EXPECT_EQ(build_11.avset, false);
    EXPECT_FALSE(build_11.performance_check);
    const RdaStatus build_17 = of_build(1720, 40);
    EXPECT_EQ(build_17.vertical_correction_db, 0.0F);
    EXPECT_TRUE(build_17.performance_check);
    EXPECT_FALSE(build_17.elevation_correction);
    EXPECT_FALSE(build_17.version);
    const RdaStatus build_18 = of_build(1800, 60);
    EXPECT_EQ(build_18.elevation_correction, false);
    EXPECT_FALSE(build_18.log_data);
    EXPECT_FALSE(build_18.rho_hv_test) << "in build 18, halfwords 41 to 60 are spare";
    EXPECT_EQ(of_build(1900, 60).log_data, false);
    EXPECT_FALSE(of_build(1900, 60).time_series_recording);
    EXPECT_EQ(of_build(2110, 60).time_series_recording, false);
}

TEST(Message2, LegacyRadarHasOtherFields) {
    Numbers numbers = healthy();
    for (const auto& [halfword, number] : Numbers{
             {6, 0xFFFE}, {10, 113}, {11, 2}, {12, 2}, {13, 20'513}, {14, 340}, {15, 256 + 16}}) {
        numbers[halfword] = number;
    }
    const RdaStatus status = status_of(numbers, 40, legacy_channel, legacy_day);
    EXPECT_TRUE(status.legacy);
    EXPECT_FLOAT_EQ(status.horizontal_correction_db, -0.5F) << "the number is in quarters of a dB";
    EXPECT_FALSE(status.build);
    EXPECT_FALSE(status.super_resolution);
    EXPECT_EQ(status.mode, RdaMode::maintenance);
    EXPECT_EQ(status.interference_pulses_per_s, 113);
    EXPECT_EQ(status.interference_suppression, true);
    EXPECT_EQ(status.recorder, 20'513);
    EXPECT_EQ(status.recorder_volumes_left, 340);
    EXPECT_EQ(
        rda_troubles(status),
        (Phrases{"maintenance mode", "receiver or signal processor alarm", "recorder alarm"}));
}

TEST(Message2, ChannelAndDayTellLegacyRadarsFromTdwrs) {
    EXPECT_TRUE(is_legacy_rda(header_of(40, legacy_channel, legacy_day)));
    EXPECT_TRUE(is_legacy_rda(header_of(40, 2, legacy_day))) << "channel 2 of a redundant pair";
    EXPECT_FALSE(is_legacy_rda(header_of(40, 10, legacy_day)));
    EXPECT_FALSE(is_legacy_rda(header_of(40, 2))) << "the header is of a TDWR of 2022";
}

TEST(Message2, TroublesAreListedTheWorstFirst) {
    EXPECT_TRUE(rda_troubles(status_of(healthy())).empty());
    Numbers numbers = healthy();
    for (const auto& [halfword, number] : Numbers{
             {1, 2}, {2, 2 + 8 + 1}, {4, 5}, {7, 4}, {11, 8}, {15, 2 + 128}, {24, 1}, {27, 398}}) {
        numbers[halfword] = number;
    }
    EXPECT_EQ(rda_troubles(status_of(numbers)),
              (Phrases{"starting up", "maintenance mandatory", "automatic calibration off",
                       "maintenance mode", "velocity off", "spectrum width off",
                       "tower or utilities alarm", "signal processor alarm", "alarm 398",
                       "on auxiliary power", "transition power source off"}));
    numbers = healthy();
    numbers[1] = 3;
    EXPECT_EQ(rda_troubles(status_of(numbers)), Phrases{"state 3 is unknown"});
}

TEST(Message2, PatternChosenAtTheRadarIsNegative) {
    Numbers numbers = healthy();
    numbers[8] = 65'515;
    EXPECT_EQ(status_of(numbers).vcp, 21);
    EXPECT_TRUE(status_of(numbers).vcp_is_local);
}

TEST(Message2, CutBodiesAreNoStatus) {
    const wire::Bytes body = body_of(healthy(), 60);
    for (std::size_t size = 0; size <= body.size(); ++size) {
        EXPECT_EQ(read_rda_status(header_of(60), std::span{body}.first(size)).has_value(),
                  size >= 80)
            << size;
    }
    EXPECT_FALSE(read_rda_status(header_of(39), body));
    EXPECT_FALSE(read_rda_status(MessageHeader{}, body)) << "a size less than the header's own";
}

TEST(Message2, NothingBehindTheHeadersSizeIsRead) {
    Numbers numbers = healthy();
    numbers[10] = 1900;
    numbers[60] = 9;
    const wire::Bytes body = body_of(numbers, 1200);
    EXPECT_FALSE(read_rda_status(header_of(40), body)->version);
    EXPECT_EQ(read_rda_status(header_of(60), body)->version, 9);
    EXPECT_EQ(read_rda_status(header_of(1200), body)->version, 9);
}

// --- Real volumes ---

std::vector<RdaStatus> statuses_in(std::span<const std::byte> messages) {
    std::vector<RdaStatus> statuses;
    while (messages.size() >= message_header_bytes) {
        const MessageHeader header = read_message_header(messages);
        const std::size_t length = header.length_bytes();
        if (length < message_header_bytes || length > messages.size()) break;
        if (header.type == 2) {
            auto status = read_rda_status(header, messages.first(length).subspan(28));
            EXPECT_TRUE(status);
            if (status) statuses.push_back(std::move(*status));
        }
        messages = messages.subspan(length);
    }
    return statuses;
}

// Returns the statuses in a file of messages, or in the first LDM record of a file, which holds the
// metadata.
std::vector<RdaStatus> statuses_of_file(const std::string& name) {
    const wire::Bytes file = without_gzip(read_file(*testing::data_directory() / name).value());
    const auto content = std::span{file}.subspan(read_archive_header(file) ? 24 : 0);
    if (!is_ldm_record(content)) return statuses_in(content);
    LdmFramer framer(file);
    auto part = framer.next();
    while (part && part->kind != LdmPart::Kind::record)
        part = framer.next();
    if (!part) return {};
    return statuses_in(wire::unpack_bzip2(part->bytes));
}

struct RealStatus {
    const char* file;
    std::size_t count;
    float build;  // 0: legacy
    int vcp;      // as in the golden file
    std::uint16_t version;
    Phrases troubles = {};                      // of the first status
    std::optional<Phrases> last_troubles = {};  // of the last status; none: the same
};

TEST(Message2, RealVolumesSayWhatTheyShould) {
    STORMCELLAR_NEED_DATA();
    const std::vector<RealStatus> expected = {
        {"volumes/KTLX19910720_160529.gz",
         1,
         0,
         21,
         0,
         {"maintenance mandatory", "transmitter alarm"}},
        {"volumes/KTLX19990503_235621.gz", 2, 0, 11, 0, {"on auxiliary power"}},
        {"volumes/KLVX20050106_163401.gz",
         2,
         0,
         21,
         0,
         {"maintenance required", "tower or utilities alarm"}},
        {"sequence-kbgm/KBGM20050822_024414.gz", 1, 0, 21, 0},
        {"volumes/KOKX20080109_141449.gz",
         3,
         9.0F,
         212,
         0,
         {"maintenance mandatory", "receiver alarm"}},
        {"mosaic-northeast/KDOX20100911_012056_V04.gz",
         5,
         11.4F,
         32,
         0,
         {"maintenance mandatory", "tower or utilities alarm", "RDA control alarm"}},
        {"volumes/Level2_KFTG_20150430_1419.ar2v", 1, 15.0F, 212, 0},
        {"volumes/KIWX20160429_194300_V06.gz",
         7,
         16.1F,
         21,
         0,
         {"maintenance required", "tower or utilities alarm"},
         Phrases{"starting up", "maintenance mandatory", "reflectivity off", "velocity off",
                 "spectrum width off", "tower or utilities alarm", "transmitter alarm",
                 "receiver alarm"}},
        {"volumes/KCRP20170826_044114.trimmed.ar2v", 1, 17.2F, 212, 0, {"on auxiliary power"}},
        {"volumes/KLOT20220317_000842_V06", 1, 20.1F, 35, 9},
        {"volumes/Level2_TSTL_20220213_2357.ar2v", 1, 2.0F, 90, 0},
        {"volumes/KDMX20250101_225441_V06", 1, 22.1F, 31, 10},
    };
    for (const RealStatus& volume : expected) {
        SCOPED_TRACE(volume.file);
        const std::vector<RdaStatus> statuses = statuses_of_file(volume.file);
        ASSERT_EQ(statuses.size(), volume.count);
        const RdaStatus& first = statuses.front();
        EXPECT_EQ(first.legacy, volume.build == 0);
        EXPECT_FLOAT_EQ(first.build.value_or(0), volume.build);
        EXPECT_EQ(first.state, RdaState::operate);
        EXPECT_EQ(first.mode, RdaMode::operational);
        EXPECT_EQ(first.vcp, volume.vcp);
        EXPECT_EQ(first.version.value_or(0), volume.version);
        EXPECT_LE(std::abs(first.horizontal_correction_db), 3);
        EXPECT_LE(std::abs(first.vertical_correction_db.value_or(0)), 3);
        EXPECT_EQ(rda_troubles(first), volume.troubles);
        EXPECT_EQ(rda_troubles(statuses.back()), volume.last_troubles.value_or(volume.troubles));
    }
}

}  // namespace
}  // namespace stormcellar::level2
