// stormcellar/catalog/radar_set.h -- gives the files of a station, raw or decoded.
//
// The interface follows the storage-broker client of the 2008 paper, so that programs for that
// client can be ported. A file is only returned if it is still the cataloged one
// (stormcellar/catalog/read_cataloged.h).
//
// Threads   As CatalogReader: many threads may use one object.
// Errors    See each function, and those of CatalogReader.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::catalog {

class RadarSet {
  public:
    // Opens a set for each cataloged station whose database can be read, sorted by ICAO.
    static Result<std::vector<RadarSet>> open_all(const std::filesystem::path& catalog_directory);
    // Opens a station. Errors: not_found if the catalog has no such station, bad_argument for a
    // name that no station has.
    static Result<RadarSet> open(const std::filesystem::path& catalog_directory,
                                 const std::string& station);

    [[nodiscard]] const std::string& station() const { return station_; }

    // Returns the names (without directories) of the files with a volume that starts from `from` to
    // `to`, oldest first, each once. Some of them may be gone.
    [[nodiscard]] Result<std::vector<std::string>> build_data_list(UtcTime from, UtcTime to) const;
    // Returns the name of the file with the oldest volume. Errors: not_found if the station has no
    // volume.
    [[nodiscard]] Result<std::string> oldest_file_name() const;
    // Returns the raw bytes of a file that build_data_list() named. Errors: not_found if the
    // catalog or the disk no longer has it, and those of read_cataloged().
    [[nodiscard]] Result<std::vector<std::byte>> radar_file(const std::string& name) const;
    // Reads a file as radar_file() does, and decodes it. Errors: those of radar_file() and of
    // level2::decode().
    [[nodiscard]] Result<level2::Decoded> read_radar(const std::string& name) const;

  private:
    RadarSet(std::shared_ptr<const CatalogReader> catalog, std::string station);
    std::shared_ptr<const CatalogReader> catalog_;
    std::string station_;
};

}  // namespace stormcellar::catalog
