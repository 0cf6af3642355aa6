#include "pipeline/keep/site_grids.h"

#include <array>
#include <chrono>
#include <utility>

#include "base/steady_time.h"
#include "grid/judge/audit.h"
#include "grid/plan/position_error.h"
#include "level2/decode/volume_checks.h"
#include "pipeline/keep/keep_rule.h"
#include "stormcellar/cache/budget.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

}  // namespace

tl::unexpected<Error> of_gridding(Error error) {
    if (is_shortage(error.code) || error.code == ErrorCode::io)
        return tl::unexpected<Error>(std::move(error));
    return tl::unexpected<Error>(caused_by(Cause::data, std::move(error)));
}

void note_not_kept(const std::string& station, IngestOutcome& outcome) {
    ++outcome.not_kept;
    outcome.reason = cache::is_known_group(station)
                         ? "no grid was kept: it would be older than all that the cache keeps"
                         : "no grid was kept: the cache has no more room for unknown stations";
}

tl::unexpected<Error> of_storing(Error error) {
    const bool may_be_of_file = error.cause() == Cause::data || error.code == ErrorCode::permission;
    if (!error.known_cause && may_be_of_file) error.known_cause = Cause::system;
    return tl::unexpected<Error>(std::move(error));
}

void note_not_derived(level2::Moment moment, const Error& why, IngestOutcome& outcome) {
    outcome.reason = fmt::format("no grid of {}: {}", level2::moment_name(moment), why.message);
}

void note_no_room(IngestOutcome& outcome, const Error& why) {
    ++outcome.not_kept;
    outcome.no_room = true;
    outcome.reason = "no grid was kept: " + why.message;
}

bool SiteGrids::has_place(const level2::Volume& volume, IngestOutcome& outcome) {
    if (level2::antenna_position(volume) && !volume.station.empty()) return true;
    outcome.ending = ended::NoPosition{};
    outcome.reason = "neither the file nor the station table gives the radar's position";
    return false;
}

Result<SiteGrids::Made> SiteGrids::make(const level2::Volume& volume, level2::Moment moment,
                                        const GridSource& source, int threads) {
    const auto antenna = level2::antenna_position(volume);
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    grid::GridSpec spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    spec.spacing_m = options_.spacing_m;
    spec.nx = options_.nx;
    spec.ny = options_.ny;
    if (!options_.levels_m.empty()) spec.levels_m = options_.levels_m;
    const auto geometry = geometries_.get(site, spec);
    if (!geometry) return of_gridding(geometry.error());
    Made made;
    made.gridder.moment = moment;
    made.gridder.threads = threads;
    auto gridded = grid::make_grid(volume, site, **geometry, made.gridder);
    if (!gridded) return of_gridding(gridded.error());
    made.grid = std::move(*gridded);
    grid::Provenance& provenance = made.grid.provenance;
    provenance.predicted_error =
        grid::unplanned_error(volume, site, spec, (*geometry)->frame_kind(), made.gridder);
    provenance.source_files = {level2::volume_name(volume.station, made.grid.time)};
    provenance.partial = source.partial;
    provenance.radar_troubles = source.radar_troubles;
    if (antenna->disagreement) provenance.notes.push_back(*antenna->disagreement);
    provenance.notes.insert(provenance.notes.end(), source.notes.begin(), source.notes.end());
    return made;
}

// Audits and commits a grid. If the audit fails, commits the grid without an audit.
Result<fs::path> SiteGrids::commit(Made& made, const level2::Volume& volume,
                                   const GridSource& source, Living living,
                                   IngestOutcome& outcome) {
    grid::Grid& grid = made.grid;
    const std::string& domain = grid.sites.front().icao;
    auto path = store_.path_of(domain, grid.moment, grid.time);
    if (!path) return of_gridding(path.error());
    const auto bricks =
        grid::BrickGrid::from(grid, grid::default_quantization(grid.moment), made.gridder.threads);
    if (living == Living::no) {
        const auto audited = grid::audit(bricks.view(), volume, grid.sites.front(), made.gridder);
        if (audited) grid.provenance.audit = audited->rows;
    }
    const MutexLock lock(commits_.at(fs::hash_value(*path) % commits_.size()));
    const cache::GridDescription description = cache::describe(grid);
    auto reason = reason_to_keep(*path, {description, bricks.view(), source.has_rival});
    if (!reason) return pass_on(reason);
    if (*reason) {
        outcome.reason = std::move(**reason);
        return path;
    }
    return store_.commit(
        domain, description, bricks.view(),
        living == Living::yes ? cache::Durability::until_a_crash : cache::Durability::power_cut);
}

// Grids the moments one by one. If the cache does not keep the grid of one moment, goes on with the
// other moments.
Status SiteGrids::keep(const level2::Volume& volume, const GridSource& source, int threads,
                       IngestOutcome& outcome,
                       const std::function<void(const level2::Volume&)>& use_dealiased) {
    if (!has_place(volume, outcome)) return {};
    std::optional<level2::Volume> dealiased;
    for (const level2::Moment moment : options_.moments) {
        if (!level2::holds(volume, level2::measured_moment(moment))) continue;
        Status kept = keep_moment(volume, moment, source, threads, dealiased, outcome);
        if (!kept) return kept;
    }
    if (use_dealiased && dealiased) use_dealiased(*dealiased);
    return {};
}

// Returns the volume from which to grid the moment: `measured` for a measured moment, and `judged`,
// a copy with POW, for POW. For a moment that comes from velocities, adds the moment to
// `dealiased`, a copy with VELD, and returns that copy. The copy `dealiased` is made for the first
// such moment. If the moment cannot be derived from this volume, leaves a remark in the outcome,
// because the other moments are still good.
Result<SiteGrids::UsedVolume> SiteGrids::used_volume(const level2::Volume& measured,
                                                     level2::Moment moment,
                                                     const GridSource& source,
                                                     std::optional<level2::Volume>& dealiased,
                                                     std::optional<level2::Volume>& judged,
                                                     IngestOutcome& outcome) const {
    UsedVolume used{&measured, source};
    if (!level2::facts_of(moment).is_derived) return used;
    const auto give_up = [&](const Error& why) -> Result<UsedVolume> {
        if (why.code != ErrorCode::not_found) return tl::unexpected<Error>(why);
        note_not_derived(moment, why, outcome);
        return UsedVolume{};
    };
    if (!level2::is_dealiased(moment)) {
        auto made = retrieve::derived_velocities(measured, std::array{moment}, derived_);
        if (!made) return give_up(made.error());
        judged = std::move(made->volume);
        used.volume = &*judged;
        return used;
    }
    if (!dealiased) {
        auto made =
            retrieve::derived_velocities(measured, std::array{level2::Moment::veld}, derived_);
        if (!made) return give_up(made.error());
        dealiased = std::move(made->volume);
    }
    used.volume = &*dealiased;
    const auto notes = retrieve::add_from_dealiased(*dealiased, moment, derived_);
    if (!notes) return give_up(notes.error());
    used.source.notes.insert(used.source.notes.end(), notes->begin(), notes->end());
    return used;
}

Status SiteGrids::keep_moment(const level2::Volume& measured, level2::Moment moment,
                              const GridSource& source, int threads,
                              std::optional<level2::Volume>& dealiased, IngestOutcome& outcome) {
    if (!store_.would_keep(measured.station, moment, measured.start_time().value_or(UtcTime{}))) {
        note_not_kept(measured.station, outcome);
        return {};
    }
    const auto start = Clock::now();
    std::optional<level2::Volume> judged;
    const auto used = used_volume(measured, moment, source, dealiased, judged, outcome);
    if (!used) return pass_on(used);
    if (used->volume == nullptr) return {};
    const level2::Volume& volume = *used->volume;
    auto made = make(volume, moment, used->source, threads);
    if (!made) return pass_on(made);
    outcome.grid_s += seconds_since(start);
    outcome.partial = outcome.partial || source.partial;

    const auto commit_start = Clock::now();
    auto path = commit(*made, volume, source, Living::no, outcome);
    outcome.commit_s += seconds_since(commit_start);
    if (!path && path.error().code == ErrorCode::over_budget) {
        note_no_room(outcome, path.error());
        return {};
    }
    if (!path) return of_storing(path.error());
    if (path->empty()) {
        note_not_kept(volume.station, outcome);
    } else {
        remove_other_times(store_, volume.station, moment, volume, source.file);
        keep_to_an_hours_volumes(store_, volume.station, moment,
                                 volume.start_time().value_or(UtcTime{}));
        outcome.grids.push_back(std::move(*path));
    }
    return {};
}

Status SiteGrids::keep_living(const level2::Volume& volume, level2::Moment moment,
                              const GridSource& source, int threads, IngestOutcome& outcome) {
    const bool has_place = level2::antenna_position(volume) && !volume.station.empty();
    if (!has_place ||
        !store_.would_keep(volume.station, moment, volume.start_time().value_or(UtcTime{}))) {
        return {};
    }
    const auto start = Clock::now();
    auto made = make(volume, moment, source, threads);
    if (!made) return pass_on(made);
    outcome.grid_s += seconds_since(start);
    const auto commit_start = Clock::now();
    auto path = commit(*made, volume, source, Living::yes, outcome);
    outcome.commit_s += seconds_since(commit_start);
    // Report no lack of room now. The grid of the complete volume will report it.
    if (!path && path.error().code == ErrorCode::over_budget) return {};
    if (!path) return of_storing(path.error());
    if (!path->empty()) outcome.living.push_back(std::move(*path));
    return {};
}

}  // namespace stormcellar::pipeline
