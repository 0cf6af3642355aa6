#include "cli/loop/sweep_loop.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/loop/files_loop.h"
#include "cli/loop/loop_encoding.h"
#include "cli/loop/loop_report.h"
#include "cli/loop/swept_cells.h"
#include "cli/picture/picture.h"
#include "cli/picture/picture_grid.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/raw_volume.h"
#include "cli/picture/stored_cells.h"
#include "cli/picture/swept_volume.h"
#include "cli/shared/commands.h"
#include "cli/shared/progress.h"
#include "pipeline/drop/archive_volumes.h"
#include "render/frame/frame_cache.h"
#include "render/frame/overlay_text.h"
#include "render/frame/picture_metadata.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/render/render.h"

namespace stormcellar::cli {
namespace {

constexpr double elevations_reach_m = 230e3;

// One volume, and how to read it.
struct RawSource {
    std::filesystem::path path;
    std::function<Result<RawVolume>(const catalog::CatalogReader&)> read;
};

struct SweepSources {
    std::optional<catalog::CatalogReader> catalog;  // for reading volumes that the catalog has
    std::vector<RawSource> volumes;                 // ascending in time
    std::optional<cache::StoreReader> store;        // has grids of the volumes of a domain
};

// One frame: a sweep of a volume.
struct SweepFrame {
    std::size_t volume = 0;
    double elevation_deg = render::Scene::lowest_sweep;
    UtcTime time;
    // Chooses among several sweeps of the elevation; none: the newest.
    std::optional<UtcTime> nearest_to;
};

// State that the frames share, with the volume that was decoded last.
struct SweepDrawing {
    GridOptions grid;
    render::Scene scene;
    bool all_elevations = false, repeats = false;
    std::optional<std::size_t> decoded;
    std::optional<SweptVolume> volume;
    std::optional<grid::GridSpec> plane;  // plane of the first frame
    render::FrameCache cache;
    // Storm cells to mark, from grids of the cache or from the volumes. None if not asked for.
    std::optional<StoredCells> stored_cells;
    std::optional<SweptCells> swept_cells;
    std::optional<render::ShapeOverlay> shapes;
};

Status check_sweep_loop(const LoopOptions& options) {
    if (!options.interval.empty()) {
        return fail(ErrorCode::bad_argument,
                    "--interval puts frames between grids; a ppi shows sweeps as they are");
    }
    if (options.frames > 0) {
        return fail(
            ErrorCode::bad_argument,
            "--frames is for a camera that moves; a loop of a ppi has a frame of each of its "
            "sweeps");
    }
    return {};
}

// Returns the volumes of an archive's catalog, or of the files that were cataloged.
Result<SweepSources> sources_of_archive(const LoopOptions& options) {
    const auto request = parse_archive(options.archive);
    if (!request) return pass_on(request);
    const auto range = parse_time_range(options.range);
    if (!range) return pass_on(range);
    if (!range->from || !range->to) {
        return fail(ErrorCode::bad_argument, "--catalog needs --from and --to");
    }
    if (request->stations.size() != 1) {
        return fail(ErrorCode::bad_argument,
                    "a ppi shows sweeps of one radar{}; name it with --stations",
                    request->stations.empty()
                        ? std::string{}
                        : fmt::format(", and there are {}", request->stations.size()));
    }
    SweepSources sources;
    auto catalog = catalog::CatalogReader::open(options.archive.catalog);
    if (!catalog) return pass_on(catalog);
    sources.catalog.emplace(std::move(*catalog));
    const auto volumes =
        pipeline::archive_volumes(*sources.catalog, request->stations,
                                  {*range->from, *range->to, false, options.archive_files});
    if (!volumes) return pass_on(volumes);
    for (const pipeline::ArchiveVolume& volume : *volumes) {
        sources.volumes.push_back({volume.path, [volume](const catalog::CatalogReader& reader) {
                                       return raw_volume_at(reader, volume.station, volume.start,
                                                            volume.path);
                                   }});
    }
    return sources;
}

// Returns the volumes from which the grids of a domain were made.
Result<SweepSources> sources_of_domain(const LoopOptions& options) {
    const auto range = parse_time_range(options.range);
    if (!range) return pass_on(range);
    const auto store = cache::StoreReader::open(options.cache);
    if (!store) return pass_on(store);
    auto grids = grids_of_any_moment(*store, options.domain, range->from, range->to);
    if (!grids) return pass_on(grids);
    if (!range->to) cache::leave_out_future(*grids, now_utc());
    PlaceOption place{Directory::catalog, {}, options.cache_place.config};
    if (Status found = place.find(); !found) return pass_on(found);
    SweepSources sources;
    auto catalog = catalog::CatalogReader::open(place.directory);
    if (!catalog) return pass_on(catalog);
    sources.catalog.emplace(std::move(*catalog));
    sources.store = *store;
    for (const cache::StoreEntry& entry : *grids) {
        sources.volumes.push_back(
            {entry.path, [entry](const catalog::CatalogReader& reader) -> Result<RawVolume> {
                 const auto grid = cache::GridFile::open(entry.path);
                 if (!grid) return pass_on(grid);
                 return raw_volume_of(reader, entry.domain, grid->description());
             }});
    }
    return sources;
}

// Returns the decoded volume. Decodes the volume unless it is the one that was decoded last.
Result<const SweptVolume*> volume_of(const SweepSources& sources, std::size_t number,
                                     SweepDrawing& drawing) {
    if (drawing.decoded == number) return &*drawing.volume;
    drawing.decoded.reset();
    const auto raw = sources.volumes[number].read(*sources.catalog);
    if (!raw) return pass_on(raw);
    auto volume =
        decode_sweeps(*raw, drawing.grid, drawing.all_elevations ? nullptr : &drawing.scene);
    if (!volume) return pass_on(volume);
    drawing.volume.emplace(std::move(*volume));
    drawing.decoded = number;
    return &*drawing.volume;
}

// Limits the plane to the extent of a station's usual grid, unless the options set its size. A loop
// through all elevations needs no more, because its high sweeps reach only some kilometers.
void limit_plane(const SweptVolume& volume, grid::GridSpec& plane) {
    if (volume.request.extent_given) return;
    const auto limited = [](int cells, double width_m) {
        return std::min(cells, static_cast<int>(2 * elevations_reach_m / width_m));
    };
    plane.nx = limited(plane.nx, plane.cell_width_m());
    plane.ny = limited(plane.ny, plane.cell_height_m());
}

// Returns the sweep of a frame, on the plane of the first frame.
Result<PictureGrid> sweep_of(SweptVolume volume, const SweepFrame& frame, SweepDrawing& drawing) {
    drawing.scene.elevation_deg = frame.elevation_deg;
    if (frame.nearest_to) volume.request.frame_time = frame.nearest_to;
    if (!drawing.plane) {
        const auto first = PictureGrid::of_sweep(volume, drawing.scene);
        if (!first) return pass_on(first);
        drawing.plane = first->description().spec;
        if (drawing.all_elevations) limit_plane(volume, *drawing.plane);
    }
    return PictureGrid::of_sweep(std::move(volume), drawing.scene, &*drawing.plane);
}

// Returns the middle of each sweep's time, in ascending order.
std::vector<UtcTime> times_of_sweeps(const SweptVolume& volume) {
    std::vector<UtcTime> times;
    for (const level2::Sweep& sweep : volume.source().volume.sweeps) {
        const UtcTime start = sweep.radials.front().time, end = sweep.radials.back().time;
        if (sweep.find(volume.request.moment) != nullptr)
            times.push_back(start + (end - start) / 2);
    }
    std::ranges::sort(times);
    return times;
}

// Returns the frames that a volume may have. With --repeats, there is a frame for the time of each
// sweep of the volume. The frame shows the sweep of the chosen elevation that is nearest to that
// time, so several frames may show the same sweep.
std::vector<SweepFrame> frames_to_try(std::size_t number, const SweptVolume& volume,
                                      double asked_deg, const SweepDrawing& drawing) {
    std::vector<SweepFrame> frames;
    if (drawing.all_elevations) {
        for (const double elevation_deg : elevations_of(volume))
            frames.push_back({number, elevation_deg, {}, {}});
    } else if (drawing.repeats) {
        for (const UtcTime time : times_of_sweeps(volume))
            frames.push_back({number, asked_deg, {}, time});
    } else {
        frames.push_back({number, asked_deg, {}, {}});
    }
    return frames;
}

// Finds the frames of each volume. Reports and skips volumes that cannot be read.
std::vector<SweepFrame> frames_of(const SweepSources& sources, const std::atomic<bool>& stop,
                                  SweepDrawing& drawing, LoopReport& report) {
    std::vector<SweepFrame> frames;
    const auto leave_out = [&](std::size_t number, const Error& error) {
        report.skipped.push_back({sources.volumes[number].path, error.message});
        warn_skipped(report.skipped.back());
    };
    const double asked_deg = drawing.scene.elevation_deg;
    for (std::size_t i = 0; i < sources.volumes.size() && !stop; ++i) {
        const auto volume = volume_of(sources, i, drawing);
        if (!volume) {
            leave_out(i, volume.error());
            continue;
        }
        std::set<UtcTime> taken;
        for (SweepFrame& frame : frames_to_try(i, **volume, asked_deg, drawing)) {
            const auto sweep = sweep_of(**volume, frame, drawing);
            if (!sweep) {
                leave_out(i, sweep.error());
                if (frame.nearest_to) break;  // no sweep has nearly the chosen elevation
                continue;
            }
            frame.time = sweep->description().time;
            if (frame.nearest_to && !taken.insert(frame.time).second) continue;
            frames.push_back(frame);
        }
    }
    return frames;
}

void prepare_cells(const SweepSources& sources, const LoopOptions& options, SweepDrawing& drawing) {
    if (!render::marks_cells(options.scene)) return;
    const auto freezing = chosen_freezing_levels(options.scene, drawing.scene);
    if (sources.store) {
        drawing.stored_cells.emplace(*sources.store, options.domain, freezing);
    } else {
        drawing.swept_cells.emplace(drawing.grid, freezing);
    }
}

// Returns the storm cells to mark in a frame, or none.
Result<std::optional<render::CellOverlay>> cells_of_frame(const SweepSources& sources,
                                                          const SweepFrame& frame,
                                                          SweepDrawing& drawing) {
    std::optional<render::CellOverlay> cells;
    if (!drawing.stored_cells && !drawing.swept_cells) return cells;
    auto found = drawing.stored_cells
                     ? drawing.stored_cells->at(frame.time)
                     : drawing.swept_cells->of(frame.volume, sources.volumes[frame.volume].path);
    if (!found) return pass_on(found);
    cells = std::move(*found);
    return cells;
}

Status draw_frame(const SweepSources& sources, const SweepFrame& frame, const LoopOptions& options,
                  SweepDrawing& drawing, Encoding& encoding, LoopReport& report) {
    const auto start = steady_now();
    const auto volume = volume_of(sources, frame.volume, drawing);
    if (!volume) return pass_on(volume);
    const auto sweep = sweep_of(**volume, frame, drawing);
    if (!sweep) return pass_on(sweep);
    const auto cells = cells_of_frame(sources, frame, drawing);
    if (!cells) return pass_on(cells);
    report.read_s += seconds_since(start);
    const auto read = steady_now();
    const auto facts =
        frame_facts_of(options.domain, sweep->description(), options.scene.time_zone);
    auto picture = render::render_frame(sweep->view(), facts, drawing.scene,
                                        render::thread_count(options.scene), &drawing.cache,
                                        {.cells = *cells ? &**cells : nullptr,
                                         .shapes = drawing.shapes ? &*drawing.shapes : nullptr});
    if (!picture) return pass_on(picture);
    report.render_s += seconds_since(read);
    if (report.frames == 0) report.from = report.to = frame.time;
    report.to = std::max(report.to, frame.time);
    ++report.frames;
    return encoding.add(std::move(*picture));
}

// Writes the description of the loop into the files. Describes the first frame for all frames.
Status describe_loop(const SweepSources& sources, const std::vector<SweepFrame>& frames,
                     SweepDrawing& drawing, LoopOptions& options) {
    const auto volume = volume_of(sources, frames.front().volume, drawing);
    if (!volume) return pass_on(volume);
    const auto sweep = sweep_of(**volume, frames.front(), drawing);
    if (!sweep) return pass_on(sweep);
    if (options.domain.empty()) options.domain = sweep->name();
    const auto facts =
        frame_facts_of(options.domain, sweep->description(), options.scene.time_zone);
    const auto error = plan_picture(sweep->view(), facts, options.plan, options.json,
                                    render::thread_count(options.scene), drawing.scene);
    if (!error) return pass_on(error);
    const auto [from, to] = std::ranges::minmax(frames, {}, &SweepFrame::time);
    render::PictureFacts told{options.domain, from.time, to.time, frames.size(), "", *error};
    if (render::marks_cells(options.scene))
        told.cells = render::cells_method(chosen_freezing_levels(options.scene, drawing.scene));
    told.shapes = render::shape_names(options.scene);
    options.animation.metadata = render::metadata_of(
        told, sweep->description(), render::scene_shown(sweep->view(), drawing.scene));
    return {};
}

Status write_loop(const SweepSources& sources, const std::vector<SweepFrame>& frames,
                  const LoopOptions& options, const std::atomic<bool>& stop, SweepDrawing& drawing,
                  LoopReport& report) {
    auto shapes = render::read_shapes(options.scene);
    if (!shapes) return pass_on(shapes);
    drawing.shapes = std::move(*shapes);
    auto writers = make_writers(options.outputs, options.animation);
    if (!writers) return pass_on(writers);
    Encoding encoding(std::move(*writers));
    Progress progress("frames", frames.size(), !options.quiet);
    for (std::size_t i = 0; i < frames.size() && !stop; ++i) {
        if (auto drawn = draw_frame(sources, frames[i], options, drawing, encoding, report); !drawn)
            return drawn;
        progress.show(i + 1);
    }
    report.interrupted = stop;
    if (stop) return {};
    if (auto finished = encoding.finish(stop); !finished) return finished;
    report.encode_s = encoding.encode_s();
    return {};
}

Result<SweepSources> find_sources(LoopOptions& options, Interrupt& interrupt) {
    if (auto fine = check_sweep_loop(options); !fine) return pass_on(fine);
    if (!options.files.empty()) {
        if (auto made = catalog_files(options, interrupt); !made) return pass_on(made);
    }
    auto sources =
        options.archive.asked() ? sources_of_archive(options) : sources_of_domain(options);
    if (sources && options.last > 0 && std::cmp_greater(sources->volumes.size(), options.last)) {
        sources->volumes.erase(sources->volumes.begin(), sources->volumes.end() - options.last);
    }
    return sources;
}

int end_interrupted(Interrupt& interrupt) {
    fmt::print(stderr, "stormcellar: interrupted; unfinished loops were not written\n");
    interrupt.end_by_signal();
    return exit_failed;
}

}  // namespace

int run_sweep_loop(LoopOptions options, const render::Scene& scene, Interrupt& interrupt,
                   SteadyTime start) {
    const auto sources = find_sources(options, interrupt);
    if (!sources) return report_error(sources.error());
    SweepDrawing drawing;
    drawing.grid = options.archive.place;
    take_moment(options.scene, drawing.grid);
    drawing.grid.threads = render::thread_count(options.scene);
    drawing.scene = scene;
    drawing.all_elevations = options.all_elevations;
    drawing.repeats = options.repeats;
    LoopReport report;
    auto frames = frames_of(*sources, interrupt.flag(), drawing, report);
    if (interrupt.flag()) return end_interrupted(interrupt);
    if (frames.empty()) {
        fmt::print(stderr, "stormcellar: no volume{} gives a frame\n",
                   options.domain.empty() ? "" : " of " + printable(options.domain));
        return exit_nothing_matched;
    }
    if (options.ping_pong) {
        for (std::size_t i = frames.size(); i > 2; --i)
            frames.push_back(SweepFrame{frames[i - 2]});
    }
    if (auto described = describe_loop(*sources, frames, drawing, options); !described)
        return report_error(described.error());
    prepare_cells(*sources, options, drawing);
    if (auto made = write_loop(*sources, frames, options, interrupt.flag(), drawing, report); !made)
        return report_error(made.error());
    if (report.interrupted) return end_interrupted(interrupt);
    if (auto left = leave_files(options); !left) return report_error(left.error());
    report.total_s = seconds_since(start);
    print_report(options, scene, report);
    return exit_done;
}

}  // namespace stormcellar::cli
