// pipeline/mosaic/mapped_partials.h -- the partials of a domain around a time, mapped from their
// files.
//
// Inside the pipeline room only. Each partial holds a descriptor and a map; only partials within 35
// minutes of the times that are asked for are opened. Thread contract: one thread.
#pragma once

#include <string>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// No volume takes longer from its start, by which the store names it, to its middle.
inline constexpr std::chrono::milliseconds longest_to_middle = std::chrono::minutes{10};

// Names of a domain's partials: "NAME.ICAO". Errors: the cache cannot be read.
[[nodiscard]] Result<std::vector<std::string>> partial_domains(const cache::StoreReader& store,
                                                               const std::string& domain);

class MappedPartials {
  public:
    // The partials that count for an instant between `from` and `to`. Files that cannot be opened
    // are named in `problems`; partials of an earlier configuration are left out. Errors: the cache
    // cannot be read.
    static Result<MappedPartials> open(const cache::StoreReader& store, const Domain& domain,
                                       level2::Moment moment, UtcTime from, UtcTime to,
                                       std::vector<std::string>& problems);

    // Valid until a partial is dropped.
    [[nodiscard]] std::vector<PartialView> views() const;
    // Verifies that what was read is what the files held.
    [[nodiscard]] Status check_whole() const;
    // Verifies all partials, and drops damaged ones, naming each in `problems`. Returns false if
    // none was damaged.
    bool drop_damaged(std::vector<std::string>& problems);

  private:
    std::vector<cache::GridFile> files_;
};

}  // namespace stormcellar::pipeline
