// pipeline/mosaic/mapped_partials.h -- the partials of a domain about a time, as their files have
// them.
//
// Inside the pipeline room only. Each holds a descriptor and a map; at most those of 35 minutes
// about the times asked for are opened.
// Thread contract: one thread.
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
    // Those that count for an instant between `from` and `to`. What cannot be opened is named in
    // `problems`; partials of a configuration that has changed since are left out.
    // Errors: the cache cannot be read.
    static Result<MappedPartials> open(const cache::StoreReader& store, const Domain& domain,
                                       level2::Moment moment, UtcTime from, UtcTime to,
                                       std::vector<std::string>& problems);

    // Valid until one is dropped.
    [[nodiscard]] std::vector<PartialView> views() const;
    // What was read was what the files held.
    [[nodiscard]] Status check_whole() const;
    // Verifies all and drops those that are damaged, each named in `problems`. False: none was.
    bool drop_damaged(std::vector<std::string>& problems);

  private:
    std::vector<cache::GridFile> files_;
};

}  // namespace stormcellar::pipeline
