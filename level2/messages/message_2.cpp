#include "level2/messages/message_2.h"

#include <array>
#include <cstdlib>

#include "base/byte_reader.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t header_halfwords = 8;  // included in the size of the header
constexpr std::size_t least_halfwords = 40;
constexpr std::size_t most_halfwords = 60;
constexpr std::uint8_t open_rda_channel = 8;
constexpr std::uint16_t after_legacy_day = 13'515;  // 2007-01-01; legacy RDAs ran until 2006

// The halfwords of the message. Their numbers begin at 1, as in the ICD; missing halfwords are 0.
class Halfwords {
  public:
    explicit Halfwords(std::span<const std::byte> bytes) {
        ByteReader reader{bytes};
        const std::size_t count = std::min(bytes.size() / 2, most_halfwords);
        for (std::size_t i = 0; i < count; ++i)
            numbers_[i] = reader.u16();
    }
    std::uint16_t operator[](std::size_t number) const { return numbers_[number - 1]; }
    [[nodiscard]] std::int16_t as_signed(std::size_t number) const {
        return static_cast<std::int16_t>((*this)[number]);
    }
    [[nodiscard]] bool bit(std::size_t number, int bit) const {
        return (((*this)[number] >> bit) & 1) != 0;
    }

  private:
    std::array<std::uint16_t, most_halfwords> numbers_{};
};

// Returns the build from its number, which is in hundredths since build 11.2 and was in tenths
// before; note (6) of table IV tells the two apart.
float build_from(std::uint16_t number) {
    const auto build = static_cast<float>(number);
    return number > 200 ? build / 100 : build / 10;
}

std::optional<UtcTime> map_time(std::uint16_t day, std::uint16_t minutes) {
    if (day == 0) return std::nullopt;
    return time_from_nexrad(day, std::uint32_t{minutes} * 60'000U);
}

RdaMode mode_from(std::uint16_t code, bool legacy) {
    switch (code) {
        case 2:
            return legacy ? RdaMode::maintenance : RdaMode::test;
        case 4:
            return RdaMode::operational;
        case 8:
            return legacy ? RdaMode::unknown : RdaMode::maintenance;
        default:
            return RdaMode::unknown;
    }
}

void read_alarms(RdaStatus& status, const Halfwords& halfword) {
    constexpr std::size_t first = 27, last = 40;
    constexpr std::uint16_t cleared = 0x8000;
    for (std::size_t i = first; i <= last; ++i) {
        const auto code = static_cast<std::uint16_t>(halfword[i] & ~cleared);
        if (code != 0) status.alarms.push_back({code, (halfword[i] & cleared) != 0});
    }
}

void read_legacy_fields(RdaStatus& status, const Halfwords& halfword) {
    status.horizontal_correction_db = static_cast<float>(halfword.as_signed(6)) / 4;
    status.interference_pulses_per_s = halfword[10];
    status.interference_suppression = halfword[12] == 2;
    status.recorder = halfword[13];
    status.recorder_volumes_left = halfword[14];
}

void read_open_fields(RdaStatus& status, const Halfwords& halfword) {
    const float build = build_from(halfword[10]);
    status.build = build;
    status.horizontal_correction_db = static_cast<float>(halfword.as_signed(6)) / 100;
    if (build >= 10) {
        status.super_resolution = halfword.bit(12, 1);
        status.clutter_decision = halfword.bit(13, 0);
        status.clutter_decision_segments = static_cast<std::uint8_t>((halfword[13] >> 1) & 0x1F);
    }
    if (build >= 11) status.avset = halfword.bit(14, 1);
    // The ICD of build 13 calls this halfword spare, but the build sends the number.
    if (build >= 13)
        status.vertical_correction_db = static_cast<float>(halfword.as_signed(23)) / 100;
    if (build >= 14) status.performance_check = halfword[26];
    if (build >= 18) status.elevation_correction = halfword.bit(14, 3);
    if (build >= 19) status.log_data = halfword.bit(14, 4);
    if (build >= 21) status.time_series_recording = halfword.bit(14, 5);
}

// Reads halfwords 41 to 60. Builds without these halfwords, and build 18, where they are spare,
// give zeros.
void read_late_fields(RdaStatus& status, const Halfwords& halfword) {
    if (halfword[60] == 0) return;
    status.version = halfword[60];
    status.rho_hv_test = halfword.bit(41, 0);
    if (halfword[59] != 0) status.downloaded_vcp = halfword[59];
}

}  // namespace

bool is_legacy_rda(const MessageHeader& header) {
    return (header.channel & open_rda_channel) == 0 && header.date < after_legacy_day;
}

std::optional<RdaStatus> read_rda_status(const MessageHeader& header,
                                         std::span<const std::byte> body) {
    if (header.size_halfwords < header_halfwords) return std::nullopt;
    const std::size_t size = 2 * (header.size_halfwords - header_halfwords);
    body = body.first(std::min(body.size(), size));
    if (body.size() < 2 * least_halfwords) return std::nullopt;

    const Halfwords halfword{body};
    RdaStatus status;
    status.legacy = is_legacy_rda(header);
    status.state = static_cast<RdaState>(halfword[1]);
    status.operability = halfword[2];
    status.control = halfword[3];
    status.power = halfword[4];
    status.transmitter_w = halfword[5];
    status.data_enabled = halfword[7];
    status.vcp = std::abs(int{halfword.as_signed(8)});
    status.vcp_is_local = halfword.as_signed(8) < 0;
    status.control_request = halfword[9];
    status.mode = mode_from(halfword[11], status.legacy);
    status.alarm_summary = halfword[15];
    status.acknowledged = halfword[16];
    status.controlling_channel = halfword[17] == 0;
    status.spot_blanking = halfword[18];
    status.bypass_map_time = map_time(halfword[19], halfword[20]);
    status.clutter_map_time = map_time(halfword[21], halfword[22]);
    status.transition_power = halfword[24];
    status.rms_control = halfword[25];
    read_alarms(status, halfword);
    if (status.legacy) {
        read_legacy_fields(status, halfword);
    } else {
        read_open_fields(status, halfword);
        read_late_fields(status, halfword);
    }
    return status;
}

}  // namespace stormcellar::level2
