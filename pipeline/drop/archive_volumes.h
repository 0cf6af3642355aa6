// pipeline/drop/archive_volumes.h -- which raw files of a catalog a time range takes.
//
// Of each station the volumes that overlap the range, and where frames are made between volumes
// also the last one before it and the first one after it, as far as they are near enough to count.
// A volume that was sent more than once is taken once: whole before in part, then the latest.
// Thread contract: functions; the catalog is only read.
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
    bool gone = false;             // its owner deleted the raw file, by what the catalog knows
};

struct ArchiveRange {
    UtcTime from, to;              // inclusive
    bool with_neighbours = false;  // also the volumes next to the range
};

// No volume is longer; so far before the range volumes are looked for.
inline constexpr std::chrono::minutes longest_volume{20};
// So far outside of the range a neighbour may lie.
inline constexpr std::chrono::minutes farthest_neighbour{25};

// By station, then start. Stations that the catalog does not know have none. Where several are
// asked for, neither has one whose database cannot be read: the catalog's troubles() name it.
// Errors: those of the catalog.
[[nodiscard]] Result<std::vector<ArchiveVolume>> archive_volumes(
    const catalog::CatalogReader& catalog, const std::vector<std::string>& stations,
    const ArchiveRange& range);

}  // namespace stormcellar::pipeline
