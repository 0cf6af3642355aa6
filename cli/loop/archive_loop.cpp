#include "cli/loop/archive_loop.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <iterator>
#include <set>
#include <system_error>
#include <thread>

#include <fmt/ranges.h>

#include "base/byte_size.h"
#include "base/steady_time.h"
#include "cli/loop/files_loop.h"
#include "cli/picture/picture.h"
#include "cli/shared/commands.h"
#include "cli/shared/progress.h"
#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using pipeline::ArchiveVolume;
using pipeline::Domain;

// Time between two updates of the progress bar and two checks for Ctrl-C.
constexpr auto glance = std::chrono::milliseconds{50};
constexpr std::size_t most_names = 6;  // at most this many stations appear in a mosaic's name

std::string mosaic_name(const ArchiveCall& call, const std::vector<std::string>& stations) {
    if (!call.domain.empty()) return call.domain;
    if (stations.size() > most_names) return fmt::format("mosaic-of-{}", stations.size());
    return fmt::format("{}{}", fmt::join(stations, "-"), stations.size() == 1 ? "-alone" : "");
}

Result<Domain> mosaic_of(const ArchiveCall& call, const catalog::CatalogReader& catalog,
                         std::vector<pipeline::LeftOut>& left_out) {
    const ArchiveRequest& request = call.request;
    Domain domain;
    domain.stations = request.stations;
    const auto sites = pipeline::sites_of(catalog, domain.stations, left_out);
    if (sites.empty() && !request.bounds && !request.place.center_deg) {
        return fail(ErrorCode::bad_argument,
                    "the position of {} is not known; give --center or --bounds",
                    fmt::join(domain.stations, ", "));
    }
    auto spec = archive_spec(request, sites);
    if (!spec) return pass_on(spec);
    domain.spec = std::move(*spec);
    if (domain.stations.empty()) {
        const auto names = catalog.station_names();
        if (!names) return pass_on(names);
        for (const grid::SitePosition& site : pipeline::sites_of(catalog, *names, left_out)) {
            if (grid::site_window(domain.spec, site)) domain.stations.push_back(site.icao);
        }
    }
    domain.name = mosaic_name(call, domain.stations);
    domain.moments = {call.moment};
    if (call.interval) domain.interval = *call.interval;
    domain.overlap = request.overlap;
    domain.overlap_length_m = request.overlap_length_m;
    domain.time = call.time;
    return domain;
}

Result<pipeline::ArchivePlan> plan_of(const ArchiveCall& call,
                                      const catalog::CatalogReader& catalog) {
    pipeline::ArchivePlan plan;
    plan.stations = call.request.stations;
    plan.fill.moment = call.moment;
    plan.fill.derived = call.derived;
    plan.fill.threads = call.threads;
    if (plan.stations.size() == 1 && !call.request.place_given) {
        const auto shape = spec_about(call.request.place, 0, 0);
        if (!shape) return pass_on(shape);
        plan.fill.spacing_m = shape->spacing_m;
        plan.fill.nx = shape->nx;
        plan.fill.ny = shape->ny;
        plan.fill.levels_m = shape->levels_m;
    } else if (level2::facts_of(call.moment).is_derived) {
        return fail(ErrorCode::bad_argument,
                    "{} is made for single stations, not for mosaics; name one station, without "
                    "--bounds, --center and --projection",
                    level2::moment_name(call.moment));
    } else {
        auto mosaic = mosaic_of(call, catalog, plan.left_out);
        if (!mosaic) return pass_on(mosaic);
        plan.stations = mosaic->stations;
        plan.mosaic = plan.fill.domain = std::move(*mosaic);
    }
    if (!call.cache.empty()) {
        std::error_code error;
        plan.cache = fs::absolute(call.cache, error);
        if (error) return fail(ErrorCode::io, "{}: {}", call.cache.native(), error.message());
        return plan;
    }
    auto cache = pipeline::private_cache(call.catalog, call.moment, plan);
    if (!cache) return pass_on(cache);
    plan.cache = std::move(*cache);
    return plan;
}

// Runs `work` with a progress bar. An interrupt ends the program at once, which is safe because
// grids are committed whole.
template <class Work>
Status run_with_bar(const std::string& what, std::size_t total, bool wanted, Interrupt& interrupt,
                    Work work) {
    std::atomic<std::size_t> done{0};
    auto outcome = std::async(std::launch::async,
                              [&] { return work([&](std::size_t so_far) { done = so_far; }); });
    Progress bar(what, total, wanted);
    while (outcome.wait_for(glance) != std::future_status::ready && !interrupt.flag())
        bar.show(done);
    if (interrupt.flag()) {
        bar.clear();
        fmt::print(
            stderr,
            "stormcellar: interrupted after {} of {} {}; the next run continues from there\n",
            done.load(), total, what);
        interrupt.end_by_signal();
    }
    return outcome.get();
}

std::set<std::string> stations_of(const std::vector<ArchiveVolume>& volumes) {
    std::set<std::string> stations;
    for (const ArchiveVolume& volume : volumes)
        stations.insert(volume.station);
    return stations;
}

// Checks the stations. If the catalog lacks a named station, the user made a mistake, so this
// writes a message into `nothing`.
Status check_stations(const ArchiveCall& call, const catalog::CatalogReader& catalog,
                      std::string& nothing) {
    const auto known = catalog.station_names();
    if (!known) return pass_on(known);
    if (known->empty()) {
        return fail(ErrorCode::not_found,
                    "{}: there is no catalog here; name the directory STATE/catalog of a daemon",
                    call.catalog.native());
    }
    for (const std::string& station : call.request.stations) {
        if (std::find(known->begin(), known->end(), station) != known->end()) continue;
        nothing = fmt::format("the catalog has no volume of {}", station);
    }
    return {};
}

void note_without_volumes(const ArchiveCall& call, const std::vector<ArchiveVolume>& volumes) {
    const auto with_volumes = stations_of(volumes);
    for (const std::string& station : call.request.stations) {
        if (with_volumes.contains(station)) continue;
        fmt::print(stderr, "stormcellar: warning: the catalog has no volume of {} in that time\n",
                   station);
    }
}

// Prints how much must be done, and refuses to fill a cache that has too little space.
Status announce(const ArchiveCall& call, const pipeline::ArchivePlan& plan,
                const pipeline::ArchiveFill& fill, const std::vector<ArchiveVolume>& volumes,
                const std::vector<ArchiveVolume>& missing, std::size_t frames) {
    std::uint64_t raw_bytes = 0;
    for (const ArchiveVolume& volume : missing)
        raw_bytes += volume.size_bytes;
    const std::uint64_t need = fill.bytes_of(missing.size(), frames);
    const auto filling = cache::filling_of(plan.cache);
    if (!filling) return pass_on(filling);
    const std::uint64_t free = filling->capacity_bytes - filling->used_bytes;
    const bool is_done = missing.empty() && frames == 0;
    const std::string about =
        fmt::format("{} {} of {}: ", volumes.size(), plural(volumes.size(), "volume"),
                    fmt::join(stations_of(volumes), " ")) +
        (is_done ? fmt::format("all grids are in {} already", plan.cache.native())
                 : fmt::format("{} have their grids in {} already, {} must be read ({}){}; the "
                               "new grids take about {} ({} free)",
                               volumes.size() - missing.size(), plan.cache.native(), missing.size(),
                               format_byte_size(raw_bytes),
                               frames > 0 ? fmt::format(" and {} {} must be made", frames,
                                                        plural(frames, "mosaic"))
                                          : "",
                               format_byte_size(need), format_byte_size(free)));
    if (need > free) {
        return fail(ErrorCode::no_space,
                    "{}: there is not enough room; use --cache on another disk, a wider "
                    "--spacing-km or a shorter time",
                    about);
    }
    if (!call.quiet) fmt::print(stderr, "{}\n", printable(about));
    return {};
}

void warn(const std::vector<pipeline::LeftOut>& files, std::string_view what) {
    for (const pipeline::LeftOut& file : files) {
        const std::string name = file.path.empty() ? "" : file.path.native() + ": ";
        fmt::print(stderr, "stormcellar: warning: {}{}\n", what, printable(name + file.reason));
    }
}

// Reports the files that were left out, with the reasons. If a grid of such a file exists from an
// earlier run, the reason says so.
void say_left_out(const ArchiveCall& call, const std::vector<ArchiveVolume>& missing,
                  ArchiveGrids& grids) {
    for (pipeline::LeftOut& file : grids.report.left_out) {
        const auto volume =
            std::find_if(missing.begin(), missing.end(),
                         [&](const ArchiveVolume& one) { return one.path == file.path; });
        if (volume == missing.end()) continue;
        const std::string domain =
            grids.mosaic ? grids.domain + "." + volume->station : volume->station;
        const auto path = grids.store->path_of(domain, call.moment, volume->start);
        std::error_code ignored;
        if (path && fs::exists(*path, ignored)) {
            file.reason += "; the grid that was made from it earlier stays";
        }
    }
    warn(grids.report.left_out, "left out: ");
}

// Makes the missing grids, with one progress bar for the volumes and one for a mosaic's frames.
Status fill(const ArchiveCall& call, pipeline::ArchiveFill& filling,
            const std::vector<ArchiveVolume>& missing, const std::vector<UtcTime>& instants,
            Interrupt& interrupt, ArchiveGrids& grids) {
    const auto start = steady_now();
    pipeline::FillReport& report = grids.report;
    if (!missing.empty()) {
        Status filled =
            run_with_bar("volumes", missing.size(), !call.quiet, interrupt,
                         [&](const pipeline::FillProgress& progress) {
                             return filling.fill(missing, progress, interrupt.flag(), report);
                         });
        if (!filled) return filled;
        say_left_out(call, missing, grids);
        warn(report.notes, "");
    }
    grids.fill_s = seconds_since(start);
    if (instants.empty()) return {};
    const auto frames_start = steady_now();
    const auto notes = static_cast<std::ptrdiff_t>(report.notes.size());
    Status made =
        run_with_bar("mosaics", instants.size(), !call.quiet, interrupt,
                     [&](const pipeline::FillProgress& progress) {
                         return filling.make_frames(instants, progress, interrupt.flag(), report);
                     });
    if (!made) return made;
    warn({report.notes.begin() + notes, report.notes.end()}, "");
    grids.frames_s = seconds_since(frames_start);
    return {};
}

// Adds to the report the volumes that the plan left out, and files without a volume.
Status add_left_out(const ArchiveCall& call, const catalog::CatalogReader& catalog,
                    const std::vector<pipeline::LeftOut>& by_plan, pipeline::FillReport& report) {
    report.left_out.insert(report.left_out.begin(), by_plan.begin(), by_plan.end());
    if (call.files.empty()) return {};
    auto rejected = rejected_among(call.files, catalog);
    if (!rejected) return pass_on(rejected);
    std::ranges::move(*rejected, std::back_inserter(report.left_out));
    return {};
}

// Opens the cache. Tries several times, because a process that was just killed may hold the lock a
// moment longer.
Result<cache::RollingStore> open_cache(const fs::path& directory) {
    auto store = cache::RollingStore::open(real_file_system(), directory, {});
    for (int tries = 1; tries < 20 && !store; ++tries) {
        if (store.error().code != ErrorCode::busy) break;
        std::this_thread::sleep_for(glance);
        store = cache::RollingStore::open(real_file_system(), directory, {});
    }
    if (!store && store.error().code == ErrorCode::busy) {
        return fail(ErrorCode::busy, "{} (another loop of the same grids, or a daemon)",
                    store.error().message);
    }
    return store;
}

}  // namespace

Result<std::optional<ArchiveGrids>> fill_from_archive(const ArchiveCall& call, Interrupt& interrupt,
                                                      std::string& nothing) {
    auto catalog = catalog::CatalogReader::open(call.catalog);
    if (!catalog) return pass_on(catalog);
    if (auto known = check_stations(call, *catalog, nothing); !known) return pass_on(known);
    if (!nothing.empty()) return std::optional<ArchiveGrids>{};
    const auto plan = plan_of(call, *catalog);
    if (!plan) return pass_on(plan);
    nothing = plan->stations.empty() ? "no station in the catalog reaches these bounds"
                                     : "no volume of these stations";
    const bool between = plan->mosaic || call.interval;
    const auto volumes = pipeline::archive_volumes(
        *catalog, plan->stations, {*call.range.from, *call.range.to, between, call.files});
    if (!volumes) return pass_on(volumes);
    for (const catalog::Trouble& trouble : catalog->troubles())
        fmt::print(stderr, "stormcellar: warning: {}\n", printable(trouble.error.message));
    if (volumes->empty()) return std::optional<ArchiveGrids>{};
    note_without_volumes(call, *volumes);
    if (auto fit = pipeline::check_cache_directory(plan->cache); !fit) return pass_on(fit);

    ArchiveGrids grids;
    auto store = open_cache(plan->cache);
    if (!store) return pass_on(store);
    grids.store = std::move(*store);
    grids.directory = plan->cache;
    grids.mosaic = plan->mosaic;
    grids.domain = plan->mosaic ? plan->mosaic->name : plan->stations.front();
    pipeline::ArchiveFill filling(*catalog, *grids.store, plan->cache / ".catalog", plan->fill);
    const auto missing = filling.missing(*volumes);
    if (!missing) return pass_on(missing);
    pipeline::ArchiveFill::DueFrames frames;
    if (plan->mosaic) {
        const auto all =
            pipeline::instants_between(*call.range.from, *call.range.to, plan->mosaic->interval);
        auto due = filling.due(all, *volumes);
        if (!due) return pass_on(due);
        frames = std::move(*due);
    }
    if (auto said = announce(call, *plan, filling, *volumes, *missing, frames.missing); !said) {
        return pass_on(said);
    }
    warn(plan->left_out, "left out: ");
    grids.report.volumes = volumes->size();
    grids.report.grids_found = volumes->size() - missing->size();
    if (auto filled = fill(call, filling, *missing, frames.instants, interrupt, grids); !filled) {
        return pass_on(filled);
    }
    if (auto all = add_left_out(call, *catalog, plan->left_out, grids.report); !all) {
        return pass_on(all);
    }
    std::set<UtcTime> times(grids.report.frames.begin(), grids.report.frames.end());
    if (!plan->mosaic) {
        for (const ArchiveVolume& volume : *volumes)
            times.insert(volume.start);
    }
    auto entries = pipeline::entries_at(*grids.store, grids.domain, call.moment, times);
    if (!entries) return pass_on(entries);
    grids.entries = std::move(*entries);
    return std::optional{std::move(grids)};
}

Status leave_cache(const ArchiveCall& call, ArchiveGrids& grids) {
    const cache::StoreUsage usage = grids.store->usage();
    grids.bytes = usage.bytes;
    if (call.keep) {
        if (!call.quiet) {
            fmt::print(stderr, "the grids stay in {} ({} in {} {})\n",
                       printable(grids.directory.native()), format_byte_size(usage.bytes),
                       usage.grids, plural(usage.grids, "file"));
        }
        return {};
    }
    // Remove the cache while its lock is held, so that no other loop can open it before it is gone.
    std::error_code error;
    fs::remove_all(grids.directory, error);
    grids.store.reset();
    if (error) return fail(ErrorCode::io, "{}: {}", grids.directory.native(), error.message());
    return {};
}

}  // namespace stormcellar::cli
