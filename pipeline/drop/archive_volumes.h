// pipeline/drop/archive_volumes.h -- which raw files of a catalog belong to a time range.
//
// For each station these are the volumes that overlap the range. If frames are made between
// volumes, they include the last volume before the range and the first one after it, if these are
// near enough to count. A volume that was sent more than once is used once: a complete file before
// an incomplete one, then the latest. Thread contract: functions that only read the catalog.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {

struct ArchiveVolume {
    std::string station;
    std::filesystem::path path;
    UtcTime start, end;
    std::uint64_t size_bytes = 0;  // of its file
    bool gone = false;             // the catalog knows that the raw file was deleted
};

struct ArchiveRange {
    UtcTime from, to;              // inclusive
    bool with_neighbours = false;  // also the volumes next to the range
};

// No volume is longer. Volumes that begin this long before the range are considered.
inline constexpr std::chrono::minutes longest_volume{20};
// A neighbor may be at most this far outside of the range.
inline constexpr std::chrono::minutes farthest_neighbour{25};

// By station, then by start. A station that the catalog does not know has no volumes. If several
// stations are asked for, a station whose database cannot be read has none either; the catalog's
// troubles() name it. Errors: those of the catalog.
[[nodiscard]] Result<std::vector<ArchiveVolume>> archive_volumes(
    const catalog::CatalogReader& catalog, const std::vector<std::string>& stations,
    const ArchiveRange& range);

}  // namespace stormcellar::pipeline
