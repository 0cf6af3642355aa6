// level2/messages/message_header.h -- reads the 28 bytes at the head of every message, and
// recognizes such headers.
//
// A message begins with 12 bytes of the channel terminal manager, which are not interpreted, and
// the 16-byte header of ICD 2620002 table II. Messages 31 and 29 have the length that their header
// says. Every other message takes a frame of 2432 bytes.
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
// Largest day number in a plausible header; it is in 2079.
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

// Returns true if the fields are within their ranges. All headers in a good stream are plausible,
// but so is about one in a million random headers. So a plausible header proves little at an
// arbitrary place.
[[nodiscard]] bool is_plausible(const MessageHeader& header);

// Returns true if a message surely begins at the start of `bytes`, that is, if the header is
// plausible and the body or further rules confirm the header. The reader uses this to find messages
// after damage.
inline constexpr std::size_t sure_message_bytes = 128;  // is_surely_message() reads no more
[[nodiscard]] bool is_surely_message(std::span<const std::byte> bytes);

// Returns true if the date in the body of a radial (message 1 or 31) is at most a day from the date
// in the header, and the numbers in the body are within their ranges.
[[nodiscard]] bool is_credible_radial(const MessageHeader& header, std::span<const std::byte> body);
// Returns the reasons why a radial is not credible or its header not plausible, each in a few
// words.
[[nodiscard]] std::vector<std::string_view> oddities_of(const MessageHeader& header,
                                                        std::span<const std::byte> body);

// Returns true if the message at the start of `bytes` is a radial, and its pointers and gate counts
// fit into the message so well that this cannot be chance. Name, date, time, numbers and angles do
// not matter.
[[nodiscard]] bool places_its_gates(const MessageHeader& header, std::span<const std::byte> bytes);
// Returns true if `message` is a credible radial and its length is beyond doubt. It is either a
// message 1 with gate counts, or a message 31 whose body and header give the same length, as in all
// known files. `message` must be as long as its header says.
[[nodiscard]] bool is_firm_radial(const MessageHeader& header, std::span<const std::byte> message);

// Returns the first place at or after `from` where a message of type 1 to 31 surely begins, or
// none.
[[nodiscard]] std::optional<std::size_t> find_message(std::span<const std::byte> bytes,
                                                      std::size_t from);

[[nodiscard]] bool all_zero(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
