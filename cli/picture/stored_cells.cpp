#include "cli/picture/stored_cells.h"

#include <utility>
#include <vector>

#include "base/printable.h"
#include "cli/picture/cell_scans.h"

namespace stormcellar::cli {

Result<render::CellOverlay> StoredCells::at(UtcTime time) {
    auto entries = store_.list(domain_, level2::Moment::ref, time - history, time);
    if (!entries) return pass_on(entries);
    if (entries->empty() || time - entries->back().time > longest_age) {
        return fail(ErrorCode::not_found,
                    "--overlay cells needs reflectivity; domain '{}' has no grid of REF in the {} "
                    "minutes before {}",
                    printable(domain_), longest_age.count(), format_utc(time));
    }
    if (entries->size() > most_grids) entries->erase(entries->begin(), entries->end() - most_grids);
    if (Status found = find(*entries); !found) return pass_on(found);
    std::vector<retrieve::CellScan> scans;
    for (const cache::StoreEntry& entry : *entries)
        if (const auto scan = scans_.find(entry.time); scan != scans_.end())
            scans.push_back(scan->second);
    return overlay_of(scans);
}

// Finds the cells of grids whose cells are not known yet, and forgets the cells of grids before
// `entries`. Leaves out a grid that cannot be read, unless it is the newest.
Status StoredCells::find(const std::vector<cache::StoreEntry>& entries) {
    scans_.erase(scans_.begin(), scans_.lower_bound(entries.front().time));
    std::optional<PictureGrid> before;
    UtcTime before_time;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const cache::StoreEntry& entry = entries[i];
        if (scans_.contains(entry.time)) continue;
        const bool is_last = i + 1 == entries.size();
        if (i > 0 && (!before || before_time != entries[i - 1].time)) {
            auto earlier = PictureGrid::open(entries[i - 1].path);
            before.reset();
            if (earlier) before.emplace(std::move(*earlier));
        }
        auto grid = PictureGrid::open(entry.path);
        if (!grid && is_last) return pass_on(grid);
        if (!grid) continue;
        auto scan = scan_grid(*grid, nullptr, before ? &*before : nullptr, domain_, freezing_);
        if (!scan && is_last) return pass_on(scan);
        if (scan) scans_.emplace(entry.time, std::move(*scan));
        before.emplace(std::move(*grid));
        before_time = entry.time;
    }
    return {};
}

}  // namespace stormcellar::cli
