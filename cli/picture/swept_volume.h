// cli/picture/swept_volume.h -- a decoded volume whose sweeps are drawn as the radar saw them, and
// one sweep of it on its plane.
//
// Threads   Plain values and functions without state.
// Errors    See each function; they name the file or the option.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/picture/raw_volume.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

struct SweptVolume {
    std::string file;  // for messages and for the provenance
    GridRequest request;
    bool spacing_given = false;
    std::shared_ptr<const std::vector<SourceVolume>> volumes;  // one

    [[nodiscard]] const SourceVolume& source() const { return volumes->front(); }
};

// A sweep that was found, and the plane on which it is drawn.
struct PlacedSweep {
    cache::GridDescription description;
    grid::SweepLookup sweep;
};

// Decodes the one file that the options name. With a scene, only the cuts that it may show are
// decoded where the pattern of the volume says which those are; without one, all. Errors:
// bad_argument for several files and for options; those of load_volume().
[[nodiscard]] Result<SweptVolume> read_sweeps(GridOptions options, const render::Scene* shown);
// The same for a volume that the catalog has.
[[nodiscard]] Result<SweptVolume> decode_sweeps(const RawVolume& raw, const GridOptions& options,
                                                const render::Scene* shown);

// Finds the sweep that the scene names. Its plane, about the site or about the center that the
// options name, reaches to the last gate unless the options say how far; or it is `plane`, that of
// another frame. Errors: those of grid::SweepLookup::find().
[[nodiscard]] Result<PlacedSweep> place_sweep(const SweptVolume& volume, const render::Scene& scene,
                                              const grid::GridSpec* plane = nullptr);

// Returns the elevations of the sweeps that hold the moment, each once, rising.
[[nodiscard]] std::vector<double> elevations_of(const SweptVolume& volume);

}  // namespace stormcellar::cli
