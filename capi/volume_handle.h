// capi/volume_handle.h -- the object behind stormcellar_volume.
//
// Threads   Plain data, which never changes after the object is made.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capi/query.h"
#include "grid/place/source_volume.h"
#include "stormcellar.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/derived_moments.h"

struct stormcellar_volume {
    stormcellar::grid::SourceVolume source;  // without the site, which may be unknown
    std::string file;                        // its name without directories, or empty
    std::vector<std::string> problems;
    int volumes_in_file = 1;
};

namespace stormcellar::capi {

// Reads the names of moments between blanks. Errors: bad_argument for an unknown name.
[[nodiscard]] Result<std::vector<level2::Moment>> moments_named(const char* names);

// Returns a copy of the volume with the derived moments among `moments`, or null if there are none
// and the options change nothing. Errors: those of add_derived_moments().
[[nodiscard]] Result<std::unique_ptr<stormcellar_volume>> derived_volume(
    const stormcellar_volume& volume, const std::vector<level2::Moment>& moments,
    const retrieve::DerivedOptions& options);

// Errors: bad_argument for a null pointer and for numbers that the volume does not have.
[[nodiscard]] Result<const level2::Sweep*> sweep_of(const stormcellar_volume* volume,
                                                    std::int32_t sweep);
[[nodiscard]] Result<const level2::SweepMoment*> moment_of(const stormcellar_volume* volume,
                                                           std::int32_t sweep, std::int32_t moment);

}  // namespace stormcellar::capi
