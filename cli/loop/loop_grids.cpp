#include "cli/loop/loop_grids.h"

#include <utility>

#include <fmt/format.h>

#include "cli/loop/loop_report.h"
#include "cli/picture/picture.h"
#include "cli/shared/commands.h"

namespace stormcellar::cli {
namespace {

std::string range_text(const LoopOptions& options) {
    std::string text;
    if (!options.range.from.empty()) text += fmt::format(" from {}", options.range.from);
    if (!options.range.to.empty()) text += fmt::format(" to {}", options.range.to);
    return text;
}

void set_frames(const std::vector<cache::StoreEntry>& entries, LoopGrids& grids) {
    for (const cache::StoreEntry& entry : entries)
        grids.frames.push_back({entry.time, entry});
    if (!entries.empty()) grids.sample = entries.front().path;
}

// Replaces the frames, which are at the times of grids, by frames at regular times. Uses existing
// grids of a mosaic if they were made by the same rules.
Status set_rhythm(const LoopOptions& options, level2::Moment moment, const Rhythm& rhythm,
                  LoopGrids& grids) {
    std::vector<std::string> problems;
    auto between = pipeline::BetweenGrids::open(
        *grids.store, grids.domain, moment,
        {rhythm.method, grids.range.from, grids.range.to, render::thread_count(options.scene)},
        problems);
    for (const std::string& problem : problems)
        warn_skipped({{}, problem});
    if (!between) return pass_on(between);
    std::vector<LoopFrame> frames;
    for (const UtcTime instant : between->instants(*rhythm.interval)) {
        LoopFrame frame{instant, std::nullopt};
        const auto path = grids.store->path_of(grids.domain, moment, instant);
        if (path && between->stands(*path)) {
            frame.stored = cache::StoreEntry{grids.domain, moment, instant, *path};
        }
        frames.push_back(std::move(frame));
    }
    if (frames.empty()) {
        fmt::print(
            stderr, "stormcellar: cannot make a frame every {} s: {}\n", rhythm.interval->count(),
            grids.frames.size() == 1
                ? std::string{"there is only one grid"}
                : fmt::format("the {} grids are too few, or more than {} minutes apart",
                              grids.frames.size(), pipeline::BetweenGrids::longest_bridge.count()));
    } else if (!options.quiet && !options.json) {
        fmt::print(stderr, "frames between the grids: {}\n", between->method_text());
    }
    grids.frames = std::move(frames);
    grids.between.emplace(std::move(*between));
    return {};
}

Result<ArchiveCall> call_of(const LoopOptions& options, const render::Scene& scene,
                            const TimeRange& range) {
    auto request = parse_archive(options.archive);
    if (!request) return pass_on(request);
    if (!range.from || !range.to) {
        return fail(ErrorCode::bad_argument, "--catalog needs --from and --to");
    }
    if (!options.archive.keep_cache && !options.cache.empty()) {
        return fail(ErrorCode::bad_argument, "--no-keep-cache cannot be used with --cache");
    }
    ArchiveCall call;
    call.request = std::move(*request);
    call.catalog = options.archive.catalog;
    call.files = options.archive_files;
    call.cache = options.cache;
    call.domain = options.domain;
    call.range = range;
    call.moment = scene.moment;
    call.derived = render::derived_options_of(options.scene);
    const auto rhythm = rhythm_of(options);
    if (!rhythm) return pass_on(rhythm);
    call.interval = rhythm->interval;
    call.time = rhythm->method;
    call.threads = render::thread_count(options.scene);
    call.keep = options.archive.keep_cache;
    call.quiet = options.quiet;
    return call;
}

Status take_from_archive(const LoopOptions& options, const render::Scene& scene,
                         Interrupt& interrupt, LoopGrids& grids) {
    auto call = call_of(options, scene, grids.range);
    if (!call) return pass_on(call);
    std::string nothing;
    auto archive = fill_from_archive(*call, interrupt, nothing);
    if (!archive) return pass_on(archive);
    if (!*archive) {
        fmt::print(stderr, "stormcellar: {}: {}{}\n", printable(options.archive.catalog), nothing,
                   printable(range_text(options)));
        return {};
    }
    grids.archive = std::move(**archive);
    grids.call = std::move(*call);
    grids.store = grids.archive->store;
    grids.domain = grids.archive->domain;
    set_frames(grids.archive->entries, grids);
    if (grids.frames.empty()) {
        fmt::print(stderr, "stormcellar: none of the {} {}{} gives a frame\n",
                   grids.archive->report.volumes,
                   plural(static_cast<std::uint64_t>(grids.archive->report.volumes), "volume"),
                   printable(range_text(options)));
    }
    return {};
}

Status take_from_cache(const LoopOptions& options, const render::Scene& scene, LoopGrids& grids) {
    if (auto fine = parse_archive(options.archive); !fine) return pass_on(fine);
    auto store = cache::StoreReader::open(options.cache);
    if (!store) return pass_on(store);
    auto entries = store->list(options.domain, scene.moment, grids.range.from, grids.range.to);
    if (!entries) return pass_on(entries);
    if (!grids.range.to && !entries->empty()) {
        const UtcTime now = now_utc();
        cache::leave_out_future(*entries, now);
        warn_of_future(entries->back().time);
        if (is_believed(entries->back().time, now)) grids.range.to = now + tolerated_future;
    }
    grids.domain = options.domain;
    set_frames(*entries, grids);
    if (grids.frames.empty()) {
        report_no_grid(*store, options.domain, scene.moment, range_text(options));
    }
    grids.store = std::move(*store);
    return {};
}

}  // namespace

LoopGrids grids_of(const cache::StoreReader& store, const std::string& domain,
                   const std::vector<cache::StoreEntry>& entries) {
    LoopGrids grids;
    grids.store = store;
    grids.domain = domain;
    set_frames(entries, grids);
    return grids;
}

Result<std::vector<cache::StoreEntry>> entries_now(const cache::StoreReader& store,
                                                   const LoopOptions& options,
                                                   level2::Moment moment) {
    const auto range = parse_time_range(options.range);
    if (!range) return pass_on(range);
    auto entries = store.list(options.domain, moment, range->from, range->to);
    if (entries && !range->to) cache::leave_out_future(*entries, now_utc());
    if (entries && options.last > 0 && std::cmp_greater(entries->size(), options.last)) {
        entries->erase(entries->begin(), entries->end() - options.last);
    }
    return entries;
}

Result<LoopGrids> find_grids(const LoopOptions& options, const render::Scene& scene,
                             Interrupt& interrupt) {
    LoopGrids grids;
    const auto range = parse_time_range(options.range);
    if (!range) return pass_on(range);
    grids.range = *range;
    const Status taken = options.archive.asked()
                             ? take_from_archive(options, scene, interrupt, grids)
                             : take_from_cache(options, scene, grids);
    if (!taken) return pass_on(taken);
    const auto rhythm = rhythm_of(options);
    if (!rhythm) return pass_on(rhythm);
    const bool every_so_often = rhythm->interval && !(grids.archive && grids.archive->mosaic);
    if (every_so_often && !grids.frames.empty()) {
        if (auto set = set_rhythm(options, scene.moment, *rhythm, grids); !set) return pass_on(set);
    }
    return grids;
}

}  // namespace stormcellar::cli
