#include "web/data/storms/storm_scans.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "stormcellar/retrieve/vertical_liquid.h"

namespace stormcellar::web {
namespace {

using level2::Moment;
using retrieve::CellScan;

std::uint64_t bytes_of(const CellScan& scan) {
    std::uint64_t bytes = sizeof scan + scan.spec.levels_m.size() * sizeof(double);
    for (const retrieve::StormCell& cell : scan.cells)
        bytes += sizeof cell + cell.columns.size() * sizeof(retrieve::ColumnRun);
    return bytes;
}

// Searches an open grid. `shear` and `before` may be null.
Result<CellScan> search(const OpenGrid& grid, const OpenGrid* shear, const OpenGrid* before,
                        const retrieve::FreezingLevels& freezing) {
    retrieve::CellFields fields{
        .reflectivity = grid.file.view(),
        .azimuthal_shear = std::nullopt,
        .freezing = freezing,
        .radar_m = retrieve::mean_radar_height_m(grid.file.description().sites)};
    const grid::GridSpec& spec = *fields.reflectivity.spec;
    if (shear != nullptr && *shear->file.view().spec == spec)
        fields.azimuthal_shear = shear->file.view();
    auto scan = retrieve::find_cells(fields, grid.time, grid.domain);
    if (!scan) return scan;
    if (before != nullptr && *before->file.view().spec == spec) {
        const Status guessed =
            retrieve::guess_motions(*scan, before->file.view(), fields.reflectivity,
                                    seconds_between(before->time, grid.time));
        if (!guessed) return pass_on(guessed);
    }
    for (const OpenGrid* const read : {&grid, shear, before}) {
        if (read == nullptr) continue;
        if (const Status whole = read->file.check_whole(); !whole) return pass_on(whole);
    }
    return scan;
}

// Returns null if the grid cannot be read, because the cells do not depend on it.
std::shared_ptr<const OpenGrid> find_extra(Grids& grids, const std::string& area, Moment moment,
                                           std::optional<UtcTime> time) {
    if (!time) return nullptr;
    auto found = grids.find(area, moment, *time);
    return found ? std::move(*found) : nullptr;
}

std::string_view id_of(const std::shared_ptr<const OpenGrid>& grid) {
    return grid ? std::string_view(grid->id) : "-";
}

}  // namespace

Result<StormScans::Scan> StormScans::scan(const std::string& area, UtcTime time,
                                          std::optional<UtcTime> before) {
    const auto grid = grids_->find(area, Moment::ref, time);
    if (!grid) return pass_on(grid);
    const auto shear = find_extra(*grids_, area, Moment::azsh, time);
    const auto earlier = find_extra(*grids_, area, Moment::ref, before);
    const std::string key = fmt::format("{}/{}/{}/{}/{}", area, format_utc(time), id_of(*grid),
                                        id_of(shear), id_of(earlier));
    const MutexLock lock(mutex_);
    if (const Scan* const found = kept_.find(key)) return *found;
    auto made = search(**grid, shear.get(), earlier.get(), freezing_);
    if (!made) return pass_on(made);
    ++searched_;
    const std::uint64_t bytes = bytes_of(*made);
    return kept_.keep(key, std::make_shared<const CellScan>(std::move(*made)), bytes);
}

Result<retrieve::TrackedScan> StormScans::track(const StormArea& area) {
    std::vector<CellScan> scans;
    std::optional<UtcTime> before;
    for (const UtcTime time : area.times) {
        const auto found = scan(area.name, time, before);
        if (found) {
            scans.push_back(**found);
            before = time;
        } else if (found.error().code != ErrorCode::not_found) {
            return pass_on(found);
        }
    }
    if (scans.empty()) return retrieve::TrackedScan{{}, area.name, {}, {}};
    auto tracked = retrieve::track_cells(scans);
    if (!tracked) return pass_on(tracked);
    return std::move(tracked->back());
}

std::uint64_t StormScans::searched() const {
    const MutexLock lock(mutex_);
    return searched_;
}

}  // namespace stormcellar::web
