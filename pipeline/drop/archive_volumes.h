// pipeline/drop/archive_volumes.h -- finds the raw files of a catalog that belong to a time range.
//
// For each station, the result has the volumes that overlap the range and, on request, the
// neighbors of the range: the last volume before it and the first volume after it. A neighbor
// counts only if it is close enough for a frame between volumes. If several files have the same
// volume, one file is used: existing files are preferred, then complete ones, then the one with the
// highest generation.
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
    bool gone = false;             // the catalog says that the raw file was deleted
};

struct ArchiveRange {
    UtcTime from, to;              // inclusive
    bool with_neighbours = false;  // take also the last volume before and the first after the range
    // Take only volumes in these files, archives and directories of chunks; empty: all.
    std::set<std::filesystem::path> only{};
};

// The longest volume. Without neighbors, the search begins this long before the range.
inline constexpr std::chrono::minutes longest_volume{20};
// The longest time from the range to the start of a neighbor.
inline constexpr std::chrono::minutes farthest_neighbour{25};

// Returns the volumes in the order of `stations`, then by start. A station that the catalog does
// not have gives no volumes. If several stations are requested, a station whose database cannot be
// read gives no volumes, either; the catalog's troubles() names such stations. Errors: those of the
// catalog.
[[nodiscard]] Result<std::vector<ArchiveVolume>> archive_volumes(
    const catalog::CatalogReader& catalog, const std::vector<std::string>& stations,
    const ArchiveRange& range);

}  // namespace stormcellar::pipeline
