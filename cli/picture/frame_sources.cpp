#include "cli/picture/frame_sources.h"

#include <array>

#include <fmt/format.h>

#include "base/printable.h"
#include "cli/picture/cell_scans.h"
#include "cli/picture/hail_mosaic.h"
#include "cli/picture/picture.h"
#include "cli/picture/rain_sources.h"
#include "cli/picture/raw_volume.h"
#include "cli/picture/stored_cells.h"
#include "cli/shared/cache_domain.h"
#include "cli/shared/commands.h"
#include "cli/shared/query_options.h"
#include "pipeline/mosaic/hail_of_frame.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/render/product.h"
#include "stormcellar/retrieve/hydrometeors.h"
#include "stormcellar/retrieve/melting_layer.h"

namespace stormcellar::cli {
namespace {

// Returns the latest time that the grid may have; none: now.
Result<std::optional<UtcTime>> until_of(const FrameOptions& options) {
    if (options.time.empty()) return std::optional<UtcTime>{};
    const auto time = parse_utc(options.time, now_utc());
    if (!time) return fail(time.error().code, "--time: {}", time.error().message);
    return std::optional{*time};
}

// Returns the newest grid of the domain at or before the time: a grid of this moment, or of any
// moment if `moment` is none. Returns none if there is no such grid.
Result<std::optional<cache::StoreEntry>> find_grid(const cache::StoreReader& store,
                                                   const FrameOptions& options,
                                                   std::optional<level2::Moment> moment) {
    const auto until = until_of(options);
    if (!until) return pass_on(until);
    auto entries = moment ? store.list(options.domain, *moment, std::nullopt, *until)
                          : grids_of_any_moment(store, options.domain, std::nullopt, *until);
    if (!entries) return pass_on(entries);
    if (!*until) cache::leave_out_future(*entries, now_utc());
    if (entries->empty()) return std::optional<cache::StoreEntry>{};
    if (!*until) warn_of_future(entries->back().time);
    return std::optional{entries->back()};
}

int report_nothing(const cache::StoreReader& store, const FrameOptions& options,
                   level2::Moment moment) {
    return report_no_grid(
        store, options.domain, moment,
        options.time.empty() ? std::string{} : fmt::format(" at or before {}", options.time));
}

Status refuse_grid_options(const FrameOptions& options) {
    if (!has_picture_grid_options(options.grid)) return {};
    return fail(ErrorCode::bad_argument,
                "options of the grid, such as --center, are for files; the grids of the cache are "
                "made already");
}

// Opens the cache and determines the domain.
Result<cache::StoreReader> open_store(FrameOptions& options) {
    if (Status found = options.cache.find(); !found) {
        if (options.sources.empty()) return pass_on(found);
        return fail(ErrorCode::bad_argument,
                    "'{}' names no file here, and there is no cache to look for such a domain; {}",
                    options.domain, found.error().message);
    }
    auto store = cache::StoreReader::open(options.cache.directory);
    if (!store) return store;
    if (options.domain.empty()) {
        if (Status taken = take_only_domain(*store, options.domain); !taken) return pass_on(taken);
    }
    return store;
}

// Returns the grid of azimuthal shear of the domain at a time.
Result<PictureGrid> stored_shear(const cache::StoreReader& store, const FrameOptions& options,
                                 UtcTime time) {
    const auto entries = store.list(options.domain, level2::Moment::azsh, time, time);
    if (!entries) return pass_on(entries);
    if (entries->empty()) {
        return fail(ErrorCode::not_found,
                    "--rotation needs azimuthal shear; domain '{}' has no grid of AZSH at {}",
                    options.domain, format_utc(time));
    }
    return PictureGrid::open(entries->back().path);
}

// Finds the storm cells to mark in a picture of this time, if they were asked for.
Status find_stored_cells(const cache::StoreReader& store, const FrameOptions& options,
                         const render::Scene& scene, FrameGrids& grids) {
    if (!render::marks_cells(options.scene)) return {};
    StoredCells cells(store, options.domain, chosen_freezing_levels(options.scene, scene));
    auto found = cells.at(grids.shown->description().time);
    if (!found) return pass_on(found);
    grids.cells = std::move(*found);
    return {};
}

// Merges the hail of the radars if the grid is a mosaic and the product shows hail.
Result<PictureGrid> with_merged_hail(const cache::StoreReader& store, const FrameOptions& options,
                                     const render::Scene& scene, PictureGrid grid) {
    const bool is_hail = render::facts_of(scene.product).hail != nullptr;
    if (!is_hail || !pipeline::is_of_several(grid.description())) return grid;
    auto hail = pipeline::hail_of_frame(store,
                                        {.domain = options.domain,
                                         .levels = scene.freezing_levels,
                                         .threads = render::thread_count(options.scene)},
                                        grid.description(), grid.view());
    if (hail)
        return PictureGrid::of_bricks(options.domain, std::move(hail->description),
                                      std::move(hail->bricks));
    const ErrorCode code = hail.error().code;
    if (code != ErrorCode::not_found && code != ErrorCode::over_budget) return pass_on(hail);
    const std::string note = pipeline::merged_reflectivity_note + hail.error().message;
    print_note(note);
    if (code == ErrorCode::over_budget) return grid;
    // The output must have the note, too.
    cache::GridDescription noted = grid.description();
    noted.provenance.notes.push_back(note);
    const grid::BrickView view = grid.view();
    auto copy = grid::BrickGrid::from(grid::to_dense(view), view.quantization);
    if (Status whole = grid.check_whole(); !whole) return pass_on(whole);
    return PictureGrid::of_bricks(options.domain, std::move(noted), std::move(copy));
}

// Returns the grid. If no grid matched, reports that and returns none.
Result<FrameGrids> stored_grid(FrameOptions& options, const render::Scene& scene) {
    if (Status none = refuse_grid_options(options); !none) return pass_on(none);
    const auto store = open_store(options);
    if (!store) return pass_on(store);
    const auto entry = find_grid(*store, options, scene.moment);
    if (!entry) return pass_on(entry);
    FrameGrids grids;
    if (!*entry) {
        report_nothing(*store, options, scene.moment);
        return grids;
    }
    auto grid = PictureGrid::open((*entry)->path);
    if (!grid) return pass_on(grid);
    auto hail = with_merged_hail(*store, options, scene, std::move(*grid));
    if (!hail) return pass_on(hail);
    grids.shown = std::move(*hail);
    if (Status found = find_stored_cells(*store, options, scene, grids); !found)
        return pass_on(found);
    if (!options.rotation) return grids;
    auto shear = stored_shear(*store, options, (*entry)->time);
    if (!shear) return pass_on(shear);
    grids.shear = std::move(*shear);
    return grids;
}

// Returns the sweep, read from the raw volume of the domain's newest grid of any moment. If there
// is no grid, reports that and returns none.
Result<FrameGrids> stored_sweep(FrameOptions& options, const render::Scene& scene) {
    const auto store = open_store(options);
    if (!store) return pass_on(store);
    const auto entry = find_grid(*store, options, std::nullopt);
    if (!entry) return pass_on(entry);
    FrameGrids grids;
    if (!*entry) {
        report_nothing(*store, options, scene.moment);
        return grids;
    }
    const auto grid = cache::GridFile::open((*entry)->path);
    if (!grid) return pass_on(grid);
    options.catalog.config = options.cache.config;
    if (Status found = options.catalog.find(); !found) return pass_on(found);
    const auto catalog = catalog::CatalogReader::open(options.catalog.directory);
    if (!catalog) return pass_on(catalog);
    const auto raw = raw_volume_of(*catalog, options.domain, grid->description());
    if (!raw) return pass_on(raw);
    for (const std::string& note : raw->notes)
        print_note(printable(note));
    take_moment(options.scene, options.grid);
    options.grid.threads = render::thread_count(options.scene);
    auto volume = decode_sweeps(*raw, options.grid, &scene);
    if (!volume) return pass_on(volume);
    auto sweep = PictureGrid::of_sweep(std::move(*volume), scene);
    if (!sweep) return pass_on(sweep);
    grids.shown = std::move(*sweep);
    if (Status found = find_stored_cells(*store, options, scene, grids); !found)
        return pass_on(found);
    return grids;
}

Result<PictureGrid> sweep_of_file(const GridOptions& options, const render::Scene& scene) {
    auto volume = read_sweeps(options, &scene);
    if (!volume) return pass_on(volume);
    return PictureGrid::of_sweep(std::move(*volume), scene);
}

// Grids the moment and, for columns of rotation, azimuthal shear. Decodes the files once.
Result<FrameGrids> made_grids(GridOptions grid, bool has_rotation) {
    if (has_rotation) {
        grid.moment += ",AZSH";
        grid.takes_moments = true;
    }
    auto made = PictureGrid::make_each(std::move(grid));
    if (!made) return pass_on(made);
    FrameGrids grids{std::move(made->front()), std::nullopt, std::nullopt};
    if (!has_rotation) return grids;
    if (made->size() != 2 || made->back().description().moment != level2::Moment::azsh)
        return fail(ErrorCode::not_found, "--rotation needs velocities; the files have none");
    grids.shear = std::move(made->back());
    return grids;
}

// Finds the storm cells of the files. If one radar has several volumes, the picture then shows the
// newest, unless its product is made from all of them. Returns the newest grid of reflectivity.
Result<PictureGrid> find_cells_of_files(FrameOptions& options, const render::Scene& scene,
                                        FrameGrids& grids) {
    CellInput input{options.grid, false, chosen_freezing_levels(options.scene, scene)};
    input.grid.dealias = input.grid.storm_motion = "";
    auto found = find_cell_scans(std::move(input));
    if (!found) return pass_on(found);
    auto overlay = overlay_of(found->scans);
    if (!overlay) return pass_on(overlay);
    grids.cells = std::move(*overlay);
    if (!render::facts_of(scene.product).is_over_time)
        options.grid.files = std::move(found->newest_files);
    return std::move(found->reflectivity);
}

// Returns the length, the end and the threads of a rain total. Errors: bad_argument for an invalid
// time.
Result<RainChoice> rain_choice(const FrameOptions& options) {
    const auto until = until_of(options);
    if (!until) return pass_on(until);
    return RainChoice{options.hours, *until, render::thread_count(options.scene)};
}

// Returns the rain total of a domain's grids.
Result<FrameGrids> stored_rain(FrameOptions& options) {
    if (Status none = refuse_grid_options(options); !none) return pass_on(none);
    const auto rain = rain_choice(options);
    if (!rain) return pass_on(rain);
    const auto store = open_store(options);
    if (!store) return pass_on(store);
    auto total = rain_total_of_domain(*store, options.domain, *rain);
    if (!total) return pass_on(total);
    FrameGrids grids;
    grids.shown = std::move(*total);
    return grids;
}

// Tells which melting layer the classes of hydrometeors have, and where snow melts if hail assumes
// another height. Asks for --freezing-levels if they would change the picture.
void print_layer_notes(const FrameOptions& options, const std::vector<std::string>& notes) {
    constexpr std::string_view ask = "; give --freezing-levels";
    for (const std::string& note : notes) {
        if (!note.starts_with(retrieve::hydrometeor_words)) continue;
        const bool may_ask = retrieve::assumed_zero_c_in_notes(std::array{note}) &&
                             !render::chooses_levels(options.scene);
        print_note(fmt::format("{}{}", note, may_ask ? ask : ""));
    }
    const std::string zero_c = retrieve::zero_c_in_notes(notes);
    if (!zero_c.empty()) print_note(fmt::format("{}{}", zero_c, ask));
}

Result<FrameGrids> grid_of_files(FrameOptions& options, const render::Scene& scene) {
    take_moment(options.scene, options.grid);
    options.grid.threads = render::thread_count(options.scene);
    options.grid.time = options.time;
    const auto rain = rain_choice(options);
    if (!rain) return pass_on(rain);
    const render::ProductFacts& product = render::facts_of(scene.product);
    if (product.hail != nullptr) options.grid.assumed_zero_c_m = scene.freezing_levels.zero_c_m;
    FrameGrids grids;
    const bool is_special = product.is_of_sweep || product.is_over_time || product.hail != nullptr;
    if (render::marks_cells(options.scene)) {
        auto reflectivity = find_cells_of_files(options, scene, grids);
        if (!reflectivity) return pass_on(reflectivity);
        const bool is_shown = scene.moment == level2::Moment::ref && !options.rotation;
        if (is_shown && !is_special) grids.shown = std::move(*reflectivity);
    }
    if (grids.shown) {
        // The search for cells made the grid.
    } else if (product.is_of_sweep || product.is_over_time) {
        auto made = product.is_of_sweep ? sweep_of_file(options.grid, scene)
                    : product.is_sum    ? rain_total_of_files(options.grid, *rain)
                                        : PictureGrid::make_track(options.grid);
        if (!made) return pass_on(made);
        grids.shown = std::move(*made);
    } else {
        if (product.hail != nullptr) {
            auto made = hail_grid_of_files(options.grid, scene.freezing_levels);
            if (!made) return pass_on(made);
            grids.shown = std::move(*made);
        } else {
            auto made = made_grids(options.grid, options.rotation);
            if (!made) return made;
            grids.shown = std::move(made->shown);
            grids.shear = std::move(made->shear);
        }
    }
    print_layer_notes(options, grids.shown->description().provenance.notes);
    options.domain = grids.shown->name();
    return grids;
}

// Sorts the words of the command line into files and a domain.
Status take_sources(FrameOptions& options) {
    auto names = tell_apart_from_cache(options.sources, options.domain, options.cache);
    if (!names) return pass_on(names);
    options.grid.files = std::move(names->files);
    options.domain = std::move(names->domain);
    return {};
}

}  // namespace

Result<FrameGrids> grid_of_frame(FrameOptions& options, const render::Scene& scene) {
    if (Status taken = take_sources(options); !taken) return pass_on(taken);
    if (options.rotation &&
        (scene.product != render::Product::volume || scene.moment == level2::Moment::azsh)) {
        return fail(ErrorCode::bad_argument,
                    "--rotation is for a volume of another moment than AZSH");
    }
    const bool is_of_sweep = render::facts_of(scene.product).is_of_sweep;
    const bool is_sum = render::facts_of(scene.product).is_sum;
    if (options.hours && !is_sum)
        return fail(ErrorCode::bad_argument, "--hours is the length of a rain-total");
    if (!options.catalog.directory.empty() && (!is_of_sweep || !options.grid.files.empty())) {
        return fail(ErrorCode::bad_argument,
                    "--catalog says where the raw file of a ppi of a domain is; nothing else needs "
                    "it");
    }
    if (!options.grid.files.empty()) return grid_of_files(options, scene);
    if (Status fits = check_stored_derivation(options.scene, scene.product); !fits)
        return pass_on(fits);
    if (is_sum && options.hours) return stored_rain(options);
    if (is_sum)
        return fail(ErrorCode::bad_argument, "a rain-total of a domain needs --hours, as in 3");
    if (Status fits = render::check_single_grid(scene.product); !fits) return pass_on(fits);
    if (!is_of_sweep) return stored_grid(options, scene);
    return stored_sweep(options, scene);
}

Result<std::vector<PictureGrid>> grids_of_panels(FrameOptions& options,
                                                 const std::vector<PanelScene>& panels) {
    if (options.rotation)
        return fail(ErrorCode::bad_argument, "--rotation is for one picture, not for panels");
    if (Status taken = take_sources(options); !taken) return pass_on(taken);
    const render::Scene& scene = panels.front().scene;
    const render::ProductFacts& product = render::facts_of(scene.product);
    if (product.is_over_time)
        return fail(ErrorCode::bad_argument, "{} is for one picture, not for panels", product.name);
    if (options.grid.files.empty()) {
        if (Status none = refuse_grid_options(options); !none) return pass_on(none);
        if (product.is_of_sweep) {
            return fail(ErrorCode::bad_argument,
                        "panels of sweeps are drawn of a Level II file; name it");
        }
        const Status fits = check_stored_derivation(options.scene, scene.product);
        if (!fits) return pass_on(fits);
        const auto store = open_store(options);
        if (!store) return pass_on(store);
        const auto until = until_of(options);
        if (!until) return pass_on(until);
        auto grids = stored_panels(*store, options.domain, panels, *until);
        if (!grids) return grids;
        for (PictureGrid& grid : *grids) {
            auto hail = with_merged_hail(*store, options, scene, std::move(grid));
            if (!hail) return pass_on(hail);
            grid = std::move(*hail);
        }
        return grids;
    }
    take_moment(options.scene, options.grid);
    options.grid.threads = render::thread_count(options.scene);
    options.grid.time = options.time;
    if (product.hail != nullptr) {
        options.grid.assumed_zero_c_m = scene.freezing_levels.zero_c_m;
        options.grid.moment = level2::moment_name(scene.moment);
        auto hail = hail_grid_of_files(options.grid, scene.freezing_levels);
        if (!hail) return pass_on(hail);
        print_layer_notes(options, hail->description().provenance.notes);
        options.domain = hail->name();
        std::vector<PictureGrid> grids;  // hail is made of reflectivity, so there is one panel
        grids.push_back(std::move(*hail));
        return grids;
    }
    auto grids = gridded_panels(options.grid, panels);
    if (!grids) return grids;
    for (const PictureGrid& grid : *grids)
        print_layer_notes(options, grid.description().provenance.notes);
    options.domain = grids->front().name();
    return grids;
}

}  // namespace stormcellar::cli
