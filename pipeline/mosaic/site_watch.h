// pipeline/mosaic/site_watch.h -- compares the overlapping sites of the mosaics in the cache from
// time to time.
//
// For the newest complete (not provisional) frame of a domain, each pair of sites that may overlap
// is compared by the frame's partials (pipeline/mosaic/pair_comparison.h), at most once in an hour
// of the frames' time. If old data are replayed after newer ones, nothing is compared.
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
    std::vector<std::string> faults;  // faults that have a name: grid::faults()
};

class SiteWatch {
  public:
    static constexpr std::chrono::milliseconds period = std::chrono::hours{1};

    // The store must outlive it.
    SiteWatch(const cache::StoreReader& store, std::vector<Domain> domains);

    // Compares the next pair that is due; none if no pair is due. A pair with a partial that is
    // gone or damaged, or that cannot be compared, waits for its next turn. Errors: the cache
    // cannot be read.
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
    // By domain and pair: the instant of the frame of the last comparison.
    std::map<std::pair<std::string, Pair>, UtcTime> compared_;
};

}  // namespace stormcellar::pipeline
