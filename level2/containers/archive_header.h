// level2/containers/archive_header.h -- reads the 24-byte volume header before the first record
// (ICD 2620010, section 7.3.3).
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

inline constexpr std::size_t archive_header_bytes = 24;

// Reads the header at the start of `bytes`, which begins with "AR2V" or "ARCHIVE2" and a dot.
// Returns none if there is no header. If the ICAO is impossible (blanks, zeros), `icao` stays
// empty.
[[nodiscard]] std::optional<VolumeHeader> read_archive_header(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
