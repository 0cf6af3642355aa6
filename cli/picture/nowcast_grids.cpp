#include "cli/picture/nowcast_grids.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "cli/shared/cache_domain.h"
#include "cli/shared/input_files.h"
#include "retrieve/nowcast/nowcast_note.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {
namespace {

// Longer sequences would only add hindcasts.
constexpr std::chrono::hours longest_past{2};

// Counts the volumes of each file.
Result<std::vector<int>> count_volumes(const std::vector<std::string>& names,
                                       std::vector<std::string>& labels) {
    auto inputs = InputFiles::find(names, InputFiles::all);
    if (!inputs) return pass_on(inputs);
    note_left_out(*inputs);
    std::vector<int> counts;
    for (const InputFile& file : inputs->files()) {
        auto decoded = inputs->decode(file, {});
        if (!decoded && file.was_found && is_no_volume(decoded.error())) {
            print_note("left out: " + decoded.error().message);
            continue;
        }
        if (!decoded) return pass_on(decoded);
        const auto volumes = level2::split_volumes(std::move(*decoded));
        labels.push_back(file.label);
        counts.push_back(static_cast<int>(volumes.size()));
    }
    return counts;
}

Status check_one_radar(const std::vector<PictureGrid>& grids) {
    for (const PictureGrid& grid : grids) {
        if (grid.name() == grids.front().name()) continue;
        return fail(ErrorCode::bad_argument,
                    "a nowcast of files needs volumes of one radar, and these are of {} and {}; "
                    "for a mosaic, name a domain of the cache",
                    grids.front().name(), grid.name());
    }
    return {};
}

Result<std::vector<PictureGrid>> grids_of_files(const GridOptions& options,
                                                const std::vector<std::string>& names) {
    std::vector<std::string> labels;
    const auto counts = count_volumes(names, labels);
    if (!counts) return pass_on(counts);
    std::vector<PictureGrid> grids;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        for (int volume = 1; volume <= (*counts)[i]; ++volume) {
            GridOptions one = options;
            one.files = {labels[i]};
            one.volume = (*counts)[i] > 1 ? volume : 0;
            auto made = PictureGrid::make(std::move(one));
            if (!made) return pass_on(made);
            grids.push_back(std::move(*made));
        }
    }
    if (Status one = check_one_radar(grids); !one) return pass_on(one);
    return grids;
}

// Returns the latest time at which a volume may begin; none: now.
Result<std::optional<UtcTime>> latest_start(const NowcastSource& source) {
    if (source.time.empty()) return std::optional<UtcTime>{};
    const auto time = parse_utc(source.time, now_utc());
    if (!time) return fail(time.error().code, "--time: {}", time.error().message);
    return std::optional{*time};
}

Result<std::vector<PictureGrid>> grids_of_domain(NowcastSource& source,
                                                 std::optional<UtcTime> until) {
    if (has_picture_grid_options(source.grid)) {
        return fail(ErrorCode::bad_argument,
                    "options of the grid, such as --center, are for files; the grids of the cache "
                    "are made already");
    }
    if (Status found = source.cache.find(); !found) return pass_on(found);
    const auto store = cache::StoreReader::open(source.cache.directory);
    if (!store) return pass_on(store);
    if (source.domain.empty()) {
        if (Status taken = take_only_domain(*store, source.domain); !taken) return pass_on(taken);
    }
    auto entries = store->list(source.domain, level2::Moment::ref, std::nullopt, until);
    if (!entries) return pass_on(entries);
    if (!until) cache::leave_out_future(*entries, now_utc());
    if (entries->empty()) {
        return fail(ErrorCode::not_found, "{}: there is no grid of reflectivity of domain '{}'",
                    source.cache.directory, source.domain);
    }
    const UtcTime first = entries->back().time - longest_past;
    std::vector<PictureGrid> grids;
    for (const cache::StoreEntry& entry : *entries) {
        if (entry.time < first) continue;
        auto grid = PictureGrid::open(entry.path);
        if (!grid) return pass_on(grid);
        grids.push_back(std::move(*grid));
    }
    return grids;
}

}  // namespace

Result<std::vector<PictureGrid>> nowcast_grids(NowcastSource& source) {
    auto names = tell_apart_from_cache(source.words, source.domain, source.cache);
    if (!names) return pass_on(names);
    const auto until = latest_start(source);
    if (!until) return pass_on(until);
    source.domain = names->domain;
    auto grids = names->files.empty() ? grids_of_domain(source, *until)
                                      : grids_of_files(source.grid, names->files);
    if (!grids) return grids;
    std::ranges::stable_sort(
        *grids, {}, [](const PictureGrid& grid) { return render::middle_of(grid.description()); });
    std::erase_if(*grids, [&](const PictureGrid& grid) {
        return *until && grid.description().time > **until;
    });
    if (grids->empty()) return fail(ErrorCode::not_found, "no volume begins by {}", source.time);
    if (!names->files.empty()) source.domain = grids->back().name();
    return grids;
}

std::vector<retrieve::TimedGrid> timed_grids(const std::vector<PictureGrid>& grids) {
    std::vector<retrieve::TimedGrid> timed;
    for (const PictureGrid& grid : grids)
        timed.push_back({grid.view(), render::middle_of(grid.description())});
    return timed;
}

cache::GridDescription describe_nowcast(cache::GridDescription latest, double minutes,
                                        const std::string& score) {
    const auto lead = std::chrono::milliseconds(std::llround(minutes * 60'000));
    latest.time += lead;
    latest.start_time += lead;
    latest.end_time += lead;
    for (const std::string& note : retrieve::nowcast_notes(minutes, score))
        latest.provenance.notes.push_back(note);
    // Clear the members that say how the cells of the latest grid were measured.
    latest.provenance.sweeps.clear();
    latest.provenance.audit.clear();
    latest.provenance.predicted_error.clear();
    latest.provenance.parts.clear();
    latest.provenance.recipe = 0;
    latest.provenance.revision = 0;
    latest.provenance.provisional = false;
    return latest;
}

}  // namespace stormcellar::cli
