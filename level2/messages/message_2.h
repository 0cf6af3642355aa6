// level2/messages/message_2.h -- the RDA's status, message 2 (ICD 2620002, table IV of every
// build).
//
// Does not hide or drop data because of what it says; a radial's own bad-data bit is in its status.
// Lengths: 40 halfwords up to build 17, 60 from 18 on; whatever a build lacks is none here.
// RDAs before the open one (2005 to 2006) have other contents in halfwords 6 and 10 to 15.
// Thread contract: pure functions and plain data.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "level2/messages/message_header.h"
#include "stormcellar/level2/rda_status.h"

namespace stormcellar::level2 {

// Open RDAs set bit 3 of the header's channel. TDWRs do not, but they came later.
[[nodiscard]] bool is_legacy_rda(const MessageHeader& header);

// `body` is the message after the 28 bytes of `header`, with the rest of its frame or without.
// None when the header or the bytes give less than the 40 halfwords of the oldest build.
[[nodiscard]] std::optional<RdaStatus> read_rda_status(const MessageHeader& header,
                                                       std::span<const std::byte> body);

}  // namespace stormcellar::level2
