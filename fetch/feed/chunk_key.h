// fetch/feed/chunk_key.h -- the keys of the public chunk bucket:
// SITE/VOLUME/YYYYMMDD-HHMMSS-NNN-S|I|E.
//
// A key is also the path of the chunk below the drop directory, as LDM would name it. So only keys
// of exactly this form are accepted: the name of a station, a volume number from 1 to 999 without
// leading zeros, a valid time, and a chunk number of three digits.
//
// Units     Times are the start of the volume by the radar's clock.
// Threads   Plain values and pure functions.
// Errors    None. parse_chunk_key() returns std::nullopt for a key that does not have this form.
#pragma once

#include <chrono>
#include <compare>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::feed {

inline constexpr int last_volume = 999;  // the next volume is number 1
inline constexpr int last_chunk = 999;
// A key is rejected if its time is further in the future than this. Otherwise the key would count
// as the newest forever.
inline constexpr std::chrono::hours tolerated_clock_error{24};

struct VolumeId {
    UtcTime time;    // the first member, so that volumes are sorted by time
    int number = 0;  // the directory, 1 to 999
    auto operator<=>(const VolumeId&) const = default;
};

struct ChunkKey {
    std::string station;
    VolumeId volume;
    int number = 0;
    level2::ChunkKind kind = level2::ChunkKind::intermediate;
    bool operator==(const ChunkKey&) const = default;
};

[[nodiscard]] std::optional<ChunkKey> parse_chunk_key(std::string_view key, UtcTime now);
[[nodiscard]] std::string to_string(const ChunkKey& key);

// Returns the volume number in the name of a directory, such as "494"; none for any other text.
[[nodiscard]] std::optional<int> parse_volume_number(std::string_view text);
// Returns the volume number that comes `steps` after `number`. 1 follows 999.
[[nodiscard]] int volume_number_after(int number, int steps = 1);
// Returns the prefix of the keys of a directory, such as "KTLX/494/".
[[nodiscard]] std::string directory_of(std::string_view station, int number);
// Returns the prefix of the keys of a volume, such as "KTLX/494/20220317-000842".
[[nodiscard]] std::string prefix_of(std::string_view station, const VolumeId& volume);

}  // namespace stormcellar::feed
