// level2/messages/message_header.h -- reads the 28 bytes at the head of every message, and checks
// whether bytes can be such a header.
//
// A message has 12 bytes of a channel terminal manager, which are not interpreted, then the header
// of ICD 2620002 table II. Message 31 (and 29) has the length that its header says. Every other
// message takes a frame of 2432 bytes.
//
// Threads   Plain values and pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace stormcellar::level2 {

inline constexpr std::size_t terminal_manager_bytes = 12;
inline constexpr std::size_t message_header_bytes = 28;  // including the terminal manager's 12
inline constexpr std::size_t frame_bytes = 2432;
// A message is not believed to be from a later day than this, which is in 2079.
inline constexpr std::uint16_t latest_day = 40'000;

struct MessageHeader {
    std::uint16_t size_halfwords = 0;  // of the message, without the bytes of the terminal manager
    std::uint8_t channel = 0;
    std::uint8_t type = 0;
    std::uint16_t sequence = 0;
    std::uint16_t date = 0;  // NEXRAD day number
    std::uint32_t ms = 0;    // after midnight
    std::uint16_t segments = 0;
    std::uint16_t segment = 0;

    [[nodiscard]] bool has_own_length() const { return type == 31 || type == 29; }
    // Returns the number of bytes to the next message, terminal manager included.
    [[nodiscard]] std::size_t length_bytes() const;
};

// Reads the header at the start of `bytes`, which must hold message_header_bytes.
[[nodiscard]] MessageHeader read_message_header(std::span<const std::byte> bytes);

// Returns true if the ICD has this type.
[[nodiscard]] bool is_known_message_type(int type);

// Returns true if the fields are within their ranges. This holds for every header in a good stream,
// but also for about one in a million random ones, so it proves little if the place is not known.
[[nodiscard]] bool is_plausible(const MessageHeader& header);

// Returns true if a message surely begins at the start of `bytes`: a plausible header, and a body
// whose own fields agree with it. It is used after damage, where the place is not known.
inline constexpr std::size_t sure_message_bytes = 128;  // it reads no farther than this
[[nodiscard]] bool is_surely_message(std::span<const std::byte> bytes);

// Returns true if the body of a radial (message 1 or 31) agrees with its header in time and its
// numbers are within their ranges.
[[nodiscard]] bool is_credible_radial(const MessageHeader& header, std::span<const std::byte> body);
// Returns the oddities of a radial that is not credible, each in a few words.
[[nodiscard]] std::vector<std::string_view> oddities_of(const MessageHeader& header,
                                                        std::span<const std::byte> body);

// Returns true if the message at the start of `bytes` is a radial that gives the places of its
// gates in a way that chance does not: for message 31 its pointers are inside it, for message 1
// counts and pointers fit into its frame. Name, date, time, numbers and angles do not count.
[[nodiscard]] bool places_its_gates(const MessageHeader& header, std::span<const std::byte> bytes);
// Does the same, but the length must also be beyond doubt: it is the length of a frame, or the
// length that message 31 itself gives (as all known ones do). `message` is as long as the header
// says.
[[nodiscard]] bool is_firm_radial(const MessageHeader& header, std::span<const std::byte> message);

// Returns the first place at or after `from` where a message surely begins.
[[nodiscard]] std::optional<std::size_t> find_message(std::span<const std::byte> bytes,
                                                      std::size_t from);

[[nodiscard]] bool all_zero(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
