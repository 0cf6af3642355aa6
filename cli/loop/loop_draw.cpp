#include "cli/loop/loop_draw.h"

#include "base/steady_time.h"
#include "cli/picture/drawn_frames.h"
#include "cli/picture/picture.h"
#include "cli/shared/commands.h"
#include "pipeline/mosaic/hail_of_frame.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/export/cell_text.h"
#include "stormcellar/render/render.h"

namespace stormcellar::cli {
namespace {

// The grid of a frame: a grid of the cache, or a grid that was made for the instant.
struct FrameGrid {
    std::optional<cache::GridFile> file;
    const pipeline::MosaicFrame* made = nullptr;
    std::optional<pipeline::HailFrame> hail;  // of the radars of `file`

    [[nodiscard]] const cache::GridDescription& description() const {
        if (hail) return hail->description;
        return file ? file->description() : made->description;
    }
    [[nodiscard]] grid::BrickView view() const {
        if (hail) return hail->bricks.view();
        return file ? file->view() : made->mosaic.cells.view();
    }
    [[nodiscard]] Status check_whole() const { return file ? file->check_whole() : Status{}; }
};

// Merges the hail of the radars if the grid is a mosaic and the product shows hail. Keeps the
// merged reflectivity, and notes that once, if the cache no longer has the grids of the radars.
Status merge_hail(const std::string& domain, const LoopOptions& options, Drawing& drawing,
                  FrameGrid& grid) {
    const bool is_hail = render::facts_of(drawing.scene.product).hail != nullptr;
    if (!is_hail || !drawing.store || !pipeline::is_of_several(grid.description())) return {};
    auto hail = pipeline::hail_of_frame(*drawing.store,
                                        {.domain = domain,
                                         .levels = drawing.scene.freezing_levels,
                                         .threads = render::thread_count(options.scene)},
                                        grid.description(), grid.view());
    if (hail) {
        grid.hail.emplace(std::move(*hail));
        return {};
    }
    const ErrorCode code = hail.error().code;
    if (code != ErrorCode::not_found && code != ErrorCode::over_budget) return pass_on(hail);
    if (!drawing.lacks_hail) print_note(pipeline::merged_reflectivity_note + hail.error().message);
    drawing.lacks_hail = true;
    return {};
}

// Returns the grid of a frame. Errors: also not_found if no volume is near the instant.
Result<FrameGrid> grid_of(const LoopFrame& frame, const LoopOptions& options,
                          std::optional<pipeline::BetweenGrids>& between, Drawing& drawing) {
    FrameGrid grid;
    if (frame.stored) {
        auto file = cache::GridFile::open(frame.stored->path);
        if (!file) return pass_on(file);
        grid.file.emplace(std::move(*file));
        if (Status merged = merge_hail(frame.stored->domain, options, drawing, grid); !merged)
            return pass_on(merged);
        return grid;
    }
    if (!drawing.made || drawing.made_for != frame.time) {
        auto made = between->at(frame.time);
        if (!made) return pass_on(made);
        if (!*made) {
            return fail(ErrorCode::not_found,
                        "no two volumes near enough to each other have their middles before and "
                        "after {}",
                        format_utc(frame.time));
        }
        drawing.made = std::move(**made);
        drawing.made_for = frame.time;
    }
    grid.made = &*drawing.made;
    return grid;
}

}  // namespace

Result<std::optional<render::Image>> draw(const LoopFrame& frame, const LoopOptions& options,
                                          std::optional<pipeline::BetweenGrids>& between,
                                          Drawing& drawing, LoopReport& report) {
    const auto start = steady_now();
    const auto skip = [&](const Error& error) {
        report.skipped.push_back(
            {frame.stored ? frame.stored->path : std::filesystem::path{}, error.message});
        return std::optional<render::Image>{};
    };
    const auto grid = grid_of(frame, options, between, drawing);
    (frame.stored ? report.read_s : report.between_s) += seconds_since(start);
    if (!grid) return skip(grid.error());
    const auto opened = steady_now();
    const int threads = render::thread_count(options.scene);
    const bool is_over_time = render::facts_of(drawing.scene.product).is_over_time;
    if (is_over_time) {
        const Status added = drawing.track.add(grid->view(), grid->description(), threads);
        if (!added) return skip(added.error());
    }
    auto facts = frame_facts_of(options.domain,
                                is_over_time ? drawing.track.description() : grid->description(),
                                options.scene.time_zone);
    std::optional<render::CellOverlay> cells;
    if (drawing.cells) {
        auto found = drawing.cells->at(frame.time);
        if (!found && found.error().code == ErrorCode::not_found) return pass_on(found);
        if (!found) return skip(found.error());
        cells = std::move(*found);
    }
    facts.interpolated = grid->made != nullptr && options.time_method != "nearest";
    const auto render = [&] {
        return render::render_frame(is_over_time ? drawing.track.view() : grid->view(), facts,
                                    drawing.scene, threads, &drawing.cache,
                                    {.cells = cells ? &*cells : nullptr,
                                     .shapes = drawing.shapes ? &*drawing.shapes : nullptr});
    };
    // The file of shapes may have changed since a frame was kept.
    const bool may_be_kept = frame.stored && !is_over_time && !drawing.shapes;
    auto picture = options.kept != nullptr && may_be_kept
                       ? options.kept->frame(frame.stored->path, drawing.scene, render,
                                             cells ? cell_export::cells_json(cells->scan) : "")
                       : render();
    report.render_s += seconds_since(opened);
    if (!picture) return pass_on(picture);
    // The file of the grid may have been truncated while the grid was drawn.
    if (const Status whole = grid->check_whole(); !whole) {
        return skip(whole.error());
    }
    if (report.frames == 0) report.from = report.to = frame.time;
    report.to = std::max(report.to, frame.time);
    ++report.frames;
    if (grid->made != nullptr) ++report.interpolated;
    return std::optional{std::move(*picture)};
}

}  // namespace stormcellar::cli
