// web/data/events/catalog_changes.h -- which stations' databases were written.
//
// It compares sizes and times of the files of the catalog's directory (STATION.sqlite and its
// write-ahead log), two system calls a station, and opens nothing. It needs no watch of the kernel.
//
// Threads   One thread at a time.
// Errors    None: a directory that is not there, or cannot be read, has no stations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace stormcellar::web {

class CatalogChanges {
  public:
    explicit CatalogChanges(std::filesystem::path directory) : directory_(std::move(directory)) {}

    // Returns the stations whose databases are new or were written since the last call, sorted; at
    // the first call, all of them.
    [[nodiscard]] std::vector<std::string> take();

  private:
    struct Stamp {
        std::int64_t modified_ns = 0, log_modified_ns = 0;
        std::int64_t size = 0, log_size = 0;
        bool operator==(const Stamp&) const = default;
    };
    const std::filesystem::path directory_;
    std::map<std::string, Stamp> stamps_;
};

}  // namespace stormcellar::web
