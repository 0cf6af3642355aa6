#include "level2/messages/message_header.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/byte_reader.h"
#include "base/floating_point.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

constexpr std::uint32_t ms_per_day = 86'400'000;
constexpr std::uint32_t slack_ms = 1'000;      // for leap seconds and clocks that overrun
constexpr std::uint16_t earliest_day = 7'305;  // 1990, before the first archived volume
constexpr std::uint16_t own_length_in_segments = 65'535;

// The fields at the head of a message 1 (ICD 2620002 table III).
struct Start1 {
    std::uint32_t ms = 0;
    std::uint16_t date = 0;
    std::uint16_t azimuth_number = 0;
    std::uint16_t status = 0;
    std::uint16_t elevation_number = 0;
    std::uint16_t surveillance_gates = 0;
    std::uint16_t doppler_gates = 0;
    std::array<std::uint16_t, 3> pointers{};  // REF, VEL, SW
};
constexpr std::uint16_t most_surveillance_gates = 460;
constexpr std::uint16_t most_doppler_gates = 920;
constexpr std::size_t gate_counts_at = 26;  // of message 1, after its header
constexpr std::size_t start_1_bytes = 100;  // before the gates, in all known messages
constexpr std::size_t frame_body_bytes = frame_bytes - message_header_bytes;

std::optional<Start1> read_start_1(std::span<const std::byte> body) {
    ByteReader reader{body};
    Start1 start;
    start.ms = reader.u32();
    start.date = reader.u16();
    reader.skip(4);
    start.azimuth_number = reader.u16();
    start.status = static_cast<std::uint16_t>(reader.u16() & 0x7FU);
    reader.skip(2);
    start.elevation_number = reader.u16();
    reader.skip(8);
    start.surveillance_gates = reader.u16();
    start.doppler_gates = reader.u16();
    reader.skip(6);
    for (std::uint16_t& pointer : start.pointers)
        pointer = reader.u16();
    if (reader.failed()) return std::nullopt;
    return start;
}

// The fields at the head of a message 31 (ICD 2620002 table XVII-A).
struct Start31 {
    std::string_view icao;
    std::uint32_t ms = 0;
    std::uint16_t date = 0;
    float azimuth_deg = 0;
    std::uint8_t compression = 0;
    std::uint16_t length = 0;  // length of the uncompressed radial
    float elevation_deg = 0;
    std::uint16_t blocks = 0;
};
constexpr std::size_t pointers_of_31_at = 32;  // of message 31, after its header
constexpr std::uint16_t most_known_blocks = 32;

std::optional<Start31> read_start_31(std::span<const std::byte> body) {
    ByteReader reader{body};
    Start31 start;
    start.icao = reader.text(4);
    start.ms = reader.u32();
    start.date = reader.u16();
    reader.skip(2);
    start.azimuth_deg = reader.f32();
    start.compression = reader.u8();
    reader.skip(1);
    start.length = reader.u16();
    reader.skip(4);
    start.elevation_deg = reader.f32();
    reader.skip(2);
    start.blocks = reader.u16();
    if (reader.failed()) return std::nullopt;
    return start;
}

bool are_near(std::uint16_t day, std::uint16_t other) {
    return std::abs(static_cast<int>(day) - static_cast<int>(other)) <= 1;
}

// One check of a field: it must agree with the message header or be within its range.
struct Check {
    bool holds = true;
    std::string_view oddity;
};

std::array<Check, 7> checks_of_1(const MessageHeader& header, const Start1& start) {
    return {{
        {header.size_halfwords <= (frame_bytes - terminal_manager_bytes) / 2,
         "radials claim to be longer than their frame"},
        {start.ms < ms_per_day + slack_ms, "radials have a time beyond the end of the day"},
        {are_near(start.date, header.date), "radials have another date than their headers"},
        {start.azimuth_number >= 1 && start.azimuth_number <= 1000,
         "radials have a number that is not within 1 and 1000"},
        {start.status <= 5, "radials have a status that no ICD has"},
        {start.elevation_number >= 1 && start.elevation_number <= 40,
         "radials have an elevation number that is not within 1 and 40"},
        {start.surveillance_gates <= most_surveillance_gates &&
             start.doppler_gates <= most_doppler_gates,
         "radials count more gates than an ICD allows"},
    }};
}

std::array<Check, 6> checks_of_31(const MessageHeader& header, const Start31& start) {
    return {{
        {icao_of(start.icao).has_value(), "radials name no station"},
        {start.ms < ms_per_day + slack_ms, "radials have a time beyond the end of the day"},
        {are_near(start.date, header.date), "radials have another date than their headers"},
        {is_within(start.azimuth_deg, 0.0F, 360.0F), "radials have an impossible azimuth"},
        {is_within(start.elevation_deg, -90.0F, 90.0F), "radials have an impossible elevation"},
        {start.blocks >= 1 && start.blocks <= most_known_blocks,
         "radials have a number of blocks that is not within 1 and 32"},
    }};
}

template <std::size_t n>
bool all_hold(const std::array<Check, n>& checks) {
    return std::ranges::all_of(checks, &Check::holds);
}

template <std::size_t n>
std::vector<std::string_view> oddities_in(const std::array<Check, n>& checks) {
    std::vector<std::string_view> oddities;
    for (const Check& check : checks) {
        if (!check.holds) oddities.push_back(check.oddity);
    }
    return oddities;
}

bool agrees_with_message_1(const MessageHeader& header, std::span<const std::byte> body) {
    const auto start = read_start_1(body);
    return start && all_hold(checks_of_1(header, *start));
}

// Returns true if agrees_with_message_1() does and a gate count is not zero. Zeros prove nothing,
// because they occur in many places.
bool is_surely_message_1(const MessageHeader& header, std::span<const std::byte> body) {
    return agrees_with_message_1(header, body) && !all_zero(body.subspan(gate_counts_at, 4));
}

bool is_surely_message_31(const MessageHeader& header, std::span<const std::byte> body) {
    const auto start = read_start_31(body);
    return start && all_hold(checks_of_31(header, *start));
}

bool places_gates_of_1(const MessageHeader& header, std::span<const std::byte> body) {
    const auto start = read_start_1(body);
    if (!start || header.size_halfwords > (frame_bytes - terminal_manager_bytes) / 2) return false;
    if (start->surveillance_gates > most_surveillance_gates ||
        start->doppler_gates > most_doppler_gates) {
        return false;
    }
    // Each moment begins where the previous one ends, or at the next even byte.
    std::size_t end = start_1_bytes;
    for (std::size_t i = 0; i < start->pointers.size(); ++i) {
        const std::size_t pointer = start->pointers.at(i);
        const std::size_t gates = i == 0 ? start->surveillance_gates : start->doppler_gates;
        if (pointer == 0 || gates == 0) continue;
        if (pointer != end && pointer != end + end % 2) return false;
        end = pointer + gates;
    }
    return end > start_1_bytes && end <= frame_body_bytes;
}

bool places_gates_of_31(const MessageHeader& header, std::span<const std::byte> body) {
    const auto start = read_start_31(body);
    if (!start || start->blocks < 1 || start->blocks > most_known_blocks) return false;
    const std::size_t least = pointers_of_31_at + sizeof(std::uint32_t) * start->blocks;
    std::size_t end = header.length_bytes() - message_header_bytes;
    if (start->compression != 0) end = std::max<std::size_t>(end, start->length);
    ByteReader reader{body};
    reader.seek(pointers_of_31_at);
    bool any = false;
    for (std::uint16_t i = 0; i < start->blocks; ++i) {
        const std::uint32_t pointer = reader.u32();
        if (reader.failed()) break;  // `bytes` may end before the pointers do
        if (pointer == 0) continue;
        if (pointer < least || pointer >= end) return false;
        any = true;
    }
    return any;
}

// Checks a frame that is no radial by stricter rules for its header, because nothing in its body is
// fixed.
bool is_surely_other_message(const MessageHeader& header, std::span<const std::byte> bytes) {
    const bool one_of_the_archived = header.type == 2 || header.type == 3 || header.type == 5 ||
                                     header.type == 13 || header.type == 15 || header.type == 18 ||
                                     header.type == 32;
    return one_of_the_archived && all_zero(bytes.first(terminal_manager_bytes)) &&
           header.segments <= 100 && header.size_halfwords >= 40;
}

// Recognizes a frame of a clutter map or adaptation data without a date, as some radars sent them
// in 2006. The header of such a frame is zero except for size, type, sequence and segments. The
// header of a radial always has a date.
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
    // Fill frames may have a segment number beyond the number of segments.
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

std::vector<std::string_view> oddities_of(const MessageHeader& header,
                                          std::span<const std::byte> body) {
    std::vector<std::string_view> oddities;
    if (header.type == 1) {
        if (const auto start = read_start_1(body)) {
            oddities = oddities_in(checks_of_1(header, *start));
        }
    } else if (const auto start = read_start_31(body)) {
        oddities = oddities_in(checks_of_31(header, *start));
    }
    if (!is_plausible(header)) oddities.push_back("radials have an impossible message header");
    return oddities;
}

bool places_its_gates(const MessageHeader& header, std::span<const std::byte> bytes) {
    if (header.length_bytes() <= message_header_bytes || bytes.size() < message_header_bytes) {
        return false;
    }
    const auto body = bytes.subspan(message_header_bytes);
    if (header.type == 1) return places_gates_of_1(header, body);
    return header.type == 31 && places_gates_of_31(header, body);
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
