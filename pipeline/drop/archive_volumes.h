// pipeline/drop/archive_volumes.h -- which raw files of a catalog belong to a time range.
//
// For each station these are the volumes that overlap the range and, if frames are made between
// volumes, also the last one before it and the first one after it, if they are close enough to
// count. A volume that was sent more than once is taken once: a whole one rather than a part, then
// the latest.
//
// Threads   Functions without state; the catalog is only read.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <set>
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
    bool gone = false;             // its owner deleted the raw file, according to the catalog
};

struct ArchiveRange {
    UtcTime from, to;              // inclusive
    bool with_neighbours = false;  // also the volumes next to the range
    // Only volumes of these files, archives and directories of chunks are taken; empty: all.
    std::set<std::filesystem::path> only{};
};

// No volume is longer. Volumes are looked for this far before the range.
inline constexpr std::chrono::minutes longest_volume{20};
// The largest distance of a neighbor from the range.
inline constexpr std::chrono::minutes farthest_neighbour{25};

// Returns volumes by station, then start. Stations that the catalog does not know have none. If
// several are requested, one whose database cannot be read has none, either, and the catalog's
// troubles() names it. Errors: those of the catalog.
[[nodiscard]] Result<std::vector<ArchiveVolume>> archive_volumes(
    const catalog::CatalogReader& catalog, const std::vector<std::string>& stations,
    const ArchiveRange& range);

}  // namespace stormcellar::pipeline
