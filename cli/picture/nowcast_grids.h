// cli/picture/nowcast_grids.h -- the grids from which a nowcast is made: of files, or of a domain
// of the cache.
//
// Threads   One thread at a time; work is split over the threads of the options.
#pragma once

#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/picture/picture_grid.h"
#include "cli/shared/service_places.h"
#include "retrieve/nowcast/nowcast.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::cli {

struct NowcastSource {
    std::vector<std::string> words;  // files, or a domain
    std::string domain;              // as typed; nowcast_grids() sets it
    PlaceOption cache;
    std::string time;  // start of the latest volume, at most; empty: the newest
    GridOptions grid;  // for grids made from files
};

// Returns the grids of reflectivity in order of time. Each volume of a file gives a grid. A domain
// gives its grids of the last two hours. Leaves out volumes that begin after `time`. Errors:
// bad_argument for files of several radars, and for options of the grid with a domain; not_found if
// no volume is left; those of making and opening grids.
[[nodiscard]] Result<std::vector<PictureGrid>> nowcast_grids(NowcastSource& source);

// Returns views of the grids with the middle times of their volumes. The grids must outlive them.
[[nodiscard]] std::vector<retrieve::TimedGrid> timed_grids(const std::vector<PictureGrid>& grids);

// Returns the description of a nowcast from the latest grid: all times are `minutes` later, and
// notes say that it is a nowcast, and its error (retrieve/nowcast/nowcast_note.h).
[[nodiscard]] cache::GridDescription describe_nowcast(cache::GridDescription latest, double minutes,
                                                      const std::string& score);

}  // namespace stormcellar::cli
