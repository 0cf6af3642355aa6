// stormcellar/level2/chunk_name.h -- names of live chunks.
//
// There are two forms of names:
// - "YYYYMMDD-HHMMSS-NNN-T", which the cloud buckets and users of LDM write. ICD 2620010 section 6
//   gives the parts. The number may lack its leading zeros, because pqact cannot add them.
// - LDM's own key, "L2-BZIP2/KFTG/20150908215946/494/43/I/V06/0", with any separator in place of
//   the slashes.
//
// Threads   Plain values and pure functions.
// Errors    None; the functions return none for any other name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::level2 {

enum class ChunkKind : std::uint8_t { start, intermediate, end };

struct ChunkName {
    // "20220317-000842" or "20150908215946_494": equal for all chunks of a volume.
    std::string volume;
    int number = 0;  // counts from 1
    ChunkKind kind = ChunkKind::intermediate;
    bool operator==(const ChunkName&) const = default;
};

// Parses a file name. There may be a prefix ("KLOT-") or a directory before the name, and an ending
// (".bz2", "-V06") after it. Returns none if `name` is not the name of a chunk.
[[nodiscard]] std::optional<ChunkName> parse_chunk_name(std::string_view name);
// A chunk name, and the positions in the text of the parts that differ between the chunks of a
// volume.
struct PlacedChunkName {
    ChunkName name;
    std::size_t number_at = 0;  // where the number begins
    std::size_t behind = 0;     // the position after the letter of the kind
};
[[nodiscard]] std::optional<PlacedChunkName> place_chunk_name(std::string_view name);
// Returns a name such as "20220317-000842-001-S".
[[nodiscard]] std::string to_string(const ChunkName& name);

}  // namespace stormcellar::level2
