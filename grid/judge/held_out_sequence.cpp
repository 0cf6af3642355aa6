#include "grid/judge/held_out_sequence.h"

#include <chrono>
#include <set>

#include <fmt/format.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::grid {
namespace {

double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

// A volume that was gridded on the columns that all volumes of the sequence share.
struct Gridded {
    BrickGrid bricks;
    UtcTime middle;
};

Result<Gridded> grid_one(const TimedVolume& timed, const ColumnGeometry& geometry,
                         const GridderOptions& options) {
    auto made = make_grid(timed.volume, timed.site, geometry, options);
    if (!made) return fail(made.error().code, "{}: {}", timed.name, made.error().message);
    const UtcTime middle = made->start_time + (made->end_time - made->start_time) / 2;
    return Gridded{BrickGrid::from(*made, default_quantization(options.moment)), middle};
}

// For each sweep of the volume, makes the gridder prefer the middle time of that sweep, and notes
// which sweep the gridder chooses at the lowest elevation. Returns all noted sweeps.
std::set<std::size_t> lowest_sweeps(const level2::Volume& volume, const SitePosition& site,
                                    level2::Moment moment) {
    std::set<std::size_t> found;
    for (const level2::Sweep& sweep : volume.sweeps) {
        if (sweep.radials.empty()) continue;
        const double half_beam_deg = beam_width_of(site.icao) / 2;
        const UtcTime middle = sweep.radials[sweep.radials.size() / 2].time;
        const auto chosen = choose_sweeps(volume, moment, half_beam_deg, middle);
        if (!chosen.empty()) found.insert(chosen.front().sweep_index);
    }
    return found;
}

}  // namespace

Result<std::vector<TimedVolume>> repeats_of(const level2::Volume& volume, const SitePosition& site,
                                            level2::Moment moment) {
    std::vector<TimedVolume> sequence;
    for (const std::size_t index : lowest_sweeps(volume, site, moment)) {
        TimedVolume timed{volume, site, fmt::format("sweep {}", index)};
        level2::Sweep kept = std::move(timed.volume.sweeps[index]);
        timed.volume.sweeps.clear();
        timed.volume.sweeps.push_back(std::move(kept));
        sequence.push_back(std::move(timed));
    }
    if (sequence.size() < least_sequence) {
        return fail(
            ErrorCode::not_found,
            "its lowest cut was scanned {} times; to hold one out, there must be at least three",
            sequence.size());
    }
    return sequence;
}

Result<std::vector<HeldOutRow>> score_sequence(
    const std::vector<TimedVolume>& sequence, const GridSpec& spec, const GridderOptions& options,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
    const std::size_t total = 2 * sequence.size() - 2;
    std::size_t done = 0;
    const auto one_done = [&] {
        if (progress) progress(++done, total);
    };
    const auto geometry = make_column_geometry(sequence.front().site, spec);
    if (!geometry) return pass_on(geometry);
    std::vector<Gridded> grids;
    for (const TimedVolume& timed : sequence) {
        auto made = grid_one(timed, **geometry, options);
        if (!made) return pass_on(made);
        grids.push_back(std::move(*made));
        one_done();
    }
    std::vector<HeldOutRow> rows;
    for (std::size_t at = 1; at + 1 < grids.size(); ++at) {
        const auto view = [&](std::size_t index) {
            return TimedView{grids[index].bricks.view(), grids[index].middle};
        };
        auto scored =
            score_held_out(view(at - 1), view(at), view(at + 1), **geometry, options.threads);
        if (!scored) {
            return fail(scored.error().code, "{}: {}", sequence[at].name, scored.error().message);
        }
        rows.push_back({sequence[at].name, seconds_between(grids[at - 1].middle, grids[at].middle),
                        seconds_between(grids[at].middle, grids[at + 1].middle),
                        std::move(*scored)});
        one_done();
    }
    return rows;
}

}  // namespace stormcellar::grid
