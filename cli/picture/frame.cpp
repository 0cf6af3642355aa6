// stormcellar frame: draws one still picture, of files or of a grid in the cache.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/floating_point.h"
#include "base/name_list.h"
#include "base/steady_time.h"
#include "cli/picture/fitted_view.h"
#include "cli/picture/picture.h"
#include "cli/picture/picture_grid.h"
#include "cli/picture/picture_metadata.h"
#include "cli/picture/picture_panels.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/raw_volume.h"
#include "cli/picture/scene_file.h"
#include "cli/picture/scene_options.h"
#include "cli/picture/still_output.h"
#include "cli/shared/cache_domain.h"
#include "cli/shared/commands.h"
#include "cli/shared/query_options.h"
#include "cli/shared/service_places.h"
#include "render/frame/probe.h"
#include "render/products/section.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/version.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/still.h"

namespace stormcellar::cli {
namespace {

struct FrameOptions {
    std::vector<std::string> sources;  // files, or a domain
    std::string domain;
    PlaceOption cache;
    PlaceOption catalog{Directory::catalog, {}, {}};  // of a ppi of a domain
    GridOptions grid;                                 // of files
    std::string time;                                 // empty: the latest
    std::string output;                               // empty: nothing is drawn, only probed
    std::string panels;    // moments of a picture with several; empty: one
    std::string probe;     // "X,Y"
    std::string probe_at;  // "LAT,LON"
    std::string geotiff;   // what a GeoTIFF holds
    render::TiffContent tiff = render::TiffContent::values;
    bool json = false;
    SceneFile scene_file;
    SceneOptions scene;
    PicturePlanOptions plan;
};

// Returns the time at or before which a grid is looked for; none: now.
Result<std::optional<UtcTime>> until_of(const FrameOptions& options) {
    if (options.time.empty()) return std::optional<UtcTime>{};
    const auto time = parse_utc(options.time, now_utc());
    if (!time) return fail(time.error().code, "--time: {}", time.error().message);
    return std::optional{*time};
}

// Returns the newest grid of the domain at or before the time, of this moment or of any; none if
// there is none.
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

struct Timing {
    double read_s = 0, render_s = 0, write_s = 0, total_s = 0;
};

using Json = nlohmann::ordered_json;

Json json_or_null(const std::optional<double>& number) {
    return number ? Json(*number) : Json();
}

Json json_of(const render::Probe& probe) {
    const bool valued = probe.status == grid::CellStatus::value;
    Json json{{"latitude_deg", probe.place.latitude_deg},
              {"longitude_deg", probe.place.longitude_deg},
              {"status", grid::cell_status_name(probe.status)},
              {"value", valued ? Json(probe.value) : Json()},
              {"unit", probe.unit},
              {"at_least", probe.at_least},
              {"height_m", json_or_null(probe.height_m)},
              {"lowest_seen_m", json_or_null(probe.lowest_seen_m)},
              {"highest_seen_m", json_or_null(probe.highest_seen_m)}};
    if (probe.distance_m) json["distance_m"] = *probe.distance_m;
    if (probe.gate) {
        json["gate"] = {
            {"radial", probe.gate->radial},           {"gate", probe.gate->gate},
            {"azimuth_deg", probe.gate->azimuth_deg}, {"elevation_deg", probe.gate->elevation_deg},
            {"range_m", probe.gate->range_m},         {"time", format_utc(probe.gate->time)}};
    }
    return json;
}

// Prints a line for the place, one for what is there, and one for how far the column was seen.
void print_probe(const render::Probe& probe, const FrameOptions& options,
                 const render::Scene& scene, const cache::GridDescription& grid) {
    fmt::print("{} {}, {}\n", printable(options.domain), format_utc(grid.time),
               render::product_title(scene));
    fmt::print("place  {}", render::place_text(probe.place));
    if (probe.distance_m) fmt::print(", {:.1f} km from A", *probe.distance_m / 1000);
    fmt::print("\nvalue  {}", render::probe_text(probe));
    if (probe.height_m) fmt::print(" at {:.4g} km", *probe.height_m / 1000);
    if (probe.gate) {
        fmt::print(
            "\ngate   {} of radial {}: azimuth {:.2f}, elevation {:.2f} degrees, range {:g} km\n"
            "time   {}\n",
            probe.gate->gate, probe.gate->radial, probe.gate->azimuth_deg,
            probe.gate->elevation_deg, probe.gate->range_m / 1000, format_utc(probe.gate->time));
    } else if (render::facts_of(scene.product).is_of_sweep) {
        fmt::print("\nseen   by no radial\n");
    } else if (probe.lowest_seen_m) {
        fmt::print("\nseen   {:g} to {:g} km\n", *probe.lowest_seen_m / 1000,
                   *probe.highest_seen_m / 1000);
    } else {
        fmt::print("\nseen   at no height\n");
    }
}

using MaybeProbe = std::optional<render::Probe>;

void report_frame(const FrameOptions& options, const render::Scene& scene,
                  const cache::GridDescription& grid, const Timing& timing,
                  const MaybeProbe& probe) {
    if (!options.json) {
        if (probe) print_probe(*probe, options, scene, grid);
        if (options.output.empty()) return;
        const bool is_data = still_format(options.output).encode_map != nullptr;
        fmt::print(stderr, "{}: {} {}, {}, {} x {} {}, {:.0f} ms\n", printable(options.output),
                   printable(options.domain), format_utc(grid.time), options.scene.product,
                   is_data ? grid.spec.nx : scene.width, is_data ? grid.spec.ny : scene.height,
                   is_data ? "cells" : "pixels", timing.total_s * 1e3);
        return;
    }
    Json json;
    if (!options.output.empty()) json["output"] = options.output;
    json["domain"] = options.domain;
    json["time"] = format_utc(grid.time);
    json["product"] = options.scene.product;
    json["moment"] = options.scene.moment;
    json["width"] = scene.width;
    json["height"] = scene.height;
    json["partial"] = grid.provenance.partial;
    if (probe) json["probe"] = json_of(*probe);
    json["read_s"] = timing.read_s;
    json["render_s"] = timing.render_s;
    json["write_s"] = timing.write_s;
    json["total_s"] = timing.total_s;
    fmt::print("{}\n", json.dump(1, ' ', true, Json::error_handler_t::replace));
}

Result<MaybeProbe> probe_grid(const FrameOptions& options, const render::Scene& scene,
                              const PictureGrid& file) {
    const auto facts = facts_of(options.domain, file.description(), options.scene.time_zone);
    const int threads = thread_count(options.scene);
    const auto as_maybe = [](Result<render::Probe> probe) -> Result<MaybeProbe> {
        if (!probe) return pass_on(probe);
        return MaybeProbe{std::move(*probe)};
    };
    if (!options.probe.empty()) {
        const auto pixel = numbers_of("--probe", options.probe, 2);
        if (!pixel) return pass_on(pixel);
        const double x = (*pixel)[0];
        const double y = (*pixel)[1];
        if (std::floor(x) != x || std::floor(y) != y) {
            return fail(ErrorCode::bad_argument, "--probe needs two whole numbers, not '{}'",
                        options.probe);
        }
        if (!is_within(x, 0.0, scene.width - 1.0) || !is_within(y, 0.0, scene.height - 1.0)) {
            return fail(ErrorCode::bad_argument,
                        "--probe {} lies outside the picture of {} x {} pixels: 0,0 to {},{}",
                        options.probe, scene.width, scene.height, scene.width - 1,
                        scene.height - 1);
        }
        return as_maybe(render::probe_pixel(file.view(), facts, scene, static_cast<int>(x),
                                            static_cast<int>(y), threads));
    }
    if (!options.probe_at.empty()) {
        const auto place = numbers_of("--probe-at", options.probe_at, 2);
        if (!place) return pass_on(place);
        return as_maybe(
            render::probe_place(file.view(), facts, scene, {(*place)[0], (*place)[1]}, threads));
    }
    return MaybeProbe{};
}

// Draws the scene and encodes the picture; of a format of maps, encodes the map of the grid
// instead. Calls `drawn` between the two.
Result<std::vector<std::byte>> encode_frame(const render::StillFormat& format,
                                            const render::StillMap& shown,
                                            const render::StillOptions& options,
                                            const std::function<void()>& drawn) {
    if (format.encode_map != nullptr) return format.encode_map(shown, options);
    const auto picture =
        render::render_frame(shown.view, shown.facts, shown.scene, options.threads);
    if (!picture) return pass_on(picture);
    drawn();
    return format.encode_picture(*picture, options);
}

Result<Timing> make_frame(const FrameOptions& options, const render::Scene& scene,
                          const PictureGrid& file, SteadyTime start) {
    Timing timing;
    timing.read_s = seconds_since(start);
    const auto facts = facts_of(options.domain, file.description(), options.scene.time_zone);
    const int threads = thread_count(options.scene);
    render::Scene planned = scene;
    const auto done =
        plan_picture(file.view(), facts, options.plan, options.json, threads, planned);
    if (!done) return pass_on(done);
    const PictureFacts told{
        options.domain, file.description().time, file.description().time, std::nullopt, {}, *done};
    render::StillOptions still{.metadata = metadata_of(told, file.description(), planned),
                               .tiff = options.tiff,
                               .threads = threads};
    // A map as data has no picture's size.
    if (still_format(options.output).encode_map != nullptr)
        std::erase_if(still.metadata, [](const auto& text) { return text.first == "Picture"; });
    const render::StillMap map{file.view(), facts, planned};
    const auto bytes = encode_frame(still_format(options.output), map, still, [&] {
        timing.render_s = seconds_since(start) - timing.read_s;
    });
    if (!bytes) return pass_on(bytes);
    if (Status whole = file.check_whole(); !whole) return pass_on(whole);
    if (auto written = write_still(options.output, *bytes); !written) return pass_on(written);
    timing.total_s = seconds_since(start);
    timing.write_s = timing.total_s - timing.read_s - timing.render_s;
    return timing;
}

Status check_options(const FrameOptions& options) {
    const bool probes = !options.probe.empty() || !options.probe_at.empty();
    if (!options.probe.empty() && !options.probe_at.empty()) {
        return fail(ErrorCode::bad_argument, "--probe and --probe-at cannot be used together");
    }
    if (options.output.empty()) {
        if (probes) return {};
        return fail(ErrorCode::bad_argument,
                    "there is nothing to do; give -o, --probe or --probe-at");
    }
    return {};
}

// Checks what -o and --geotiff say together with the product.
Status check_output(FrameOptions& options, render::Product product) {
    if (options.output.empty()) return {};
    if (Status fits = check_still_output(options.output, product, options.json); !fits) return fits;
    const auto tiff = parse_tiff_content(options.geotiff, options.output);
    if (!tiff) return pass_on(tiff);
    options.tiff = *tiff;
    return {};
}

Status refuse_grid_options(const FrameOptions& options) {
    if (!has_picture_grid_options(options.grid)) return {};
    return fail(ErrorCode::bad_argument,
                "options of the grid, such as --center, are for files; the grids of the cache are "
                "made already");
}

// Opens the cache and says which domain is meant.
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

// Returns none, after it was reported, if no grid matched.
Result<std::optional<PictureGrid>> stored_grid(FrameOptions& options, level2::Moment moment) {
    if (Status none = refuse_grid_options(options); !none) return pass_on(none);
    const auto store = open_store(options);
    if (!store) return pass_on(store);
    const auto entry = find_grid(*store, options, moment);
    if (!entry) return pass_on(entry);
    if (!*entry) {
        report_nothing(*store, options, moment);
        return std::optional<PictureGrid>{};
    }
    auto grid = PictureGrid::open((*entry)->path);
    if (!grid) return pass_on(grid);
    return std::optional{std::move(*grid)};
}

// Draws from the raw volume of the newest grid, of whichever moment. Returns none, after it was
// reported, if there is no grid.
Result<std::optional<PictureGrid>> stored_sweep(FrameOptions& options, const render::Scene& scene) {
    const auto store = open_store(options);
    if (!store) return pass_on(store);
    const auto entry = find_grid(*store, options, std::nullopt);
    if (!entry) return pass_on(entry);
    if (!*entry) {
        report_nothing(*store, options, scene.moment);
        return std::optional<PictureGrid>{};
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
    options.grid.moment = options.scene.moment;
    options.grid.threads = thread_count(options.scene);
    auto volume = decode_sweeps(raw->bytes, raw->file, options.grid, &scene);
    if (!volume) return pass_on(volume);
    auto sweep = PictureGrid::of_sweep(std::move(*volume), scene);
    if (!sweep) return pass_on(sweep);
    return std::optional{std::move(*sweep)};
}

Result<PictureGrid> sweep_of_file(const GridOptions& options, const render::Scene& scene) {
    auto volume = read_sweeps(options, &scene);
    if (!volume) return pass_on(volume);
    return PictureGrid::of_sweep(std::move(*volume), scene);
}

Result<std::optional<PictureGrid>> grid_of_files(FrameOptions& options,
                                                 const render::Scene& scene) {
    options.grid.moment = options.scene.moment;
    options.grid.threads = thread_count(options.scene);
    options.grid.time = options.time;
    auto grid = render::facts_of(scene.product).is_of_sweep ? sweep_of_file(options.grid, scene)
                                                            : PictureGrid::make(options.grid);
    if (!grid) return pass_on(grid);
    options.domain = grid->name();
    return std::optional{std::move(*grid)};
}

// Sorts the words of the command line into files and a domain.
Status take_sources(FrameOptions& options) {
    auto names = tell_apart_from_cache(options.sources, options.domain, options.cache);
    if (!names) return pass_on(names);
    options.grid.files = std::move(names->files);
    options.domain = std::move(names->domain);
    return {};
}

Result<std::vector<PictureGrid>> grids_of_panels(FrameOptions& options,
                                                 const std::vector<PanelScene>& panels) {
    if (Status taken = take_sources(options); !taken) return pass_on(taken);
    if (options.grid.files.empty()) {
        if (Status none = refuse_grid_options(options); !none) return pass_on(none);
        if (render::facts_of(panels.front().scene.product).is_of_sweep) {
            return fail(ErrorCode::bad_argument,
                        "panels of sweeps are drawn of a Level II file; name it");
        }
        const auto store = open_store(options);
        if (!store) return pass_on(store);
        const auto until = until_of(options);
        if (!until) return pass_on(until);
        return stored_panels(*store, options.domain, panels, *until);
    }
    options.grid.threads = thread_count(options.scene);
    options.grid.time = options.time;
    auto grids = gridded_panels(options.grid, panels);
    if (grids) options.domain = grids->front().name();
    return grids;
}

Result<Timing> make_panels(FrameOptions& options, const std::vector<PanelScene>& panels,
                           const std::vector<PictureGrid>& grids, SteadyTime start) {
    Timing timing;
    timing.read_s = seconds_since(start);
    const auto picture = draw_panels(options.domain, panels, grids, options.scene);
    if (!picture) return pass_on(picture);
    timing.render_s = seconds_since(start) - timing.read_s;
    const auto& first = grids.front().description();
    const render::StillOptions still{
        .metadata = metadata_of({options.domain, first.time, first.time, std::nullopt, {}, {}},
                                first, panels.front().scene)};
    const auto bytes = still_format(options.output).encode_picture(*picture, still);
    if (!bytes) return pass_on(bytes);
    if (auto written = write_still(options.output, *bytes); !written) return pass_on(written);
    timing.total_s = seconds_since(start);
    timing.write_s = timing.total_s - timing.read_s - timing.render_s;
    return timing;
}

int run_panels(FrameOptions& options, SteadyTime start) {
    if (!options.probe.empty() || !options.probe_at.empty()) {
        return report_error({ErrorCode::bad_argument,
                             "--probe and --probe-at are for a picture of one moment, not for "
                             "--panels"});
    }
    if (options.plan.asked()) {
        return report_error({ErrorCode::bad_argument,
                             "--tolerance, --effect and --explain plan a picture of one volume; "
                             "they are not for --panels"});
    }
    const auto panels = panel_scenes(options.panels, options.scene_file, options.scene);
    if (!panels) return report_error(panels.error());
    if (const Status fine = check_output(options, panels->front().scene.product); !fine)
        return report_error(fine.error());
    if (still_format(options.output).encode_picture == nullptr) {
        return report_error(
            {ErrorCode::bad_argument, "--panels makes a picture; GeoTIFF and KMZ hold one map"});
    }
    const auto grids = grids_of_panels(options, *panels);
    if (!grids) return report_error(grids.error());
    if (grids->empty()) return exit_nothing_matched;
    const auto timing = make_panels(options, *panels, *grids, start);
    if (!timing) return report_error(timing.error());
    options.scene.moment = options.panels;
    report_frame(options, panels->front().scene, grids->front().description(), *timing, {});
    return exit_done;
}

// Chooses what was not asked for by the echo. A sweep is seen from above, as it is.
Status fit_scene(const FrameOptions& options, const PictureGrid& grid, render::Scene& scene) {
    if (grid.view().sweep != nullptr) {
        scene = render::scene_shown(grid.view(), std::move(scene));
        return {};
    }
    const auto facts = facts_of(options.domain, grid.description(), options.scene.time_zone);
    const render::EchoOutline outline(grid.view(), scene.moment);
    const auto fitted = fit_picture(outline, grid.view(), facts, options.scene, scene);
    return fitted ? Status{} : pass_on(fitted);
}

Result<std::optional<PictureGrid>> find_picture_grid(FrameOptions& options,
                                                     const render::Scene& scene) {
    const bool is_of_sweep = render::facts_of(scene.product).is_of_sweep;
    if (!options.catalog.directory.empty() && (!is_of_sweep || !options.grid.files.empty())) {
        return fail(ErrorCode::bad_argument,
                    "--catalog says where the raw file of a ppi of a domain is; nothing else needs "
                    "it");
    }
    if (!options.grid.files.empty()) return grid_of_files(options, scene);
    return is_of_sweep ? stored_sweep(options, scene) : stored_grid(options, scene.moment);
}

int run_frame(FrameOptions options) {
    const auto start = steady_now();
    if (options.scene_file.error) return report_error(*options.scene_file.error);
    if (const Status fine = check_options(options); !fine) return report_error(fine.error());
    if (!options.panels.empty()) return run_panels(options, start);
    auto scene = scene_with(options.scene_file, options.scene);
    if (!scene) return report_error(scene.error());
    if (const Status fine = check_output(options, scene->product); !fine)
        return report_error(fine.error());
    auto plan = plan_beside_slices(options.plan, options.scene);
    if (!plan) return report_error(plan.error());
    options.plan = std::move(*plan);
    if (const Status taken = take_sources(options); !taken) return report_error(taken.error());
    const auto grid = find_picture_grid(options, *scene);
    if (!grid) return report_error(grid.error());
    if (!*grid) return exit_nothing_matched;
    if (const Status fitted = fit_scene(options, **grid, *scene); !fitted)
        return report_error(fitted.error());
    const auto probe = probe_grid(options, *scene, **grid);
    if (!probe) return report_error(probe.error());
    if (const Status whole = (*grid)->check_whole(); !whole) return report_error(whole.error());
    Timing timing{seconds_since(start), 0, 0, seconds_since(start)};
    if (!options.output.empty()) {
        const auto drawn = make_frame(options, *scene, **grid, start);
        if (!drawn) return report_error(drawn.error());
        timing = *drawn;
    }
    report_frame(options, *scene, (*grid)->description(), timing, *probe);
    return exit_done;
}

}  // namespace

Run set_up_frame(CLI::App& frame) {
    const auto options = std::make_shared<FrameOptions>();
    add_scene_file(frame, options->scene_file, options->scene, options->plan, nullptr);
    frame
        .add_option("FILE", options->sources,
                    "Level II files to draw, or a domain of the cache. Several files give a mosaic "
                    "of their sites. Tar and zip archives, directories and - for standard input "
                    "work too. A word with a slash, or one that names a file, is a file; every "
                    "other word is a domain")
        ->option_text("FILE...|DOMAIN");
    frame.add_option("--domain", options->domain,
                     "Domain of the cache; a station's own domain is its ICAO identifier. Default: "
                     "the only one");
    add_place(frame, options->cache);
    frame.add_option("--catalog", options->catalog.directory,
                     "Directory of the catalog (state/catalog), which says where the raw file of a "
                     "ppi of a domain is. Default: that of the service");
    frame.add_option("--time", options->time,
                     "Of a domain, draw the newest grid at or before this time, in UTC or relative "
                     "as -1h. Default: the latest grid. Of files, the time of the grid, as for "
                     "stormcellar grid");
    frame.add_option("-o,--output", options->output,
                     still_help() + ". It may be left out with --probe and --probe-at");
    frame.add_option(
        "--geotiff", options->geotiff,
        fmt::format("What a GeoTIFF holds: {}. values are those of the product, states "
                    "say why a place has none, colors are those of the color table. "
                    "Default: {}",
                    names_in(render::tiff_contents, ", ", " or "), render::tiff_contents[0].name));
    frame.add_option(
        "--panels", options->panels,
        "Show several moments of one time side by side, each with its own colors, as in "
        "REF,VEL,RHO,ZDR");
    frame.add_option(
        "--probe", options->probe,
        "Print the value at this pixel of the picture: X,Y, counted from 0,0 at the top left");
    frame.add_option("--probe-at", options->probe_at,
                     "Print the value at this place: LAT,LON in degrees (maps and volumes)");
    frame.add_flag("--json", options->json, "Print what was done as one JSON document");
    add_scene_options(frame, options->scene);
    add_picture_plan_options(frame, options->plan);
    add_picture_grid_options(frame, options->grid);
    return [options] { return run_frame(*options); };
}

}  // namespace stormcellar::cli
