#include "cli/accuracy/site_pairs_accuracy.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/grid/grid_mosaic.h"
#include "cli/shared/commands.h"
#include "cli/shared/progress.h"
#include "pipeline/mosaic/pair_comparison.h"

namespace stormcellar::cli {
namespace {

std::string text_of(const grid::Estimate& estimate) {
    if (!estimate.untold.empty()) return "-";
    return fmt::format("{:+.2f} +- {:.2f}", estimate.value, estimate.standard_error);
}

nlohmann::ordered_json json_of(const grid::Estimate& estimate) {
    if (!estimate.untold.empty()) return {{"untold", estimate.untold}};
    return {{"value", estimate.value}, {"standard_error", estimate.standard_error}};
}

// Returns lines that say why quantities are undetermined. If all four quantities have the same
// reason, for example too little echo, returns a single line.
std::vector<std::string> not_told_of(const grid::SiteComparison& pair) {
    const std::string& why = pair.bias_db.untold;
    const bool all = !why.empty() && pair.azimuth_deg.untold == why &&
                     pair.elevation_deg.untold == why && pair.time_s.untold == why;
    if (!all) return grid::untold(pair);
    return {fmt::format("{} against {}: nothing can be determined: {}", pair.b, pair.a, why)};
}

void add_lines(const std::vector<std::string>& lines, bool markdown, std::string& text) {
    for (const std::string& line : lines)
        text += (markdown ? "- " : "  ") + line + "\n";
}

}  // namespace

Result<SitePairs> compare_site_files(const std::vector<std::string>& files,
                                     const GridRequest& request, const EffectRequest& effects,
                                     bool shows_progress) {
    if (request.moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument, "sites can only be compared by REF, not by {}",
                    level2::moment_name(request.moment));
    }
    const auto sources = load_mosaic(files, request);
    if (!sources) return pass_on(sources);
    pipeline::GeometryCache geometries(pipeline::mosaic_geometries);
    const auto volumes = sources->scene_volumes();
    const auto partials =
        pipeline::grid_volumes(volumes, mosaic_request(*sources, request, {}, effects), geometries);
    if (!partials) return pass_on(partials);
    const std::vector<pipeline::PartialView> views = pipeline::views_of(*partials);
    SitePairs compared;
    compared.instant = request.frame_time.value_or(pipeline::instant_of_newest(views));
    const auto looks = pipeline::looks_about(views, compared.instant);
    if (looks.size() < 2) {
        return fail(ErrorCode::bad_argument, "--compare-sites needs files of two or more sites");
    }
    Progress progress("pairs", looks.size() * (looks.size() - 1) / 2, shows_progress);
    std::size_t done = 0;
    for (std::size_t a = 0; a < looks.size(); ++a) {
        compared.stations.push_back(looks[a].site().icao);
        for (std::size_t b = a + 1; b < looks.size(); ++b) {
            progress.show(done++);
            if (!pipeline::may_overlap(looks[a].site(), looks[b].site())) continue;
            auto found = pipeline::compare_looks(looks[a], looks[b], compared.instant);
            if (!found) return pass_on(found);
            compared.pairs.push_back(std::move(*found));
        }
    }
    return compared;
}

std::string format_site_pairs(const SitePairs& compared, bool markdown) {
    const std::string_view line = markdown
                                      ? "| {} | {} | {} | {} | {} | {} | {} | {} |\n"
                                      : "{:<18} {:>14} {:>14} {:>14} {:>16} {:>7} {:>7} {:>7}\n";
    const auto row_of = [&](const auto&... cells) {
        return fmt::format(fmt::runtime(line), cells...);
    };
    std::string text = row_of("sites", "bias dB", "azimuth deg", "elevation deg", "time s", "cells",
                              "corr.", "apart s");
    if (markdown) text += "|---|--:|--:|--:|--:|--:|--:|--:|\n";
    std::vector<std::string> named, not_told;
    for (const grid::SiteComparison& pair : compared.pairs) {
        text += row_of(fmt::format("{} against {}", pair.b, pair.a), text_of(pair.bias_db),
                       text_of(pair.azimuth_deg), text_of(pair.elevation_deg), text_of(pair.time_s),
                       pair.cells, fmt::format("{:.2f}", pair.correlation),
                       fmt::format("{:.0f}", pair.apart_s));
        const auto faults = grid::faults(pair), untold = not_told_of(pair);
        named.insert(named.end(), faults.begin(), faults.end());
        not_told.insert(not_told.end(), untold.begin(), untold.end());
    }
    if (compared.pairs.empty()) text += "no two of these sites overlap\n";
    text += named.empty() ? "\nNo fault was found.\n" : "\nFaults found:\n\n";
    add_lines(named, markdown, text);
    if (!not_told.empty()) text += "\nWhat cannot be determined:\n\n";
    add_lines(not_told, markdown, text);
    return text;
}

nlohmann::ordered_json site_pairs_json(const SitePairs& compared) {
    nlohmann::ordered_json json;
    json["time"] = format_utc(compared.instant);
    json["stations"] = compared.stations;
    json["pairs"] = nlohmann::ordered_json::array();
    for (const grid::SiteComparison& pair : compared.pairs) {
        json["pairs"].push_back({{"a", pair.a},
                                 {"b", pair.b},
                                 {"bias_db", json_of(pair.bias_db)},
                                 {"azimuth_deg", json_of(pair.azimuth_deg)},
                                 {"elevation_deg", json_of(pair.elevation_deg)},
                                 {"time_s", json_of(pair.time_s)},
                                 {"cells", pair.cells},
                                 {"blocks", pair.blocks},
                                 {"deviation_db", pair.deviation_db},
                                 {"correlation", pair.correlation},
                                 {"apart_s", pair.apart_s},
                                 {"faults", grid::faults(pair)}});
    }
    return json;
}

int run_site_pairs(const GridOptions& options, const GridRequest& request,
                   const EffectRequest& effects, bool markdown) {
    const auto compared = compare_site_files(options.files, request, effects, !options.json);
    if (!compared) return report_error(compared.error());
    if (options.json) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        fmt::print("{}\n", site_pairs_json(*compared).dump(1, ' ', true, replace));
        return exit_done;
    }
    fmt::print("How the two sites of each pair differ, at {}:\n\n{}", format_utc(compared->instant),
               format_site_pairs(*compared, markdown));
    return exit_done;
}

}  // namespace stormcellar::cli
