// batch/recipe.h -- the settings for gridding an archive: sources, times, stations and grids.
//
// The first line of a plan holds the recipe, so that each task finds everything there.
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
    std::string source;           // an absolute directory, or the URL of a bucket
    std::filesystem::path cache;  // directory of the grids
    // The times of the frames, or of the starts of volumes if there is no domain; inclusive.
    UtcTime from, to;
    std::vector<level2::Moment> moments = {level2::Moment::ref};
    // how velocities are dealiased, the motion of SRV, and which echo is left out
    retrieve::DerivedOptions derived = {};
    // the counts to make of the domain's frames; none: no counts
    std::optional<grid::Tallied> statistics;
    std::optional<pipeline::Domain> domain;  // none: grid each station alone, with this spec
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32

    // Returns the name of the cache's domain that holds the grids of a station.
    [[nodiscard]] std::string domain_of(const std::string& station) const;
    // Returns how long before `from`, or after `to`, a volume that the frames need may begin.
    [[nodiscard]] std::chrono::milliseconds margin() const;
    // Returns the recipe as options for gridding an archive, with only the first moment.
    [[nodiscard]] pipeline::ArchiveOptions archive_options(int threads) const;
};

[[nodiscard]] bool is_address(const std::string& source);  // true for the URL of a bucket

[[nodiscard]] nlohmann::ordered_json json_of(const Recipe& recipe);
// Reads a recipe. Errors: corrupt for a document that is not a recipe.
[[nodiscard]] Result<Recipe> recipe_of(const nlohmann::ordered_json& json);

// Returns a hash of the recipe and the software version. A record with another hash is from another
// plan.
[[nodiscard]] std::string hash_of(const Recipe& recipe);

}  // namespace stormcellar::batch
