// stormcellar cells FILE...: finds storm cells, follows them and forecasts their places.
#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "base/number_list.h"
#include "cli/picture/cell_scans.h"
#include "cli/shared/commands.h"
#include "cli/shared/output_file.h"
#include "cli/storms/cells_text.h"

namespace stormcellar::cli {
namespace {

struct CellsCommand {
    CellInput input;
    std::string freezing;  // ZERO,MINUS20; empty: the default levels
    std::string to;        // name of a format; empty: a table, or the format of the output's ending
    std::string output;    // empty: standard output
    bool json = false;
};

// Returns the format to write, or null for the table. Errors: bad_argument.
Result<const CellFormat*> format_of(const CellsCommand& command) {
    std::vector<std::string_view> endings;
    for (const CellFormat& format : cell_formats())
        endings.push_back(format.ending);
    if (!command.output.empty() && command.to.empty() && !is_stdout(command.output)) {
        const Status good =
            check_output_file(command.output, endings, "the ending chooses the format", false);
        if (!good) return tl::unexpected(good.error());
    }
    const std::string name = command.json ? "json" : command.to;
    for (const CellFormat& format : cell_formats()) {
        if (name == format.name || (name.empty() && command.output.ends_with(format.ending)))
            return &format;
    }
    return nullptr;
}

Result<retrieve::FreezingLevels> parse_freezing(const std::string& text) {
    if (text.empty()) return retrieve::FreezingLevels{};
    const auto heights_m = parse_numbers(text, ',');
    if (!heights_m || heights_m->size() != 2) {
        return fail(ErrorCode::bad_argument,
                    "--freezing-levels takes the heights of 0 and -20 C in meters, as in "
                    "4200,7300, not '{}'",
                    text);
    }
    const retrieve::FreezingLevels levels{(*heights_m)[0], (*heights_m)[1]};
    if (const auto valid = retrieve::validate(levels); !valid)
        return fail(ErrorCode::bad_argument, "--freezing-levels: {}", valid.error().message);
    return levels;
}

// Returns the newest scan with its tracks.
Result<retrieve::TrackedScan> newest_cells(const CellInput& input) {
    const auto found = find_cell_scans(input);
    if (!found) return pass_on(found);
    auto tracked = retrieve::track_cells(found->scans);
    if (!tracked) return pass_on(tracked);
    return std::move(tracked->back());
}

int run_cells(CellsCommand command) {
    const auto format = format_of(command);
    if (!format) return report_error(format.error());
    const auto freezing = parse_freezing(command.freezing);
    if (!freezing) return report_error(freezing.error());
    command.input.freezing = *freezing;
    const auto scan = newest_cells(command.input);
    if (!scan) return report_error(scan.error());
    const std::string text = *format == nullptr ? cells_table(*scan) : (*format)->text(*scan);
    if (command.output.empty()) {
        fmt::print("{}", text);
        return exit_done;
    }
    const Status written =
        write_output(command.output, std::as_bytes(std::span(text.data(), text.size())));
    return written ? exit_done : report_error(written.error());
}

}  // namespace

Run set_up_cells(CLI::App& cells) {
    const auto command = std::make_shared<CellsCommand>();
    GridOptions& grid = command->input.grid;
    cells
        .add_option("FILE", grid.files,
                    "Level II files or grid files of one radar or domain, or one Level II file of "
                    "each of several radars. Several times make tracks")
        ->required();
    std::vector<std::string> names;
    for (const CellFormat& format : cell_formats())
        names.emplace_back(format.name);
    auto* output = cells.add_option(
        "-o,--output", command->output,
        "File to write; its ending chooses the format: .json, .geojson, .csv, or .txt for a "
        "placefile. - is standard output. Default: print a table");
    auto* to = cells
                   .add_option("--to", command->to,
                               "Format, whatever the ending is: json, geojson, "
                               "csv or placefile")
                   ->check(CLI::IsMember(names));
    cells.add_flag("--json", command->json, "Print the cells as one JSON document")
        ->excludes(to)
        ->excludes(output);
    cells.add_flag("--shear", command->input.shear,
                   "Also derive the largest azimuthal shear of each cell from the velocities");
    cells.add_option("--freezing-levels", command->freezing,
                     "Heights above mean sea level, in meters, at which the air has 0 and -20 C: "
                     "ZERO,MINUS20. Hail sizes depend on them. Default: 4200,7300");
    cells.add_option("--quality", grid.quality,
                     "Leave out echo whose probability of weather is less than this, from 0 to 1. "
                     "Default: 0, which keeps all");
    add_picture_grid_options(cells, grid);
    cells.add_option("--threads", grid.threads, "Number of threads. Default: all processors")
        ->check(CLI::Range(1, 256));
    return [command] { return run_cells(*command); };
}

}  // namespace stormcellar::cli
