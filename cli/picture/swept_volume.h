// cli/picture/swept_volume.h -- a decoded volume whose sweeps are drawn as the radar saw them.
// Chooses one sweep and the plane on which it is drawn.
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
    std::shared_ptr<const std::vector<SourceVolume>> volumes;  // has exactly one volume

    [[nodiscard]] const SourceVolume& source() const { return volumes->front(); }
};

// A sweep, and the plane on which it is drawn.
struct PlacedSweep {
    cache::GridDescription description;
    grid::SweepLookup sweep;
};

// Decodes the one file that the options name. With a scene, decodes only the cuts that the scene
// may show, or all cuts if the volume's pattern does not tell which these are. Errors: bad_argument
// for several files and for invalid options; those of load_volume().
[[nodiscard]] Result<SweptVolume> read_sweeps(GridOptions options, const render::Scene* shown);
// Decodes a volume of the catalog. Decodes the same cuts as read_sweeps() would.
[[nodiscard]] Result<SweptVolume> decode_sweeps(const RawVolume& raw, const GridOptions& options,
                                                const render::Scene* shown);

// Finds the sweep that the scene names. Places it on `plane` if this is given (the plane of another
// frame). Otherwise the center of the plane is the center in the options, else the site. The plane
// reaches as far as the options say, else to the last gate. Errors: those of
// grid::SweepLookup::find().
[[nodiscard]] Result<PlacedSweep> place_sweep(const SweptVolume& volume, const render::Scene& scene,
                                              const grid::GridSpec* plane = nullptr);

// Returns the elevations of all sweeps that hold the moment, each once, in ascending order.
[[nodiscard]] std::vector<double> elevations_of(const SweptVolume& volume);

}  // namespace stormcellar::cli
