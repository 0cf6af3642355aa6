// web/data/events/catalog_changes.h -- finds the stations whose databases were written.
//
// CatalogChanges compares sizes and times of the files in the catalog's directory (STATION.sqlite
// and its write-ahead log). For each station this takes two system calls. It opens no file and
// needs no inotify watch.
//
// Threads   One thread at a time.
// Errors    None. A directory that does not exist or cannot be read has no stations.
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

    // Returns the stations whose databases are new or were written since the last call, sorted. The
    // first call returns all stations.
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
