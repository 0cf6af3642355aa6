// level2/chunk_name.h -- names of live chunks, "YYYYMMDD-HHMMSS-NNN-T" (ICD 2620010 section 6 gives
// the parts; the cloud buckets and LDM's users write them so; LDM's own product names give
// the number without leading zeros, and pqact cannot add them, so they may be missing).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::level2 {

enum class ChunkKind : std::uint8_t { start, intermediate, end };

struct ChunkName {
    std::string volume;  // "20220317-000842": the same for all chunks of a volume
    int number = 0;      // from 1
    ChunkKind kind = ChunkKind::intermediate;
    bool operator==(const ChunkName&) const = default;
};

// The parts of a file name, which may have something before them ("KLOT-") or a directory, and an
// ending (".bz2", "-V06") behind; none where it is no chunk's.
[[nodiscard]] std::optional<ChunkName> parse_chunk_name(std::string_view name);
// "20220317-000842-001-S"
[[nodiscard]] std::string to_string(const ChunkName& name);

}  // namespace stormcellar::level2
