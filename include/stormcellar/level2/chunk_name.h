// stormcellar/level2/chunk_name.h -- names of live chunks.
//
// "YYYYMMDD-HHMMSS-NNN-T", as the cloud buckets and LDM's users write them (ICD 2620010 section 6
// gives the parts; the number may lack its leading zeros, which pqact cannot add), or LDM's own
// key, "L2-BZIP2/KFTG/20150908215946/494/43/I/V06/0", with any separator in place of the slashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::level2 {

enum class ChunkKind : std::uint8_t { start, intermediate, end };

struct ChunkName {
    // "20220317-000842" or "20150908215946_494": the same for all chunks of a volume.
    std::string volume;
    int number = 0;  // from 1
    ChunkKind kind = ChunkKind::intermediate;
    bool operator==(const ChunkName&) const = default;
};

// The parts of a file name, which may have something before them ("KLOT-") or a directory, and an
// ending (".bz2", "-V06") behind; none where it is no chunk's.
[[nodiscard]] std::optional<ChunkName> parse_chunk_name(std::string_view name);
// As above, with the places in the name of what tells the chunks of a volume apart.
struct PlacedChunkName {
    ChunkName name;
    std::size_t number_at = 0;  // where its number begins
    std::size_t behind = 0;     // behind the letter of its kind
};
[[nodiscard]] std::optional<PlacedChunkName> place_chunk_name(std::string_view name);
// "20220317-000842-001-S"
[[nodiscard]] std::string to_string(const ChunkName& name);

}  // namespace stormcellar::level2
