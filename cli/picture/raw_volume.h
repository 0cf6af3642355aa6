// cli/picture/raw_volume.h -- finds the raw volume of a grid through the catalog. A ppi of a domain
// is drawn from the raw volume, because the cache holds only grids.
//
// Threads   One thread at a time; catalog and cache are only read.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::cli {

// A raw volume that the catalog has. It may still be growing.
struct RawVolume {
    std::string file;
    UtcTime start;  // of the volume; the file may hold further volumes
    std::vector<std::byte> bytes;
    std::vector<std::string> notes;  // remarks, such as missing chunks
};

// Returns a grid for each time at which the domain has one, of whatever moment, in ascending order.
// Errors: those of the cache.
[[nodiscard]] Result<std::vector<cache::StoreEntry>> grids_of_any_moment(
    const cache::StoreReader& store, const std::string& domain, std::optional<UtcTime> from,
    std::optional<UtcTime> to);

// Reads the volume of a grid. Errors: bad_argument for a grid of several sites; not_found if the
// catalog does not have the volume or its file is gone; those of pipeline::read_cataloged_volume().
[[nodiscard]] Result<RawVolume> raw_volume_of(const catalog::CatalogReader& catalog,
                                              const std::string& domain,
                                              const cache::GridDescription& grid);

// Reads the volume of a station that starts at this time. If several files have this volume, reads
// it from `file`. Errors: not_found and those of reading, as in raw_volume_of().
[[nodiscard]] Result<RawVolume> raw_volume_at(const catalog::CatalogReader& catalog,
                                              const std::string& station, UtcTime start,
                                              const std::filesystem::path& file);

}  // namespace stormcellar::cli
