// batch/recipe.h -- what an archive is made into: sources, times, stations and grids.
//
// A recipe stands in the first line of a plan, so that each task has all that it needs there.
//
// Units     Meters, degrees, seconds; times are UTC.
// Threads   Plain data and pure functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "grid/cells/grid_tally.h"
#include "pipeline/care/archive_fill.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::batch {

struct Recipe {
    std::string source;           // an absolute directory, or the address of a bucket
    std::filesystem::path cache;  // where the grids are kept
    UtcTime from, to;             // of the frames, else of the starts of the volumes; inclusive
    std::vector<level2::Moment> moments = {level2::Moment::ref};
    std::optional<grid::Tallied> statistics;  // of the domain's frames; none: no statistics
    std::optional<pipeline::Domain> domain;   // none: own grids of the stations, of this shape
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32

    // Returns the domain of the cache that has what a station gave.
    [[nodiscard]] std::string domain_of(const std::string& station) const;
    // Returns how much earlier and later than from and to the volumes begin that are needed.
    [[nodiscard]] std::chrono::milliseconds margin() const;
    // Returns the same recipe as a fill of one moment takes it.
    [[nodiscard]] pipeline::ArchiveOptions archive_options(int threads) const;
};

[[nodiscard]] bool is_address(const std::string& source);  // of a bucket

[[nodiscard]] nlohmann::ordered_json json_of(const Recipe& recipe);
// Errors: corrupt, for a document that json_of() did not make.
[[nodiscard]] Result<Recipe> recipe_of(const nlohmann::ordered_json& json);

// Identifies the recipe and the software that makes it: what has another hash is of another plan.
[[nodiscard]] std::string hash_of(const Recipe& recipe);

}  // namespace stormcellar::batch
