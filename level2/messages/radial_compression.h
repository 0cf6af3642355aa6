// level2/messages/radial_compression.h -- message 31 whose data are compressed inside the message.
//
// ICD 2620002 table XVII-A: the compression indicator (byte 16) is 0 for none, 1 for bzip2, 2 for
// zlib; the data header block, which is the table and its pointers, is never compressed; the
// radial length (bytes 18-19) and the pointers are those of the whole radial, uncompressed. Where
// the header ends no field says: it ends where the first block begins, which is the least pointer.
// No archived volume is known that uses it.
// Thread contract: functions are pure.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace stormcellar::level2 {

// The "compression indicator" of a message 31 (its body, behind the message header): 0 for none.
[[nodiscard]] int message_31_compression(std::span<const std::byte> body);

// The body as it would be uncompressed; else the reason, in a few words, why it cannot be had.
[[nodiscard]] tl::expected<std::vector<std::byte>, std::string_view> expand_message_31(
    std::span<const std::byte> body);

}  // namespace stormcellar::level2
