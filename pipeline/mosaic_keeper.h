// pipeline/mosaic_keeper.h -- keeps the mosaics of configured domains fresh as volumes come.
//
// A volume of a site that a domain takes is gridded on the domain's columns and kept in the store
// as the domain "NAME.ICAO"; then the frames of "NAME" that it changes are made again: those
// between the site's volume before and the one after. Frames stand at whole multiples of the
// interval since midnight UTC, none before the oldest volume thereabouts or after the newest. A
// frame is provisional until each of its sites has a volume after it (or for 15 minutes had none),
// and has a revision that counts how often it was replaced.
//
// Errors: those of gridding, merging and the store. A partial that cannot be read is left out of
// frames, and named.
//
// Thread contract: may be used by many threads; those of one domain and moment wait for each other.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "base/result.h"
#include "cache/store.h"
#include "pipeline/domain.h"
#include "pipeline/geometry_cache.h"
#include "pipeline/mosaic_frame.h"

namespace stormcellar::pipeline {

// A volume and where it comes from.
struct VolumeSource {
    const level2::Volume& volume;
    const grid::SitePosition& site;
    std::string file;  // its name, without directories
    std::int64_t modified_ns = 0;
    bool partial = false;
    std::vector<std::string> notes = {};
};

struct Kept {
    std::vector<std::filesystem::path> partials, frames;
    std::vector<std::string> problems;  // what was left out, and why
};

class MosaicKeeper {
  public:
    // Without a store, or without domains, it does nothing.
    MosaicKeeper(const cache::Store* store, std::vector<Domain> domains);

    // Does nothing for volumes that no domain takes. `threads` work on it.
    Result<Kept> take_in(const VolumeSource& source, int threads);
    [[nodiscard]] bool is_idle() const { return store_ == nullptr || domains_.empty(); }

  private:
    Status keep(const Domain& domain, level2::Moment moment, const VolumeSource& source,
                int threads, Kept& kept);
    Status refresh(const Domain& domain, level2::Moment moment,
                   const cache::GridDescription& changed, int threads, Kept& kept);

    const cache::Store* store_;
    std::vector<Domain> domains_;
    GeometryCache geometries_;
    std::mutex mutex_;                                                     // guards frames_
    std::map<std::pair<std::string, level2::Moment>, std::mutex> frames_;  // one at a time each
};

}  // namespace stormcellar::pipeline
