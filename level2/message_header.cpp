#include "level2/message_header.h"

#include <algorithm>
#include <cmath>

#include "base/byte_reader.h"
#include "base/floating_point.h"
#include "base/station_table.h"

namespace stormcellar::level2 {
namespace {

constexpr std::uint32_t ms_per_day = 86'400'000;
constexpr std::uint32_t slack_ms = 1'000;      // leap seconds and clocks that overrun
constexpr std::uint16_t earliest_day = 7'305;  // 1990, before the first archived volume
constexpr std::uint16_t own_length_in_segments = 65'535;

// What follows a header of message 1 agrees with it (ICD 2620002 table III).
bool agrees_with_message_1(const MessageHeader& header, std::span<const std::byte> body) {
    ByteReader reader{body};
    const std::uint32_t ms = reader.u32();
    const std::uint16_t date = reader.u16();
    reader.skip(4);
    const std::uint16_t azimuth_number = reader.u16();
    const auto status = static_cast<std::uint16_t>(reader.u16() & 0x7FU);
    reader.skip(2);
    const std::uint16_t elevation_number = reader.u16();
    reader.skip(8);
    const std::uint16_t surveillance_gates = reader.u16();
    const std::uint16_t doppler_gates = reader.u16();
    if (reader.failed() || header.size_halfwords > (frame_bytes - terminal_manager_bytes) / 2) {
        return false;
    }
    const int days_apart = static_cast<int>(date) - static_cast<int>(header.date);
    return ms < ms_per_day + slack_ms && std::abs(days_apart) <= 1 && azimuth_number >= 1 &&
           azimuth_number <= 1000 && status <= 5 && elevation_number >= 1 &&
           elevation_number <= 40 && surveillance_gates <= 460 && doppler_gates <= 920;
}

// As above; zeros, which agree with many things, are no gates.
bool is_surely_message_1(const MessageHeader& header, std::span<const std::byte> body) {
    constexpr std::size_t gate_counts_at = 26;
    return agrees_with_message_1(header, body) && !all_zero(body.subspan(gate_counts_at, 4));
}

// What follows a header of message 31 agrees with it (ICD 2620002 table XVII-A).
bool is_surely_message_31(const MessageHeader& header, std::span<const std::byte> body) {
    ByteReader reader{body};
    const std::string_view icao = reader.text(4);
    const std::uint32_t ms = reader.u32();
    const std::uint16_t date = reader.u16();
    reader.skip(2);
    const float azimuth_deg = reader.f32();
    reader.skip(8);
    const float elevation_deg = reader.f32();
    reader.skip(2);
    const std::uint16_t blocks = reader.u16();
    if (reader.failed() || !is_icao(icao)) return false;
    const int days_apart = static_cast<int>(date) - static_cast<int>(header.date);
    return ms < ms_per_day + slack_ms && std::abs(days_apart) <= 1 &&
           is_within(azimuth_deg, 0.0F, 360.0F) && is_within(elevation_deg, -90.0F, 90.0F) &&
           blocks >= 1 && blocks <= 32;
}

// A frame of another kind: nothing in its body is fixed, so its header has to be beyond doubt.
bool is_surely_other_message(const MessageHeader& header, std::span<const std::byte> bytes) {
    const bool one_of_the_archived = header.type == 2 || header.type == 3 || header.type == 5 ||
                                     header.type == 13 || header.type == 15 || header.type == 18 ||
                                     header.type == 32;
    return one_of_the_archived && all_zero(bytes.first(terminal_manager_bytes)) &&
           header.segments <= 100 && header.size_halfwords >= 40;
}

// A clutter map or adaptation data as some radars of 2006 sent them: whole frames without a date.
// Nothing in a radial looks like that: zeros but for size, type and the numbers of the segments.
bool is_undated_frame(const MessageHeader& header, std::span<const std::byte> bytes) {
    const bool mapped = header.type == 13 || header.type == 15 || header.type == 18;
    return mapped && header.date == 0 && header.ms == 0 && header.segments >= 2 &&
           header.segments <= 100 && header.segment >= 1 && header.segment <= header.segments &&
           header.size_halfwords == (frame_bytes - terminal_manager_bytes - 4) / 2 &&
           all_zero(bytes.first(terminal_manager_bytes));
}

}  // namespace

std::size_t MessageHeader::length_bytes() const {
    if (!has_own_length()) return frame_bytes;
    if (size_halfwords == own_length_in_segments) {
        return terminal_manager_bytes + ((std::size_t{segments} << 16) | segment);
    }
    return terminal_manager_bytes + std::size_t{2} * size_halfwords;
}

MessageHeader read_message_header(std::span<const std::byte> bytes) {
    ByteReader reader{bytes};
    reader.skip(terminal_manager_bytes);
    MessageHeader header;
    header.size_halfwords = reader.u16();
    header.channel = reader.u8();
    header.type = reader.u8();
    header.sequence = reader.u16();
    header.date = reader.u16();
    header.ms = reader.u32();
    header.segments = reader.u16();
    header.segment = reader.u16();
    return header;
}

bool is_known_message_type(int type) {
    return (type >= 0 && type <= 18) || (type >= 20 && type <= 33);
}

bool is_plausible(const MessageHeader& header) {
    if (header.size_halfwords < 8 || header.ms >= ms_per_day + slack_ms ||
        header.date > latest_day) {
        return false;
    }
    if (header.has_own_length()) return true;
    if (header.size_halfwords > (frame_bytes - terminal_manager_bytes) / 2) return false;
    // Frames that fill up a group of segments count beyond its end.
    if (header.type == 0) return true;
    return header.segment >= 1 && header.segment <= header.segments;
}

bool is_surely_message(std::span<const std::byte> bytes) {
    if (bytes.size() < message_header_bytes) return false;
    const MessageHeader header = read_message_header(bytes);
    if (!is_plausible(header)) return false;
    if (header.date < earliest_day) return is_undated_frame(header, bytes);
    const auto body = bytes.subspan(message_header_bytes);
    if (header.type == 1) return is_surely_message_1(header, body);
    if (header.type == 31) return is_surely_message_31(header, body);
    return is_surely_other_message(header, bytes);
}

bool is_credible_radial(const MessageHeader& header, std::span<const std::byte> body) {
    return header.type == 1 ? agrees_with_message_1(header, body)
                            : is_surely_message_31(header, body);
}

bool is_firm_radial(const MessageHeader& header, std::span<const std::byte> message) {
    constexpr std::size_t length_at = 18;
    const auto body = message.subspan(message_header_bytes);
    if (header.type == 1) return is_surely_message_1(header, body);
    if (header.type != 31 || !is_surely_message_31(header, body)) return false;
    ByteReader reader{body};
    reader.seek(length_at);
    return reader.u16() == body.size();
}

std::optional<std::size_t> find_message(std::span<const std::byte> bytes, std::size_t from) {
    constexpr std::size_t type_at = terminal_manager_bytes + 3;
    for (std::size_t at = from; at + message_header_bytes <= bytes.size(); ++at) {
        const auto type = std::to_integer<unsigned>(bytes[at + type_at]);
        if (type == 0 || type > 31) continue;
        if (is_surely_message(bytes.subspan(at))) return at;
    }
    return std::nullopt;
}

bool all_zero(std::span<const std::byte> bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace stormcellar::level2
