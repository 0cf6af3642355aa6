// level2/messages/message_5.h -- the volume coverage pattern, message 5 or 7 (ICD 2620002, table
// XI).
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Type, number and count of the cuts stand in so many bytes; the frames of old builds that hold no
// pattern have zeros there.
inline constexpr std::size_t vcp_header_bytes = 22;

// `body` is the message after its 28 bytes of header. None when it holds no pattern or does not
// hold the cuts that it counts.
[[nodiscard]] std::optional<Vcp> read_vcp(int message_type, std::span<const std::byte> body);

}  // namespace stormcellar::level2
