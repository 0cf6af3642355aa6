// pipeline/mosaic/site_watch.h -- compares, from time to time, the overlapping sites of the mosaics
// in the cache.
//
// Takes a domain's newest frame that is not provisional. Its partials show which of its sites may
// overlap; each such pair is compared (pipeline/mosaic/pair_comparison.h). A pair is compared again
// only for a frame that is at least an hour later. So nothing is compared while older data are
// replayed.
//
// Threads   One thread at a time.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/mosaic/pair_comparison.h"
#include "pipeline/options/domain.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

struct PairReport {
    std::string domain;
    UtcTime instant;  // of the frame
    grid::SiteComparison found;
    std::vector<std::string> faults;  // the faults that grid::faults() names
};

class SiteWatch {
  public:
    static constexpr std::chrono::milliseconds period = std::chrono::hours{1};

    // The store must outlive the object.
    SiteWatch(const cache::StoreReader& store, std::vector<Domain> domains);

    // Compares the next pair that is due. Returns none if no pair is due. If a pair cannot be
    // compared, for example because a partial is gone or damaged, skips it until an hour later.
    // Errors: the cache cannot be read.
    Result<std::optional<PairReport>> compare_next();

  private:
    using Pair = std::pair<std::string, std::string>;
    struct CompleteFrame {
        const Domain* domain = nullptr;
        cache::GridDescription description;
    };
    [[nodiscard]] Result<std::optional<CompleteFrame>> newest_complete(const Domain& domain) const;
    std::optional<Pair> take_due(const CompleteFrame& frame);
    [[nodiscard]] std::optional<PairReport> compare(const CompleteFrame& frame,
                                                    const Pair& pair) const;

    const cache::StoreReader& store_;
    std::vector<Domain> domains_;  // domains with reflectivity
    // The instant of the frame at which each pair was last compared, by domain and pair.
    std::map<std::pair<std::string, Pair>, UtcTime> compared_;
};

}  // namespace stormcellar::pipeline
