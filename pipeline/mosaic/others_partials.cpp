// Partials that other machines made, as they come (MosaicMaker::take_partial).
#include "pipeline/keep/keep_rule.h"
#include "pipeline/keep/site_grids.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {
namespace {

// Checks that the grid is what its name says, and a part of this domain.
Status check(const OthersPartial& partial, const cache::GridDescription& grid,
             const Domain& domain) {
    const std::string station = partial.name.domain.substr(domain.name.size() + 1);
    const bool is_named = grid.moment == partial.name.moment && grid.time == partial.name.time &&
                          grid.sites.size() == 1 && grid.sites.front().icao == station;
    if (!is_named) {
        return fail(ErrorCode::corrupt, "{}: is not the grid that its name says",
                    partial.file.native());
    }
    if (!domain.takes(station)) {
        return fail(ErrorCode::bad_argument, "{}: the domain {} does not take {}",
                    partial.file.native(), domain.name, station);
    }
    if (!grid::window_of(domain.spec, grid.spec)) {
        return fail(ErrorCode::bad_argument,
                    "{}: its columns are not those of the domain {}; both machines must have the "
                    "same [[domain]]",
                    partial.file.native(), domain.name);
    }
    return {};
}

}  // namespace

Result<Kept> MosaicMaker::take_partial(const OthersPartial& partial, int threads) {
    const auto file = cache::GridFile::open(partial.file);
    if (!file) return pass_on(file);
    const Domain* const domain =
        is_idle() ? nullptr : find(cache::group_of(partial.name.domain), partial.name.moment);
    if (domain == nullptr || !cache::is_part(partial.name.domain)) {
        return fail(ErrorCode::bad_argument, "{}: the configuration has no domain {} of {}",
                    partial.file.native(), cache::group_of(partial.name.domain),
                    level2::moment_name(partial.name.moment));
    }
    const cache::GridDescription& grid = file->description();
    if (Status good = check(partial, grid, *domain); !good) return pass_on(good);
    if (Status sound = file->verify(); !sound) return pass_on(sound);

    const PartialView view{&grid, file->view(), nullptr};
    if (sources_) {
        sources_->brought(partial.machine, domain->name, partial.name.moment, view.site().icao,
                          view.middle());
    }
    const std::scoped_lock lock(frames_of(domain->name, partial.name.moment));
    const auto path = store_->path_of(partial.name.domain, partial.name.moment, partial.name.time);
    if (!path) return pass_on(path);
    Kept kept;
    const auto stands = cache::GridFile::open(*path);
    if (stands && stands->checksum() == file->checksum()) return kept;
    if (reason_to_keep(*path, {grid, view.view, true})) return kept;
    const auto committed = store_->commit(partial.name.domain, grid, view.view);
    if (!committed) return of_storing(committed.error());
    // Zeros are read where a map was cut meanwhile.
    if (Status whole = file->check_whole(); !whole) {
        cache::StoreEntry entry;
        entry.domain = partial.name.domain;
        entry.moment = partial.name.moment;
        entry.time = partial.name.time;
        (void)store_->remove(entry);
        return pass_on(whole);
    }
    if (committed->empty()) return kept;  // older than what the budgets keep
    kept.partials.push_back(*committed);
    if (Status made = refresh(*domain, partial.name.moment, grid, threads, kept); !made)
        return pass_on(made);
    return kept;
}

}  // namespace stormcellar::pipeline
