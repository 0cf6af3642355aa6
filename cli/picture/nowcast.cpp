// stormcellar nowcast: moves the latest echo up to an hour ahead, and measures how well that works.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

#include "base/number_list.h"
#include "cli/grid/surface_options.h"
#include "cli/picture/cell_scans.h"
#include "cli/picture/nowcast_grids.h"
#include "cli/picture/nowcast_text.h"
#include "cli/picture/scene_arguments.h"
#include "cli/picture/still_output.h"
#include "cli/shared/output_file.h"
#include "render/options/still_frame.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/render/product.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

struct NowcastCommand {
    NowcastSource source;
    std::string minutes = "5,10,15,20,25,30,35,40,45,50,55,60";
    std::string output;  // empty: only the table
    bool json = false;
    SceneOptions scene;
};

// Everything from which a nowcast is made.
struct NowcastData {
    std::vector<PictureGrid> grids;
    std::vector<retrieve::TimedGrid> timed;
    retrieve::PairMotions motions;
    int threads = 1;

    [[nodiscard]] const PictureGrid& latest() const { return grids.back(); }
};

Result<std::vector<double>> parse_leads(const std::string& text) {
    auto leads = parse_numbers(text, ',');
    if (!leads) {
        return fail(ErrorCode::bad_argument, "--minutes takes numbers, as in 15,30,60, not '{}'",
                    text);
    }
    for (const double minutes : *leads) {
        if (Status fine = retrieve::check_lead(minutes); !fine)
            return fail(fine.error().code, "--minutes: {}", fine.error().message);
    }
    std::ranges::sort(*leads);
    leads->erase(std::unique(leads->begin(), leads->end()), leads->end());
    return std::move(*leads);
}

const grid_export::GridFormat* grid_format_of(const std::string& output) {
    return output.empty() ? nullptr : grid_export::grid_format_of(output);
}

Result<render::Scene> scene_to_draw(const NowcastCommand& command) {
    auto scene = render::scene_of(command.scene);
    if (!scene) return scene;
    const render::ProductFacts& product = render::facts_of(scene->product);
    if (product.is_of_sweep || product.is_over_time || scene->moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument,
                    "a nowcast is a grid of reflectivity; it has no {} of {}",
                    render::product_name(scene->product), level2::moment_name(scene->moment));
    }
    if (command.output.empty()) return scene;
    if (grid_format_of(command.output) != nullptr) {
        if (command.scene.overlay.empty()) return scene;
        return fail(ErrorCode::bad_argument, "{}: holds data without marks; leave out --overlay",
                    command.output);
    }
    if (Status fits = check_overlay_output(command.output, command.scene.overlay); !fits)
        return pass_on(fits);
    const Status fits = check_still_output(command.output, scene->product, command.json);
    if (!fits) return pass_on(fits);
    return scene;
}

// Returns the name of the file for a lead: as typed for one lead, else with the minutes before the
// ending, as in storm-05.png.
std::string output_name(const std::string& output, const std::vector<double>& leads, double lead) {
    if (leads.size() == 1) return output;
    fs::path path(output);
    const std::string ending = path.extension().native();
    path.replace_extension();
    return path.native() + fmt::format("-{:02.3g}", lead) + ending;
}

Status write_grid(const std::string& output, const cache::GridDescription& description,
                  const grid::BrickView& view) {
    grid::Grid grid = grid::to_dense(view);
    grid.moment = description.moment;
    grid.time = description.time;
    grid.start_time = description.start_time;
    grid.end_time = description.end_time;
    grid.sites = description.sites;
    grid.provenance = description.provenance;
    const grid_export::GridFormat& format = *grid_format_of(output);
    const auto options = parse_surfaces({}, format, std::span(&grid.moment, 1));
    if (!options) return pass_on(options);
    return format.write(real_file_system(), output, std::span(&grid, 1), *options);
}

// Finds the storm cells of the grids if pictures mark cells; otherwise returns none. Each picture
// moves the cells to its own time.
Result<std::optional<render::CellOverlay>> cells_to_mark(const NowcastCommand& command,
                                                         const NowcastData& data,
                                                         const render::Scene& scene) {
    std::optional<render::CellOverlay> cells;
    if (!render::marks_cells(command.scene) || command.output.empty()) return cells;
    const auto freezing = chosen_freezing_levels(command.scene, scene);
    std::vector<retrieve::CellScan> scans;
    for (std::size_t i = 0; i < data.grids.size(); ++i) {
        auto scan = scan_grid(data.grids[i], nullptr, i > 0 ? &data.grids[i - 1] : nullptr,
                              command.source.domain, freezing);
        if (!scan) return pass_on(scan);
        scans.push_back(std::move(*scan));
    }
    auto found = overlay_of(scans);
    if (!found) return pass_on(found);
    cells = std::move(*found);
    return cells;
}

Status write_picture(const NowcastCommand& command, const std::string& output,
                     const render::StillSource& source, const render::Scene& scene) {
    const render::StillWriting writing{.format = still_format(output),
                                       .tiff = render::TiffContent::values,
                                       .error = {},
                                       .threads = render::thread_count(command.scene),
                                       .drawn = {}};
    const auto bytes = render::encode_still(source, scene, writing);
    if (!bytes) return pass_on(bytes);
    return write_still(output, *bytes);
}

// Makes and writes the nowcast of each lead. Returns the names of the files. All pictures have the
// view that fits the latest grid.
Result<std::vector<std::string>> write_nowcasts(const NowcastCommand& command,
                                                const NowcastData& data, render::Scene scene,
                                                const std::vector<retrieve::LeadScore>& scores,
                                                const std::vector<double>& leads) {
    std::vector<std::string> written;
    const grid::BrickView latest = data.latest().view();
    const cache::GridDescription& observed = data.latest().description();
    const std::string& domain = command.source.domain;
    if (Status fitted = render::fit_to_grid({domain, latest, observed, command.scene}, scene);
        !fitted)
        return pass_on(fitted);
    const auto cells = cells_to_mark(command, data, scene);
    if (!cells) return pass_on(cells);
    const auto shapes = render::read_shapes(command.scene);
    if (!shapes) return pass_on(shapes);
    const render::Overlays overlays{.cells = *cells ? &**cells : nullptr,
                                    .shapes = *shapes ? &**shapes : nullptr};
    for (const retrieve::LeadScore& score : scores) {
        const auto moved = retrieve::nowcast(latest, data.motions, score.minutes, data.threads);
        if (!moved) return pass_on(moved);
        const auto description =
            describe_nowcast(observed, score.minutes, retrieve::score_text(score));
        const std::string output = output_name(command.output, leads, score.minutes);
        const grid::BrickView view = moved->view();
        const Status done =
            grid_format_of(output) != nullptr
                ? write_grid(output, description, view)
                : write_picture(command, output,
                                {domain, view, description, command.scene, true, overlays}, scene);
        if (!done) return pass_on(done);
        written.push_back(output);
    }
    return written;
}

// Reads the grids and estimates the motions.
Result<NowcastData> read_data(NowcastCommand& command) {
    NowcastData data;
    data.threads = render::thread_count(command.scene);
    take_moment(command.scene, command.source.grid);
    command.source.grid.threads = data.threads;
    auto grids = nowcast_grids(command.source);
    if (!grids) return pass_on(grids);
    data.grids = std::move(*grids);
    data.timed = timed_grids(data.grids);
    auto motions = retrieve::pair_motions(data.timed, data.threads);
    if (!motions) return pass_on(motions);
    data.motions = std::move(*motions);
    return data;
}

// Returns the report without scores. Errors: those of retrieve::nowcast() if the motion is unknown.
Result<NowcastReport> report_of(const NowcastCommand& command, const NowcastData& data) {
    const grid::GridSpec& spec = *data.latest().view().spec;
    const auto motion = retrieve::latest_motion(data.motions, spec);
    if (!motion) return pass_on(retrieve::nowcast(data.latest().view(), data.motions, 1, 1));
    const double east_mps = static_cast<double>(motion->whole().x) * spec.cell_width_m();
    const double north_mps = static_cast<double>(motion->whole().y) * spec.cell_height_m();
    constexpr double degrees = 180 / 3.14159265358979;
    const double toward_deg = std::atan2(east_mps, north_mps) * degrees;
    NowcastReport report;
    report.domain = command.source.domain;
    report.latest = data.latest().description().time;
    report.volumes = static_cast<int>(data.grids.size());
    report.speed_mps = std::hypot(east_mps, north_mps);
    report.toward_deg = toward_deg < 0 ? toward_deg + 360 : toward_deg;
    return report;
}

int run_nowcast(NowcastCommand command) {
    const auto leads = parse_leads(command.minutes);
    if (!leads) return report_error(leads.error());
    const auto scene = scene_to_draw(command);
    if (!scene) return report_error(scene.error());
    const auto data = read_data(command);
    if (!data) return report_error(data.error());
    auto report = report_of(command, *data);
    if (!report) return report_error(report.error());
    auto scores = retrieve::score_hindcasts(data->timed, data->motions, *leads, data->threads);
    if (!scores) return report_error(scores.error());
    report->scores = std::move(*scores);
    if (!command.output.empty()) {
        auto written = write_nowcasts(command, *data, *scene, report->scores, *leads);
        if (!written) return report_error(written.error());
        report->written = std::move(*written);
    }
    for (const PictureGrid& grid : data->grids) {
        if (Status whole = grid.check_whole(); !whole) return report_error(whole.error());
    }
    if (command.json)
        fmt::print("{}\n", nowcast_json(*report).dump(1));
    else
        fmt::print("{}", nowcast_table(*report));
    return exit_done;
}

}  // namespace

Run set_up_nowcast(CLI::App& nowcast) {
    const auto command = std::make_shared<NowcastCommand>();
    nowcast
        .add_option("FILE", command->source.words,
                    "Level II files of two volumes or more of one radar, or a domain of the cache")
        ->option_text("FILE...|DOMAIN");
    nowcast.add_option("--domain", command->source.domain,
                       "Domain of the cache, of which the last two hours are used. Default: the "
                       "only one");
    add_place(nowcast, command->source.cache);
    nowcast.add_option("--time", command->source.time,
                       "Take the newest volume at or before this time as the latest, in UTC or "
                       "relative as -1h. Default: the newest volume");
    nowcast.add_option("--minutes", command->minutes,
                       "Leads in minutes, up to 60, separated by commas. Default: every 5");
    nowcast.add_option(
        "-o,--output", command->output,
        fmt::format("Write one file for each lead: a picture as {}, or a grid as {}. If there are "
                    "several leads, the minutes are put before the ending, as in storm-05.png. "
                    "Default: only print the measured errors",
                    render::known_still_formats(), grid_export::known_grid_formats()));
    nowcast.add_flag("--json", command->json, "Print one JSON document");
    add_scene_options(nowcast, command->scene);
    add_picture_grid_options(nowcast, command->source.grid);
    return [command] { return run_nowcast(*command); };
}

}  // namespace stormcellar::cli
