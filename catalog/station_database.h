// catalog/station_database.h -- one station's SQLite database; used by Catalog alone.
//
// Methods throw SQLite::Exception, which Catalog turns into errors. Thread contract: one thread at
// a time; Catalog holds a mutex for each.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "catalog/catalog.h"

namespace stormcellar::catalog {

// What an SQLite failure is to a caller.
[[nodiscard]] ErrorCode code_of(const SQLite::Exception& error);

class StationDatabase {
  public:
    // Creates the file and its tables when they are missing. unsupported or corrupt for a database
    // of a later version or of another program.
    static Result<std::unique_ptr<StationDatabase>> open_for_writing(
        const std::filesystem::path& path, std::string station);
    static Result<std::unique_ptr<StationDatabase>> open_for_reading(
        const std::filesystem::path& path, const std::string& station);

    Registered register_file(const FileFacts& facts);
    int mark_gone(const std::filesystem::path& path);
    // Of the rows that are not gone.
    std::vector<std::filesystem::path> paths_below(const std::filesystem::path& directory);
    void forget(const std::filesystem::path& path);
    // None when the path has no row.
    std::optional<bool> is_settled(const std::filesystem::path& path, std::uint64_t size_bytes,
                                   std::int64_t modified_ns);

    StationSummary summary();
    std::vector<CatalogEntry> list(const Query& query);
    std::optional<CatalogEntry> first(bool latest);

  private:
    StationDatabase(const std::string& uri, int flags, std::string station);

    std::int64_t store_volume(std::int64_t file_id, std::uint64_t content_hash,
                              const VolumeFacts& facts);
    std::vector<CatalogEntry> entries(SQLite::Statement& rows) const;

    SQLite::Database database_;
    std::string station_;
};

}  // namespace stormcellar::catalog
