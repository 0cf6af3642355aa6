// level2/messages/radial_compression.h -- expands a message 31 whose data are compressed inside the
// message.
//
// By ICD 2620002 table XVII-A, the compression indicator (byte 16) is 0 for none, 1 for bzip2 and 2
// for zlib. The data header block, which is the table and its pointers, is never compressed. The
// radial length (bytes 18-19) and the pointers are for the uncompressed radial. No field gives the
// end of the data header block; it ends at the least pointer, where the first block begins. No
// archived volume is known to use compression.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace stormcellar::level2 {

// Returns the compression indicator of a message 31 from its body, which begins after the message
// header: 0 for none.
[[nodiscard]] int message_31_compression(std::span<const std::byte> body);

// Returns the uncompressed body, or the reason, in a few words, why the body cannot be expanded.
[[nodiscard]] tl::expected<std::vector<std::byte>, std::string_view> expand_message_31(
    std::span<const std::byte> body);

}  // namespace stormcellar::level2
