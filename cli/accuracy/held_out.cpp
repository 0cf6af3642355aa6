#include "cli/accuracy/held_out.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/grid/volume_source.h"
#include "grid/plan/effects.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "synth/observe.h"

namespace stormcellar::cli {
namespace {

constexpr std::size_t fewest = 3;

double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

// A volume on the columns that all volumes of the sequence share.
struct Gridded {
    grid::BrickGrid bricks;
    UtcTime middle;
};

Result<Gridded> grid_one(const TimedVolume& timed, const grid::ColumnGeometry& geometry,
                         const grid::GridderOptions& options) {
    auto made = grid::make_grid(timed.volume, timed.site, geometry, options);
    if (!made) return fail(made.error().code, "{}: {}", timed.name, made.error().message);
    const UtcTime middle = made->start_time + (made->end_time - made->start_time) / 2;
    return Gridded{grid::BrickGrid::from(*made, grid::default_quantization(options.moment)),
                   middle};
}

// Returns the sweeps of the lowest elevation that the gridder would take at some time.
std::set<std::size_t> lowest_sweeps(const level2::Volume& volume, const grid::SitePosition& site,
                                    level2::Moment moment) {
    std::set<std::size_t> found;
    for (const level2::Sweep& sweep : volume.sweeps) {
        if (sweep.radials.empty()) continue;
        const double half_beam_deg = grid::beam_width_of(site.icao) / 2;
        const UtcTime middle = sweep.radials[sweep.radials.size() / 2].time;
        const auto chosen = grid::choose_sweeps(volume, moment, half_beam_deg, middle);
        if (!chosen.empty()) found.insert(chosen.front().sweep_index);
    }
    return found;
}

std::string_view name_of(const grid::HeldOutScore& score) {
    return grid::time_method_name(score.method);
}

}  // namespace

Result<std::vector<TimedVolume>> sequence_of(MosaicSources sources) {
    if (sources.volumes.size() < fewest) {
        return fail(ErrorCode::bad_argument,
                    "of one site it takes {} FILEs or more, each to be made again from its "
                    "neighbours, or a --time",
                    fewest);
    }
    std::vector<TimedVolume> sequence;
    for (std::size_t at = 0; at < sources.volumes.size(); ++at) {
        SourceVolume& source = sources.volumes[at];
        sequence.push_back({std::move(source.volume), source.site,
                            std::filesystem::path(sources.files[at]).filename().string()});
    }
    std::stable_sort(sequence.begin(), sequence.end(), [](const auto& a, const auto& b) {
        return a.volume.start_time() < b.volume.start_time();
    });
    return sequence;
}

Result<std::vector<TimedVolume>> load_repeats(const std::string& file, const GridRequest& request) {
    auto source = load_volume(file, request);
    if (!source) return pass_on(source);
    std::vector<TimedVolume> sequence;
    for (const std::size_t index : lowest_sweeps(source->volume, source->site, request.moment)) {
        TimedVolume timed{source->volume, source->site, fmt::format("sweep {}", index)};
        level2::Sweep kept = std::move(timed.volume.sweeps[index]);
        timed.volume.sweeps.clear();
        timed.volume.sweeps.push_back(std::move(kept));
        sequence.push_back(std::move(timed));
    }
    if (sequence.size() < fewest) {
        return fail(ErrorCode::not_found,
                    "{}: its lowest cut was scanned {} times; to hold one out takes three", file,
                    sequence.size());
    }
    return sequence;
}

Result<std::vector<TimedVolume>> observe_sequence(const synth::Scene& scene) {
    std::vector<TimedVolume> sequence;
    sequence.reserve(fewest);
    for (int number = 0; number < static_cast<int>(fewest); ++number) {
        sequence.push_back({synth::observe(scene, number),
                            {scene.site.station, scene.site.latitude_deg, scene.site.longitude_deg,
                             static_cast<double>(scene.site.antenna_altitude_m)},
                            fmt::format("volume {}", number)});
    }
    return sequence;
}

Result<std::vector<HeldOutRow>> score_sequence(const std::vector<TimedVolume>& sequence,
                                               const GridRequest& request) {
    if (request.moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument, "grids for an instant are scored by REF, not {}",
                    level2::moment_name(request.moment));
    }
    const grid::SitePosition& site = sequence.front().site;
    const auto [latitude_deg, longitude_deg] =
        request.center_deg.value_or(std::array<double, 2>{site.latitude_deg, site.longitude_deg});
    const auto spec = spec_about(request, latitude_deg, longitude_deg);
    if (!spec) return pass_on(spec);
    const auto geometry = grid::make_column_geometry(site, *spec);
    if (!geometry) return pass_on(geometry);
    const accuracy::Chain chain = grid::effects_of(request.moment);
    grid::GridderOptions options;
    options.moment = request.moment;
    options.threads = request.threads;
    options.method = grid::scene_choice(
                         chain, grid::default_choice(chain, *spec, grid::beam_width_of(site.icao)))
                         .method;
    std::vector<Gridded> grids;
    for (const TimedVolume& timed : sequence) {
        auto made = grid_one(timed, **geometry, options);
        if (!made) return pass_on(made);
        grids.push_back(std::move(*made));
    }
    std::vector<HeldOutRow> rows;
    for (std::size_t at = 1; at + 1 < grids.size(); ++at) {
        const auto view = [&](std::size_t index) {
            return grid::TimedView{grids[index].bricks.view(), grids[index].middle};
        };
        auto scored =
            grid::score_held_out(view(at - 1), view(at), view(at + 1), **geometry, request.threads);
        if (!scored) {
            return fail(scored.error().code, "{}: {}", sequence[at].name, scored.error().message);
        }
        rows.push_back({sequence[at].name, seconds_between(grids[at - 1].middle, grids[at].middle),
                        seconds_between(grids[at].middle, grids[at + 1].middle),
                        std::move(*scored)});
    }
    return rows;
}

std::string format_held_out(const std::vector<HeldOutRow>& rows, bool markdown) {
    const std::string_view line =
        markdown ? "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n"
                 : "{:<28} {:>9} {:>7} {:<9} {:>7} {:>7} {:>7} {:>8} {:>10} {:>7}\n";
    const auto row_of = [&](const auto&... cells) {
        return fmt::format(fmt::runtime(line), cells...);
    };
    std::string text = row_of("held out", "-s / +s", "m/s", "method", "rms dB", "p95 dB", "mean dB",
                              "missed %", "invented %", "ms");
    if (markdown) text += "|---|--:|--:|---|--:|--:|--:|--:|--:|--:|\n";
    for (const HeldOutRow& row : rows) {
        const auto& motion = row.held_out.motion_mps;
        const std::string apart = fmt::format("{:.0f} / {:.0f}", row.before_s, row.after_s);
        const std::string speed =
            motion ? fmt::format("{:.1f}", std::hypot(motion->x, motion->y)) : "-";
        for (const grid::HeldOutScore& score : row.held_out.scores) {
            const auto number = [](double value, int digits) {
                return fmt::format("{:.{}f}", value, digits);
            };
            text += row_of(row.name, apart, speed, name_of(score), number(score.error.rms, 2),
                           number(score.error.p95, 1), number(score.mean_db, 2),
                           number(100 * score.echo_missed, 1), number(100 * score.echo_invented, 1),
                           number(1000 * score.seconds, 0));
        }
    }
    return text;
}

nlohmann::ordered_json held_out_json(const std::vector<HeldOutRow>& rows) {
    auto list = nlohmann::ordered_json::array();
    for (const HeldOutRow& row : rows) {
        for (const grid::HeldOutScore& score : row.held_out.scores) {
            nlohmann::ordered_json item{{"held_out", row.name},
                                        {"before_s", row.before_s},
                                        {"after_s", row.after_s},
                                        {"method", name_of(score)},
                                        {"count", score.error.count},
                                        {"rms", score.error.rms},
                                        {"p95", score.error.p95},
                                        {"p99", score.error.p99},
                                        {"max", score.error.max},
                                        {"mean", score.mean_db},
                                        {"echo_missed", score.echo_missed},
                                        {"echo_invented", score.echo_invented},
                                        {"time_s", score.seconds}};
            item["motion_mps"] = nullptr;
            if (const auto& motion = row.held_out.motion_mps) {
                item["motion_mps"] = {motion->x, motion->y};
            }
            list.push_back(std::move(item));
        }
    }
    return list;
}

}  // namespace stormcellar::cli
