#include "cli/accuracy/held_out_accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/accuracy/truth_errors.h"
#include "cli/grid/volume_source.h"
#include "grid/plan/grid_effects.h"
#include "stormcellar/grid/gridder.h"
#include "synth/observe.h"

namespace stormcellar::cli {
namespace {

std::string_view name_of(const grid::HeldOutScore& score) {
    return grid::time_method_name(score.method);
}

}  // namespace

Result<std::vector<grid::TimedVolume>> sequence_of(MosaicSources sources) {
    if (sources.volumes.size() < grid::least_sequence) {
        return fail(ErrorCode::bad_argument,
                    "files of one site need a --time, or there must be at least {} of them, so "
                    "that a grid can be reconstructed from the files before and after it",
                    grid::least_sequence);
    }
    std::vector<grid::TimedVolume> sequence;
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

Result<std::vector<grid::TimedVolume>> load_repeats(const std::string& file,
                                                    const GridRequest& request) {
    const auto source = load_volume(file, request);
    if (!source) return pass_on(source);
    auto repeats = grid::repeats_of(source->volume, source->site, request.moment);
    if (!repeats) return fail(repeats.error().code, "{}: {}", file, repeats.error().message);
    return repeats;
}

Result<std::vector<grid::TimedVolume>> observe_sequence(const synth::Scene& scene) {
    std::vector<grid::TimedVolume> sequence;
    sequence.reserve(grid::least_sequence);
    for (int number = 0; number < static_cast<int>(grid::least_sequence); ++number) {
        sequence.push_back({synth::observe(scene, number),
                            {scene.site.station, scene.site.latitude_deg, scene.site.longitude_deg,
                             static_cast<double>(scene.site.antenna_altitude_m)},
                            fmt::format("volume {}", number)});
    }
    return sequence;
}

Result<std::vector<grid::HeldOutRow>> score_sequence(
    const std::vector<grid::TimedVolume>& sequence, const GridRequest& request,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
    if (request.moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument,
                    "grids for an instant can only be scored by REF, not by {}",
                    level2::moment_name(request.moment));
    }
    const grid::SitePosition& site = sequence.front().site;
    const auto spec = spec_about(request, site.latitude_deg, site.longitude_deg);
    if (!spec) return pass_on(spec);
    const accuracy::Chain chain = grid::effects_of(request.moment);
    grid::GridderOptions options;
    options.moment = request.moment;
    options.threads = request.threads;
    options.method = grid::scene_choice(
                         chain, grid::default_choice(chain, *spec, grid::beam_width_of(site.icao)))
                         .method;
    return grid::score_sequence(sequence, *spec, options, progress);
}

std::string format_held_out(const std::vector<grid::HeldOutRow>& rows, bool markdown) {
    const std::string_view line =
        markdown ? "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n"
                 : "{:<28} {:>9} {:>7} {:<9} {:>7} {:>7} {:>7} {:>8} {:>10} {:>7}\n";
    const auto row_of = [&](const auto&... cells) {
        return fmt::format(fmt::runtime(line), cells...);
    };
    std::string text = row_of("held out", "-s / +s", "m/s", "method", "rms dB", "p95 dB", "mean dB",
                              "missed %", "invented %", "ms");
    if (markdown) text += "|---|--:|--:|---|--:|--:|--:|--:|--:|--:|\n";
    for (const grid::HeldOutRow& row : rows) {
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

nlohmann::ordered_json held_out_json(const std::vector<grid::HeldOutRow>& rows) {
    auto list = nlohmann::ordered_json::array();
    for (const grid::HeldOutRow& row : rows) {
        for (const grid::HeldOutScore& score : row.held_out.scores) {
            nlohmann::ordered_json& item = list.emplace_back();
            item["held_out"] = row.name;
            item["before_s"] = row.before_s;
            item["after_s"] = row.after_s;
            item["method"] = name_of(score);
            add_errors(score.error, item);
            item["mean"] = score.mean_db;
            item["echo_missed"] = score.echo_missed;
            item["echo_invented"] = score.echo_invented;
            item["time_s"] = score.seconds;
            item["motion_mps"] = nullptr;
            if (const auto& motion = row.held_out.motion_mps) {
                item["motion_mps"] = {motion->x, motion->y};
            }
        }
    }
    return list;
}

}  // namespace stormcellar::cli
