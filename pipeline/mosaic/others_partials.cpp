// Takes in partials that other machines made (MosaicMaker::take_partial()).
#include <algorithm>
#include <chrono>
#include <string_view>

#include "grid/place/site_extent.h"
#include "pipeline/keep/keep_rule.h"
#include "pipeline/keep/site_grids.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {
namespace {

// Limits of what a partial may have, far above real numbers. They keep the texts of a frame small
// and quick to process.
constexpr std::size_t most_notes = 64;  // each: notes, and troubles of the radar
constexpr std::size_t most_files = 8;   // each: source files, and stations
constexpr std::size_t most_sweeps = 256;
constexpr std::size_t most_audit_rows = 64;
constexpr std::size_t most_text_bytes = 1024;

// The first and the last radial of a volume must be this close to its start; in real volumes they
// are within minutes.
constexpr std::chrono::hours farthest_radial_of_part{1};

// If a list in a partial's provenance is too long, returns the list's name, else an empty text.
std::string_view excess_of(const grid::Provenance& part) {
    if (part.notes.size() > most_notes || part.radar_troubles.size() > most_notes) return "notes";
    if (part.source_files.size() > most_files || part.stations.size() > most_files) return "names";
    if (part.sweeps.size() > most_sweeps) return "sweeps";
    if (part.audit.size() > most_audit_rows) return "rows of an audit";
    if (!part.parts.empty() || !part.left_out.empty()) return "parts";
    const auto is_long = [](const std::string& text) { return text.size() > most_text_bytes; };
    for (const auto* texts :
         {&part.notes, &part.radar_troubles, &part.source_files, &part.stations})
        if (std::ranges::any_of(*texts, is_long)) return "text";
    for (const auto* text : {&part.method, &part.beam_model, &part.averaging, &part.effects,
                             &part.predicted_error, &part.software_version})
        if (is_long(*text)) return "text";
    return {};
}

Status check_records(const OthersPartial& partial, const cache::GridDescription& grid) {
    if (const auto excess = excess_of(grid.provenance); !excess.empty()) {
        return fail(ErrorCode::corrupt, "{}: has more {} than a part may have",
                    partial.file.native(), excess);
    }
    const bool is_ordered = grid.start_time <= grid.end_time;
    const bool is_near = grid.start_time >= grid.time - farthest_radial_of_part &&
                         grid.end_time <= grid.time + farthest_radial_of_part;
    if (!is_ordered || !is_near) {
        return fail(ErrorCode::corrupt,
                    "{}: its radials, {} to {}, are not of the time of its name",
                    partial.file.native(), format_utc(grid.start_time), format_utc(grid.end_time));
    }
    if (!is_believed(grid.end_time, now_utc())) {
        return fail(ErrorCode::bad_argument, "{}: its radials, until {}, are of the future",
                    partial.file.native(), format_utc(grid.end_time));
    }
    return {};
}

// Checks that the description of a grid fits the grid's name, and that the grid is a window of this
// domain.
Status check(const OthersPartial& partial, const cache::GridDescription& grid,
             const Domain& domain) {
    const std::string station = partial.name.domain.substr(domain.name.size() + 1);
    const bool is_named = grid.moment == partial.name.moment && grid.time == partial.name.time &&
                          grid.sites.size() == 1 && grid.sites.front().icao == station;
    if (!is_named) {
        return fail(ErrorCode::corrupt, "{}: is not the grid that its name says",
                    partial.file.native());
    }
    if (Status good = check_records(partial, grid); !good) return good;
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

bool is_within(const grid::GridWindow& one, const grid::GridWindow& other) {
    return one.first_x >= other.first_x && one.first_y >= other.first_y &&
           one.end_x() <= other.end_x() && one.end_y() <= other.end_y();
}

// Checks that the partial can be merged with other partials. If one partial does not match, merge()
// refuses the whole frame.
Status check_cells(const OthersPartial& partial, const cache::GridFile& file,
                   const Domain& domain) {
    const cache::GridDescription& grid = file.description();
    if (Status good = grid::check_on_earth(grid.sites.front()); !good)
        return fail(ErrorCode::corrupt, "{}: {}", partial.file.native(), good.error().message);
    if (!(file.view().quantization == grid::default_quantization(grid.moment))) {
        return fail(ErrorCode::bad_argument,
                    "{}: its codes are not those of {}; both machines must have the same version",
                    partial.file.native(), level2::moment_name(grid.moment));
    }
    const auto window = grid::window_of(domain.spec, grid.spec);
    const auto reach = grid::site_window(domain.spec, grid.sites.front());
    if (!window || !grid::is_whole_bricks(domain.spec, *window)) {
        return fail(ErrorCode::corrupt, "{}: its columns are not whole bricks of the domain {}",
                    partial.file.native(), domain.name);
    }
    // Limit the window, because a merge keeps geometry that is as large as the window.
    if (!reach || !is_within(*window, *reach)) {
        return fail(ErrorCode::corrupt, "{}: its columns are further than {} reaches",
                    partial.file.native(), grid.sites.front().icao);
    }
    return {};
}

}  // namespace

Result<Kept> MosaicMaker::take_partial(const OthersPartial& partial, int threads) {
    const auto file = cache::GridFile::open(partial.file, cache::limits_of_site);
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
    if (Status good = check_cells(partial, *file, *domain); !good) return pass_on(good);
    if (Status sound = file->verify(); !sound) return pass_on(sound);

    const PartialView view{&grid, file->view(), nullptr};
    if (sources_) {
        sources_->brought(partial.machine, domain->name, partial.name.moment, view.site().icao,
                          view.middle());
    }
    Mutex& frames = frames_of(domain->name, partial.name.moment);
    const MutexLock lock(frames);
    const auto path = store_->path_of(partial.name.domain, partial.name.moment, partial.name.time);
    if (!path) return pass_on(path);
    Kept kept;
    const auto stands = cache::GridFile::open(*path);
    if (!stands && is_shortage(stands.error().code)) return pass_on(stands);
    if (stands && stands->checksum() == file->checksum()) {
        note_frames(*domain, partial, view.middle());
        return kept;
    }
    const bool are_rivals =
        stands && !stands->description().provenance.partial && !grid.provenance.partial;
    if (are_rivals) kept.won = false;
    const auto reason = reason_to_keep(*path, {grid, view.view, true});
    if (!reason) return pass_on(reason);
    if (*reason) return kept;
    if (are_rivals) kept.won = true;
    const auto committed = store_->commit(partial.name.domain, grid, view.view);
    if (!committed) return of_storing(committed.error());
    // If the file was truncated while we read it, the missing bytes read as zeros.
    if (Status whole = file->check_whole(); !whole) {
        cache::StoreEntry entry;
        entry.domain = partial.name.domain;
        entry.moment = partial.name.moment;
        entry.time = partial.name.time;
        (void)store_->remove(entry);
        return pass_on(whole);
    }
    if (committed->empty()) return kept;  // the grid is older than the cache's budgets allow
    kept.partials.push_back(*committed);
    keep_to_an_hours_volumes(*store_, partial.name.domain, partial.name.moment, partial.name.time);
    const Status made =
        refresh(*domain, partial.name.moment, grid, threads, kept, frames, partial.beat);
    if (made) return kept;
    note_frames(*domain, partial, view.middle());
    return pass_on(made);
}

}  // namespace stormcellar::pipeline
