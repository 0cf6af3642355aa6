// stormcellar accuracy [FILE...]: measures the error and the time of each way to grid or draw, on
// real volumes or on a simulated scene.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "accuracy/ladder_message.h"
#include "accuracy/plot.h"
#include "base/steady_time.h"
#include "cli/accuracy/held_out_accuracy.h"
#include "cli/accuracy/ladder_markdown.h"
#include "cli/accuracy/mosaic_accuracy.h"
#include "cli/accuracy/site_pairs_accuracy.h"
#include "cli/accuracy/truth_errors.h"
#include "cli/accuracy/velocity_accuracy.h"
#include "cli/grid/grid_notes.h"
#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/picture/picture_ladder.h"
#include "cli/shared/commands.h"
#include "cli/shared/effect_options.h"
#include "cli/shared/progress.h"
#include "grid/plan/grid_ladder.h"
#include "stormcellar/base/file_system.h"
#include "synth/observe.h"

namespace stormcellar::cli {
namespace {

struct AccuracyOptions {
    GridOptions grid;
    EffectOptions effects;
    std::string scene;
    std::string plot;
    int columns = 2000;
    int rounds = 3;
    bool markdown = false;
    bool held_out = false;
    bool compare_sites = false;
    bool picture = false;
    bool velocity = false;
};

// The volume of a file, or the first volume of a simulated scene.
struct Subject {
    SourceVolume source;
    std::optional<synth::Scene> scene;
    std::string name;
};

struct Measured {
    std::vector<accuracy::LadderRow> rows;
    std::vector<synth::TruthRow> truth;  // for a simulated scene
};

Result<Subject> load_subject(const AccuracyOptions& options, const GridRequest& request) {
    Subject subject;
    if (options.scene.empty()) {
        subject.name = options.grid.files.front();
        auto source = load_volume(subject.name, request);
        if (!source) return pass_on(source);
        subject.source = std::move(*source);
        return subject;
    }
    subject.name = options.scene;
    auto scene = synth::read_scene(options.scene);
    if (!scene) return pass_on(scene);
    subject.source.volume = synth::observe(*scene, 0);
    subject.source.site = {scene->site.station, scene->site.latitude_deg, scene->site.longitude_deg,
                           static_cast<double>(scene->site.antenna_altitude_m)};
    subject.scene = std::move(*scene);
    return subject;
}

nlohmann::ordered_json to_json(const std::vector<accuracy::LadderRow>& rows,
                               accuracy::ValueUnit unit) {
    auto list = nlohmann::ordered_json::array();
    for (const accuracy::LadderRow& row : rows) {
        nlohmann::ordered_json item;
        for (const accuracy::LadderField& field : accuracy::fields(row, unit)) {
            std::visit(
                [&](const auto& value) {
                    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
                        item[field.key] = nullptr;
                    } else {
                        item[field.key] = value;
                    }
                },
                field.value);
        }
        list.push_back(std::move(item));
    }
    return list;
}

// Returns false for a step whose rows have no error. All of its points would be in one place, so a
// plot would show nothing.
bool has_error(const std::vector<accuracy::LadderRow>& rows, const std::string& step) {
    return std::ranges::any_of(rows, [&](const accuracy::LadderRow& row) {
        const double error = row.value ? row.value->p99 : row.image_p99_de.value_or(0);
        return row.step == step && error > 0;
    });
}

std::string with_capital(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
        text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

Status write_svg(const accuracy::Plot& plot, const std::string& file) {
    const auto svg = accuracy::draw_plot(plot);
    if (!svg) return pass_on(svg);
    return write_file_atomically(real_file_system(), file, std::as_bytes(std::span(*svg)));
}

Status write_plot(const std::vector<accuracy::LadderRow>& rows, accuracy::ValueUnit unit,
                  const std::string& subject, const std::string& file) {
    const bool of_picture = std::any_of(
        rows.begin(), rows.end(), [](const auto& row) { return row.image_p99_de && !row.value; });
    const accuracy::LadderMessage message = accuracy::message_of(rows, unit);
    accuracy::Plot plot;
    plot.title = message.buy.empty() ? subject : with_capital(message.buy);
    plot.main_series = message.step;
    if (!message.beyond.empty()) plot.below.push_back(with_capital(message.beyond));
    if (!message.buy.empty()) plot.below.push_back(subject);
    plot.error_label =
        of_picture ? "Color difference, 99th percentile (CIEDE2000)"
                   : fmt::format("Value error, 99th percentile ({})", accuracy::name_of(unit));
    plot.time_label = of_picture ? "Time of a picture" : "Time of each further grid";
    for (const accuracy::LadderRow& row : rows) {
        if (!has_error(rows, row.step)) continue;
        const double error = row.value ? row.value->p99 : row.image_p99_de.value_or(0);
        plot.points.push_back(
            {row.name, row.step, row.kept_time_s.value_or(row.time_s), error, row.pareto});
    }
    return write_svg(plot, file);
}

// Explanations of the headings of the tables, printed below each.
constexpr std::string_view words_of_grids =
    "first time: the first grid; further time: each one after it, which uses the places of the\n"
    "columns again. position: how far a sample is off at most. usual, 99 in 100, largest: the "
    "error\n"
    "of the values (root mean square, 99th percentile, maximum). state: cells that are a value in\n"
    "one and not in the other. worth it: no other rung of the step is as fast and as accurate.\n";
constexpr std::string_view words_of_pictures =
    "color: the difference of 99 in 100 pixels is smaller (CIEDE2000; 2 is hardly seen). worth "
    "it:\n"
    "no other rung of the step is as fast and as accurate.\n";

// Breaks a sentence at blanks into lines that fit the width of the table.
std::string in_lines(std::string text) {
    constexpr std::size_t width = 96;
    for (std::size_t begin = 0; text.size() - begin > width;) {
        const std::size_t blank = text.rfind(' ', begin + width);
        if (blank == std::string::npos || blank <= begin) break;
        text[blank] = '\n';
        begin = blank + 1;
    }
    return text;
}

enum class Table { grid, picture };

void print_tables(const std::string& subject, const Measured& measured, accuracy::ValueUnit unit,
                  bool markdown, Table picture) {
    const auto& [rows, truth] = measured;
    const bool of_picture = picture == Table::picture;
    fmt::print("{}\n\nEach rung against the chain's exact form on the same {}:\n\n{}",
               printable(subject), of_picture ? "grid" : "gates",
               markdown ? ladder_markdown(rows, unit) : accuracy::format_table(rows, unit));
    if (!markdown) {
        const std::string message = accuracy::message_of(rows, unit).sentence();
        fmt::print("\n{}", of_picture ? words_of_pictures : words_of_grids);
        if (!message.empty()) fmt::print("\n{}\n", in_lines("In short: " + message + "."));
    }
    if (truth.empty()) return;
    fmt::print("\nAgainst the truth of the scene (sampling error; never budgeted):\n\n{}",
               format_truth(truth, unit, markdown));
}

void print_measured_json(const std::string& subject, level2::Moment moment,
                         const Measured& measured, accuracy::ValueUnit unit) {
    nlohmann::ordered_json json;
    json["subject"] = subject;
    json["moment"] = level2::moment_name(moment);
    json["value_unit"] = accuracy::name_of(unit);
    json["rows"] = to_json(measured.rows, unit);
    json["truth"] = truth_json(measured.truth);
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    fmt::print("{}\n", json.dump(1, ' ', true, replace));
}

void note_without_values(const std::vector<accuracy::LadderRow>& rows) {
    const bool any_value = std::any_of(
        rows.begin(), rows.end(),
        [](const accuracy::LadderRow& row) { return row.value && row.value->count > 0; });
    if (!any_value) {
        print_note("none of the compared cells has a value, so there are no value errors");
    }
}

// Returns the rows of the ladder and, for a simulated scene, the errors against the truth.
Result<Measured> measure(const Subject& subject, const GridRequest& request,
                         const grid::GridSpec& spec, const EffectRequest& effects,
                         const AccuracyOptions& options) {
    Progress progress("measuring", 0, !options.grid.json);
    const auto show = [&](std::size_t done, std::size_t total) { progress.show(done, total); };
    if (options.picture) {
        auto rows = ladder_of_picture(subject.source, request, spec, options.rounds, show);
        if (!rows) return pass_on(rows);
        return Measured{std::move(*rows), {}};
    }
    auto scene = grid::GridScene::make(
        subject.source.volume, subject.source.site, spec,
        {request.moment, 0, effects.profile, request.threads, request.frame_time});
    if (!scene) return pass_on(scene);
    grid::LadderOptions ladder;
    ladder.columns = static_cast<std::size_t>(options.columns);
    ladder.rounds = options.rounds;
    ladder.progress = show;
    auto rows = grid::run_ladder(*scene, ladder);
    if (!rows) return pass_on(rows);
    Measured measured{std::move(*rows), {}};
    if (!subject.scene) return measured;
    auto truth = synth::compare_with_truth(*scene, *subject.scene, ladder.columns);
    if (!truth) return pass_on(truth);
    measured.truth = std::move(*truth);
    return measured;
}

Status check_site_options(const AccuracyOptions& options) {
    if (options.grid.files.size() < 2 || options.held_out || !options.scene.empty() ||
        !options.plot.empty()) {
        return fail(ErrorCode::bad_argument,
                    "--compare-sites needs two or more FILEs of different sites, and cannot be "
                    "used with --scene, --plot or --held-out");
    }
    if (options.grid.json && options.markdown) {
        return fail(ErrorCode::bad_argument, "--markdown and --json cannot be used together");
    }
    return {};
}

Status check_options(AccuracyOptions& options) {
    const std::size_t files = options.grid.files.size();
    if (options.picture && (options.compare_sites || options.held_out || files > 1)) {
        return fail(ErrorCode::bad_argument,
                    "--picture takes one FILE or a scene, and cannot be used with --held-out or "
                    "--compare-sites");
    }
    if (options.velocity &&
        (options.picture || options.compare_sites || options.held_out || files > 1)) {
        return fail(ErrorCode::bad_argument,
                    "--velocity takes one FILE or a scene, and cannot be used with --picture, "
                    "--held-out or --compare-sites");
    }
    if (options.compare_sites) return check_site_options(options);
    if (options.scene.empty() == (files == 0)) {
        return fail(ErrorCode::bad_argument, "name one or more FILEs, or a scene with --scene");
    }
    if (options.held_out && !options.plot.empty()) {
        return fail(ErrorCode::bad_argument,
                    "--plot cannot show held-out volumes; leave out --held-out");
    }
    if (!options.scene.empty()) options.grid.files = {options.scene};
    if (options.grid.json && options.markdown) {
        return fail(ErrorCode::bad_argument, "--markdown and --json cannot be used together");
    }
    if (options.plot.empty()) return {};
    if (!options.plot.ends_with(".svg")) {
        return fail(ErrorCode::bad_argument,
                    "--plot writes SVG: the name must end in .svg, not '{}'", options.plot);
    }
    return check_target(options.plot);
}

int report_over_time(const AccuracyOptions& options, const GridRequest& request,
                     const Result<std::vector<grid::TimedVolume>>& sequence) {
    if (!sequence) return report_error(sequence.error());
    std::optional<Progress> progress(std::in_place, "measuring", 0, !options.grid.json);
    const auto rows = score_sequence(*sequence, request, [&](std::size_t done, std::size_t total) {
        progress->show(done, total);
    });
    progress.reset();
    if (!rows) return report_error(rows.error());
    if (options.grid.json) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        const nlohmann::ordered_json json{{"moment", level2::moment_name(request.moment)},
                                          {"value_unit", "dB"},
                                          {"rows", held_out_json(*rows)}};
        fmt::print("{}\n", json.dump(1, ' ', true, replace));
        return exit_done;
    }
    fmt::print(
        "Each volume between two others, made again from those two and compared with what was "
        "seen:\n\n{}",
        format_held_out(*rows, options.markdown));
    return exit_done;
}

int run_held_out(const AccuracyOptions& options, const GridRequest& request) {
    if (options.scene.empty()) {
        return report_over_time(options, request,
                                load_repeats(options.grid.files.front(), request));
    }
    const auto scene = synth::read_scene(options.scene);
    if (!scene) return report_error(scene.error());
    return report_over_time(options, request, observe_sequence(*scene));
}

// Writes plots, notes and tables of a ladder.
int report_ladder(const AccuracyOptions& options, const GridRequest& request,
                  const std::string& subject, const Measured& measured) {
    const accuracy::ValueUnit unit = grid::value_unit_of(request.moment);
    if (!options.plot.empty()) {
        const auto title = fmt::format("{}, {}", std::filesystem::path(subject).filename().string(),
                                       level2::moment_name(request.moment));
        if (auto drawn = write_plot(measured.rows, unit, title, options.plot); !drawn) {
            return report_error(drawn.error());
        }
    }
    if (!options.picture) note_without_values(measured.rows);
    if (options.grid.json) {
        print_measured_json(subject, request.moment, measured, unit);
    } else {
        print_tables(subject, measured, unit, options.markdown,
                     options.picture ? Table::picture : Table::grid);
    }
    return exit_done;
}

// If there are several sites or an instant, measures the steps of a mosaic. Otherwise leaves out
// volumes of one site in turn, and measures how well each is interpolated from its neighbors.
int run_files(const AccuracyOptions& options, const GridRequest& request) {
    auto sources = load_mosaic(options.grid.files, request);
    if (!sources) return report_error(sources.error());
    if (!request.frame_time && sources->site_count() == 1) {
        if (!options.plot.empty()) {
            return report_error(
                {ErrorCode::bad_argument, "--plot cannot show held-out volumes; give a --time"});
        }
        return report_over_time(options, request, sequence_of(std::move(*sources)));
    }
    const auto effects =
        parse_effects(options.effects, request.moment, grid::default_overlap(request.moment));
    if (!effects) return report_error(effects.error());
    std::optional<Progress> progress(std::in_place, "measuring", 0, !options.grid.json);
    auto rows =
        ladder_of_mosaic(*sources, request, *effects, options.rounds,
                         [&](std::size_t done, std::size_t total) { progress->show(done, total); });
    progress.reset();
    if (!rows) return report_error(rows.error());
    const std::string subject =
        fmt::format("{} and {} more", options.grid.files.front(), options.grid.files.size() - 1);
    return report_ladder(options, request, subject, {std::move(*rows), {}});
}

int run_comparison(const AccuracyOptions& options, const GridRequest& request) {
    const auto effects =
        parse_effects(options.effects, request.moment, grid::default_overlap(request.moment));
    if (!effects) return report_error(effects.error());
    return run_site_pairs(options.grid, request, *effects, options.markdown);
}

int run_velocity(const AccuracyOptions& options, GridRequest request) {
    request.moment = level2::Moment::vel;
    const auto subject = load_subject(options, request);
    if (!subject) return report_error(subject.error());
    std::optional<Progress> progress(std::in_place, "measuring", 0, !options.grid.json);
    const auto ladder = measure_dealiasing(
        subject->source.volume, subject->scene ? &*subject->scene : nullptr, options.rounds,
        [&](std::size_t done, std::size_t total) { progress->show(done, total); });
    progress.reset();
    if (!ladder) {
        const Error& error = ladder.error();
        return report_error({error.code, fmt::format("{}: {}", subject->name, error.message)});
    }
    if (!options.plot.empty()) {
        const auto title = std::filesystem::path(subject->name).filename().string();
        if (auto drawn = write_svg(fold_plot(*ladder, title), options.plot); !drawn)
            return report_error(drawn.error());
    }
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    if (options.grid.json) {
        fmt::print("{}\n", fold_ladder_json(subject->name, *ladder).dump(1, ' ', true, replace));
    } else {
        fmt::print("{}", format_fold_ladder(subject->name, *ladder, options.markdown));
    }
    return exit_done;
}

int run_accuracy(AccuracyOptions options) {
    if (auto sound = check_options(options); !sound) return report_error(sound.error());
    std::shared_ptr<InputFiles> inputs;
    if (!options.grid.files.empty()) {
        auto found = find_inputs(options.grid);
        if (!found) return report_error(found.error());
        inputs = std::move(*found);
    }
    auto request = parse_request(options.grid);
    if (!request) return report_error(request.error());
    request->inputs = std::move(inputs);
    if (options.velocity) return run_velocity(options, *request);
    if (options.held_out) return run_held_out(options, *request);
    if (options.compare_sites) return run_comparison(options, *request);
    if (options.grid.files.size() > 1) return run_files(options, *request);
    const auto effects = parse_effects(options.effects, request->moment);
    if (!effects) return report_error(effects.error());
    const auto subject = load_subject(options, *request);
    if (!subject) return report_error(subject.error());
    const grid::SitePosition& site = subject->source.site;
    const auto spec = spec_about(*request, site.latitude_deg, site.longitude_deg);
    if (!spec) return report_error(spec.error());
    const auto measured = measure(*subject, *request, *spec, *effects, options);
    if (!measured) {
        const Error& error = measured.error();
        return report_error({error.code, fmt::format("{}: {}", subject->name, error.message)});
    }
    if (const auto note = note_on_sounding(*effects, site)) print_note(*note);
    return report_ladder(options, *request, subject->name, *measured);
}

}  // namespace

Run set_up_accuracy(CLI::App& command) {
    const auto options = std::make_shared<AccuracyOptions>();
    options->grid.threads = 1;
    command.add_option("FILE", options->grid.files,
                       "The Level II files to measure. One file is measured alone. Files of "
                       "several sites, or of one site with --time, are measured as one mosaic. Of "
                       "three or more files of one site, each is made again from its neighbors in "
                       "time. --compare-sites needs files of several sites");
    command.add_option("--time", options->grid.time,
                       "Instant in UTC (ISO 8601). For several FILEs, it is the instant of their "
                       "mosaic; for one FILE, the nearest of repeated sweeps is used");
    command.add_flag(
        "--held-out", options->held_out,
        "Make held-out data again from their neighbors in time, and compare the two. For one FILE, "
        "these are the repeats of its lowest cut (SAILS, MRLE); for a scene, its second volume");
    command.add_flag("--compare-sites", options->compare_sites,
                     "Compare sites that overlap: bias, azimuth, elevation and clock of each pair. "
                     "Two FILEs of one site also show the motion of the weather");
    command.add_flag("--picture", options->picture,
                     "Measure the picture of one FILE or a scene instead of its grid: slices, "
                     "integration, rays and light");
    command.add_flag("--velocity", options->velocity,
                     "Measure how the velocity of one FILE or a scene is dealiased: time and wrong "
                     "gates of each rung, after folding it again at lower Nyquist velocities");
    command.add_option(
        "--scene", options->scene,
        "A simulated scene (TOML) to measure instead of FILEs, also against its own truth");
    add_spec_options(command, options->grid);
    command
        .add_option("--profile", options->effects.profile,
                    "Profile of refractivity through which the exact beams are traced: "
                    "exponential, standard or a sounding file")
        ->capture_default_str();
    command.add_option("--columns", options->columns, "Number of columns to compare")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000000));
    command.add_option("--rounds", options->rounds, "Number of times that each time is measured")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    command.add_option("--plot", options->plot,
                       "Write a plot of error against time to this file (.svg)");
    command.add_flag("--markdown", options->markdown,
                     "Print the tables as Markdown, as in docs/accuracy.md; not with --json");
    return [options] { return run_accuracy(*options); };
}

}  // namespace stormcellar::cli
