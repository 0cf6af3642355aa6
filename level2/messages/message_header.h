// level2/messages/message_header.h -- the 28 bytes at the head of every message, and whether they
// can be one.
//
// A message is 12 bytes of a channel terminal manager, which are not interpreted, then the header
// of ICD 2620002 table II. Message 31 (and 29) has the length that its header says; every other
// message stands in a frame of 2432 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace stormcellar::level2 {

inline constexpr std::size_t terminal_manager_bytes = 12;
inline constexpr std::size_t message_header_bytes = 28;  // the terminal manager's 12 included
inline constexpr std::size_t frame_bytes = 2432;
// The last day that a message is believed to be of: in 2079.
inline constexpr std::uint16_t latest_day = 40'000;

struct MessageHeader {
    std::uint16_t size_halfwords = 0;  // of the message, without the terminal manager's bytes
    std::uint8_t channel = 0;
    std::uint8_t type = 0;
    std::uint16_t sequence = 0;
    std::uint16_t date = 0;  // NEXRAD day number
    std::uint32_t ms = 0;    // after midnight
    std::uint16_t segments = 0;
    std::uint16_t segment = 0;

    [[nodiscard]] bool has_own_length() const { return type == 31 || type == 29; }
    // Bytes to the next message, terminal manager included.
    [[nodiscard]] std::size_t length_bytes() const;
};

// The header at the start of `bytes`, which must hold message_header_bytes.
[[nodiscard]] MessageHeader read_message_header(std::span<const std::byte> bytes);

// Whether the ICD names this type.
[[nodiscard]] bool is_known_message_type(int type);

// Whether the fields are within their ranges. True of every header in a good stream; also true of
// about one in a million random ones, so it proves little where the place is not known.
[[nodiscard]] bool is_plausible(const MessageHeader& header);

// Whether a message surely begins at the start of `bytes`: a plausible header, and a body whose own
// fields agree with it. Used where the place is not known, after damage.
inline constexpr std::size_t sure_message_bytes = 128;  // it never looks farther
[[nodiscard]] bool is_surely_message(std::span<const std::byte> bytes);

// Whether a radial's body (message 1 or 31) agrees with its header in time and range of numbers.
[[nodiscard]] bool is_credible_radial(const MessageHeader& header, std::span<const std::byte> body);
// What is odd about a radial that is not credible, each in a few words.
[[nodiscard]] std::vector<std::string_view> oddities_of(const MessageHeader& header,
                                                        std::span<const std::byte> body);

// Whether the message at the start of `bytes` is a radial that says where its gates lie as chance
// does not: for message 31 its pointers lie inside it, for message 1 counts and pointers fit into
// its frame. Name, date, time, numbers and angles do not count.
[[nodiscard]] bool places_its_gates(const MessageHeader& header, std::span<const std::byte> bytes);
// As above, and the length is beyond doubt: a frame's, or the one that message 31 itself gives
// (all that are known do). `message` is as long as the header says.
[[nodiscard]] bool is_firm_radial(const MessageHeader& header, std::span<const std::byte> message);

// The first place at or after `from` where a message surely begins.
[[nodiscard]] std::optional<std::size_t> find_message(std::span<const std::byte> bytes,
                                                      std::size_t from);

[[nodiscard]] bool all_zero(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
