// pipeline/mosaic/mapped_partials.h -- the partials of a domain near a time, from their files. Used
// only inside the pipeline room.
//
// Each holds a descriptor and a map. Only those within 35 minutes of the requested times are
// opened.
//
// Threads   One thread at a time.
#pragma once

#include <string>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// No volume takes longer from its start, which names it in the store, to its middle.
inline constexpr std::chrono::milliseconds longest_to_middle = std::chrono::minutes{10};

// Returns the names of a domain's partials: "NAME.ICAO". Errors: the cache cannot be read.
[[nodiscard]] Result<std::vector<std::string>> partial_domains(const cache::StoreReader& store,
                                                               const std::string& domain);

class MappedPartials {
  public:
    // Opens those that count for an instant between `from` and `to`. Partials that cannot be opened
    // are named in `problems`; those of an earlier configuration are left out. Errors: the cache
    // cannot be read.
    static Result<MappedPartials> open(const cache::StoreReader& store, const Domain& domain,
                                       level2::Moment moment, UtcTime from, UtcTime to,
                                       std::vector<std::string>& problems);

    // Valid until a partial is dropped.
    [[nodiscard]] std::vector<PartialView> views() const;
    // Returns ok if the bytes read were those of the files.
    [[nodiscard]] Status check_whole() const;
    // Verifies all partials and drops the damaged ones, each named in `problems`. Returns false if
    // none was damaged.
    bool drop_damaged(std::vector<std::string>& problems);

  private:
    std::vector<cache::GridFile> files_;
};

}  // namespace stormcellar::pipeline
