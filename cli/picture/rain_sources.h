// cli/picture/rain_sources.h -- gets the volumes of a rain total: from files, whose rates it grids,
// or from the grids that the cache has of a domain.
//
// A total of some hours ends at a given time, or else at the middle of the newest volume. The
// volumes before and after these hours, up to the longest bridge (RainTotal), give the rates at
// both ends. A domain's total uses its grids of RATE. If its grids of REF cover more of the hours,
// the total uses these with rates by reflectivity alone, and a note says so. Grids with other cells
// than the newest grid are left out, so that their minutes are not seen.
//
// Threads   One thread at a time; work is split over `threads`.
// Errors    bad_argument for hours out of range; not_found if the domain has no grids; those of
//           PictureGrid and RainTotalGrid.
#pragma once

#include <optional>
#include <string>

#include "cli/picture/picture_grid.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

inline constexpr double most_rain_hours = 24;

struct RainChoice {
    std::optional<double> hours = {};   // none: from the first to the last file
    std::optional<UtcTime> until = {};  // none: the newest volume
    int threads = 1;
};

// Returns bad_argument, naming the option, unless the hours are above 0 and at most 24.
[[nodiscard]] Status check_rain_hours(const std::optional<double>& hours);

[[nodiscard]] Result<PictureGrid> rain_total_of_files(const GridOptions& options,
                                                      const RainChoice& choice);
// `choice.hours` must be given.
[[nodiscard]] Result<PictureGrid> rain_total_of_domain(const cache::StoreReader& store,
                                                       const std::string& domain,
                                                       const RainChoice& choice);

}  // namespace stormcellar::cli
