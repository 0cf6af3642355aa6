// level2/messages/message_2.h -- reads the status of the RDA, message 2 (ICD 2620002, table IV of
// every build).
//
// The decoder drops no data because of this status; a radial marks bad data in its own status. The
// message has 40 halfwords up to build 17 and 60 from build 18 on; optional members are none if the
// build lacks their halfwords. Legacy RDAs, which the Open RDA replaced in 2005 and 2006, have
// other contents in halfwords 6 and 10 to 15.
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
// do not set it, but their volumes have later dates than legacy volumes.
[[nodiscard]] bool is_legacy_rda(const MessageHeader& header);

// Reads the status. `body` is the message after the 28 bytes of `header`; it may include the rest
// of the frame. Returns none if `header` counts, or `body` holds, less than the 40 halfwords of the
// oldest build.
[[nodiscard]] std::optional<RdaStatus> read_rda_status(const MessageHeader& header,
                                                       std::span<const std::byte> body);

}  // namespace stormcellar::level2
