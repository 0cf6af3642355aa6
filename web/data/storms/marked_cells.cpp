#include "web/data/storms/marked_cells.h"

#include <utility>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar::web {

Result<MarkedCells> marked_cells(StormScans& scans, const std::string& domain, UtcTime time,
                                 const std::optional<retrieve::FreezingLevels>& levels) {
    Grids& grids = *scans.grids();
    const auto areas = storm_areas(grids, {.area = domain, .at = time});
    if (!areas || areas->front().times.empty())
        return fail(ErrorCode::not_found,
                    "overlay=cells needs reflectivity; domain '{}' has no grid of REF in the {} "
                    "minutes before {}",
                    printable(domain), storm_recent.count(), format_utc(time));
    const StormArea& area = areas->front();
    MarkedCells marked;
    std::size_t volumes = 0;
    for (const UtcTime one : area.times) {
        const auto grid = grids.find(domain, level2::Moment::ref, one);
        if (!grid) continue;
        marked.key += "\n" + (*grid)->id;
        ++volumes;
    }
    StormScans own(scans.grids(), levels.value_or(retrieve::FreezingLevels{}));
    const bool is_kept = !levels || *levels == scans.freezing();
    auto tracked = (is_kept ? scans : own).track(area);
    if (!tracked) return pass_on(tracked);
    if (!levels) {
        tracked->freezing.reset();
        for (retrieve::TrackedCell& cell : tracked->cells)
            cell.cell.mesh_mm.reset();
    }
    marked.overlay = std::make_shared<const render::CellOverlay>(
        render::CellOverlay{std::move(*tracked), {}, volumes});
    return marked;
}

}  // namespace stormcellar::web
