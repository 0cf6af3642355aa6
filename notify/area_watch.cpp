#include "notify/area_watch.h"

#include <algorithm>

#include "stormcellar/cache/grid_file.h"

namespace stormcellar::notify {
namespace {

constexpr std::chrono::hours history{3};
constexpr int most_in_a_look = 4;

// Estimates the motion of cells from the grid before, if there is one.
Status add_motion(retrieve::CellScan& scan, const cache::GridFile& file,
                  const cache::StoreEntry* before) {
    if (before == nullptr) return {};
    const auto earlier = cache::GridFile::open(before->path);
    if (!earlier || earlier->description().spec != scan.spec) return {};
    return retrieve::guess_motions(scan, earlier->view(), file.view(),
                                   seconds_between(before->time, scan.time));
}

}  // namespace

Result<std::optional<retrieve::TrackedScan>> AreaWatch::look(UtcTime now) {
    const auto store = cache::StoreReader::open(cache_);
    if (!store) return pass_on(store);
    const UtcTime from = now - history;
    const auto entries = store->list(area_, level2::Moment::ref, from, now + tolerated_future);
    if (!entries) return pass_on(entries);
    Status has_grids;
    if (entries->empty())
        has_grids = fail(ErrorCode::not_found, "{}: no REF grids of the last {} hours in {}", area_,
                         history.count(), cache_.native());
    has_grids_.note(has_grids);
    std::erase_if(scans_, [&](const retrieve::CellScan& scan) { return scan.time < from; });
    damaged_.erase(damaged_.begin(), damaged_.lower_bound(from));
    return read_new(*entries) ? newest(now) : std::nullopt;
}

// Reads grids that are new, the oldest first. Returns true if no new grid is left.
bool AreaWatch::read_new(const std::vector<cache::StoreEntry>& entries) {
    int count = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const UtcTime time = entries[i].time;
        const bool is_read =
            std::ranges::find(scans_, time, &retrieve::CellScan::time) != scans_.end();
        if (is_read || damaged_.contains(time)) continue;
        if (count++ == most_in_a_look) return false;
        const auto done =
            read(entries[i], i > 0 ? &entries[i - 1] : nullptr, i + 1 == entries.size());
        if (done || is_shortage(done.error().code)) continue;
        say(LogLevel::warning, "{}: no cells from a grid: {}", area_, done.error().message);
        damaged_.insert(time);
    }
    return true;
}

// Finds the cells of a grid. Returns false if the grid will be replaced.
Result<bool> AreaWatch::read(const cache::StoreEntry& entry, const cache::StoreEntry* before,
                             bool is_last) {
    const auto file = cache::GridFile::open(entry.path);
    if (!file) return pass_on(file);
    const grid::Provenance& provenance = file->description().provenance;
    if (is_last && (provenance.partial || provenance.provisional)) return false;
    auto scan = retrieve::find_cells(
        {.reflectivity = file->view(), .azimuthal_shear = std::nullopt, .freezing = freezing_},
        entry.time, area_);
    if (!scan) return pass_on(scan);
    if (Status moved = add_motion(*scan, *file, before); !moved) return pass_on(moved);
    if (Status whole = file->check_whole(); !whole) return pass_on(whole);
    scans_.push_back(std::move(*scan));
    return true;
}

Result<std::optional<retrieve::TrackedScan>> AreaWatch::newest(UtcTime now) {
    if (scans_.empty()) return std::nullopt;
    const UtcTime time = std::ranges::max_element(scans_, {}, &retrieve::CellScan::time)->time;
    if (time < now - oldest_news || (reported_ && time <= *reported_)) return std::nullopt;
    reported_ = time;
    auto tracked = retrieve::track_cells(scans_);
    if (!tracked) return pass_on(tracked);
    if (tracked->empty()) return std::nullopt;
    return std::move(tracked->back());
}

}  // namespace stormcellar::notify
