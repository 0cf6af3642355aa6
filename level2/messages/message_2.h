// level2/messages/message_2.h -- reads the status of the RDA, message 2 (ICD 2620002, table IV of
// every build).
//
// The status does not cause any data to be hidden or dropped; a radial has its own bad-data bit in
// its status. The message has 40 halfwords up to build 17 and 60 from build 18 on; fields that a
// build lacks are none here. RDAs before the Open RDA (2005 to 2006) have other contents in
// halfwords 6 and 10 to 15.
//
// Threads   Plain data and pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "level2/messages/message_header.h"
#include "stormcellar/level2/rda_status.h"

namespace stormcellar::level2 {

// Returns true for an RDA before the Open RDA. Open RDAs set bit 3 of the header's channel. TDWRs
// do not, but they came later.
[[nodiscard]] bool is_legacy_rda(const MessageHeader& header);

// Reads the status. `body` is the message after the 28 bytes of `header`, with or without the rest
// of its frame. Returns none if the header or the bytes have less than the 40 halfwords of the
// oldest build.
[[nodiscard]] std::optional<RdaStatus> read_rda_status(const MessageHeader& header,
                                                       std::span<const std::byte> body);

}  // namespace stormcellar::level2
