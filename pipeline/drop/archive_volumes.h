// pipeline/drop/archive_volumes.h -- finds the raw files of a catalog that belong to a time range.
//
// For each station these are the volumes that overlap the range. If frames are made between
// volumes, they also include the last volume before it and the first one after it, if these are
// close enough to count. A volume that was sent more than once is used once: a complete file is
// preferred to an incomplete one, then the latest.
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
    std::uint64_t size_bytes = 0;  // size of its file
    bool gone = false;             // its owner deleted the raw file, according to the catalog
};

struct ArchiveRange {
    UtcTime from, to;              // inclusive
    bool with_neighbours = false;  // also the volumes next to the range
    // Only volumes of these files, archives and directories of chunks are taken; empty: all.
    std::set<std::filesystem::path> only{};
};

// Volumes are at most this long. The search begins this far before the range.
inline constexpr std::chrono::minutes longest_volume{20};
// The largest distance of a neighbor from the range.
inline constexpr std::chrono::minutes farthest_neighbour{25};

// Returns volumes by station, then start. Stations unknown to the catalog have none. If several
// stations are requested, a station whose database cannot be read has none, either, and the
// catalog's troubles() names it. Errors: those of the catalog.
[[nodiscard]] Result<std::vector<ArchiveVolume>> archive_volumes(
    const catalog::CatalogReader& catalog, const std::vector<std::string>& stations,
    const ArchiveRange& range);

}  // namespace stormcellar::pipeline
