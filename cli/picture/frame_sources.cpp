#include "cli/picture/frame_sources.h"

#include <fmt/format.h>

#include "cli/picture/picture.h"
#include "cli/shared/cache_domain.h"
#include "cli/shared/query_options.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/product.h"

namespace stormcellar::cli {
namespace {

// Returns the time at or before which a grid is looked for; none: now.
Result<std::optional<UtcTime>> until_of(const FrameOptions& options) {
    if (options.time.empty()) return std::optional<UtcTime>{};
    const auto time = parse_utc(options.time, now_utc());
    if (!time) return fail(time.error().code, "--time: {}", time.error().message);
    return std::optional{*time};
}

// Returns the newest grid of the domain at or before the time; none if there is none.
Result<std::optional<cache::StoreEntry>> find_grid(const cache::StoreReader& store,
                                                   const FrameOptions& options,
                                                   level2::Moment moment) {
    const auto until = until_of(options);
    if (!until) return pass_on(until);
    auto entries = store.list(options.domain, moment, std::nullopt, *until);
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

// Opens the cache and says which domain is meant.
Result<cache::StoreReader> open_store(FrameOptions& options) {
    if (has_picture_grid_options(options.grid)) {
        return fail(ErrorCode::bad_argument,
                    "options of the grid, such as --center, are for files; the grids of the cache "
                    "are made already");
    }
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
Result<std::optional<PictureGrid>> stored_grid(FrameOptions& options, const render::Scene& scene) {
    const level2::Moment moment = scene.moment;
    if (render::facts_of(scene.product).is_of_sweep) {
        return fail(ErrorCode::bad_argument,
                    "{} shows a sweep, and the cache holds grids; name the Level II file to draw",
                    render::product_name(scene.product));
    }
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

Result<std::optional<PictureGrid>> grid_of_files(FrameOptions& options,
                                                 const render::Scene& scene) {
    options.grid.moment = options.scene.moment;
    options.grid.threads = thread_count(options.scene);
    options.grid.time = options.time;
    auto grid = render::facts_of(scene.product).is_of_sweep
                    ? PictureGrid::make_sweep(options.grid, scene)
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

}  // namespace

Result<std::optional<PictureGrid>> grid_of_frame(FrameOptions& options,
                                                 const render::Scene& scene) {
    if (Status taken = take_sources(options); !taken) return pass_on(taken);
    return options.grid.files.empty() ? stored_grid(options, scene) : grid_of_files(options, scene);
}

Result<std::vector<PictureGrid>> grids_of_panels(FrameOptions& options,
                                                 const std::vector<PanelScene>& panels) {
    if (Status taken = take_sources(options); !taken) return pass_on(taken);
    if (options.grid.files.empty()) {
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

}  // namespace stormcellar::cli
