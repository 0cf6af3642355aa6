// level2/messages/message_5.h -- reads the volume coverage pattern, message 5 or 7 (ICD 2620002,
// table XI).
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Bytes of a pattern before its cuts. Frames of old builds without a pattern have zeros there.
inline constexpr std::size_t vcp_header_bytes = 22;

// Reads a pattern. `body` is the message after its 28 bytes of header. Returns none if `body` holds
// no pattern, or fewer cuts than it counts.
[[nodiscard]] std::optional<Vcp> read_vcp(int message_type, std::span<const std::byte> body);

}  // namespace stormcellar::level2
