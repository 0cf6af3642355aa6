#include "cli/loop/swept_cells.h"

#include <utility>
#include <vector>

#include "cli/picture/cell_scans.h"
#include "cli/picture/stored_cells.h"

namespace stormcellar::cli {

Result<render::CellOverlay> SweptCells::of(std::size_t number, const std::filesystem::path& file) {
    if (!scans_.contains(number)) {
        GridOptions options = options_;
        options.files = {file.native()};
        options.moment = level2::moment_name(level2::Moment::ref);
        options.dealias = options.storm_motion = "";
        auto grid = PictureGrid::make(std::move(options));
        if (!grid) return pass_on(grid);
        auto scan =
            scan_grid(*grid, nullptr, newest_ ? &*newest_ : nullptr, grid->name(), freezing_);
        if (!scan) return pass_on(scan);
        scans_.emplace(number, std::move(*scan));
        newest_.emplace(std::move(*grid));
    }
    const UtcTime time = scans_.at(number).time;
    std::vector<retrieve::CellScan> scans;
    for (const auto& [before, scan] : scans_)
        if (before <= number && time - scan.time <= StoredCells::history) scans.push_back(scan);
    return overlay_of(scans);
}

}  // namespace stormcellar::cli
