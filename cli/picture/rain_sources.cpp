#include "cli/picture/rain_sources.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/picture/rain_total_grid.h"
#include "cli/shared/commands.h"
#include "cli/shared/input_files.h"
#include "stormcellar/retrieve/rain_total.h"

namespace stormcellar::cli {
namespace {

using retrieve::RainSpan;
using retrieve::RainTotal;

// No volume takes longer. The store lists grids by the start of their volumes, so the list begins
// this much earlier.
constexpr std::chrono::minutes longest_volume{30};
constexpr const char* reflectivity_note =
    "rain rates by reflectivity alone, because the cache has no grids of rain rates";

// The lowest rates of a volume. Cells take less memory than bricks.
struct LowestRates {
    std::string name;
    grid::Grid rates;
    cache::GridDescription description;
};

std::optional<RainSpan> span_ending(UtcTime to, const std::optional<double>& hours) {
    if (!hours) return std::nullopt;
    const std::chrono::duration<double, std::ratio<3600>> length(*hours);
    return RainSpan{to - std::chrono::duration_cast<UtcTime::duration>(length), to};
}

bool tells_about(const RainSpan& span, UtcTime middle) {
    return middle >= span.from - RainTotal::longest_bridge &&
           middle <= span.to + RainTotal::longest_bridge;
}

Result<std::vector<LowestRates>> rates_of_files(const GridOptions& options, int threads) {
    auto inputs = InputFiles::find(options.files, InputFiles::all);
    if (!inputs) return pass_on(inputs);
    note_left_out(*inputs);
    std::vector<LowestRates> all;
    for (const InputFile& file : inputs->files()) {
        GridOptions one = options;
        one.files = {file.label};
        one.time.clear();
        const auto made = PictureGrid::make(std::move(one));
        if (!made && file.was_found && is_no_volume(made.error())) {
            print_note("left out: " + made.error().message);
            continue;
        }
        if (!made) return pass_on(made);
        const cache::GridDescription& description = made->description();
        const grid::BrickGrid lowest =
            retrieve::lowest_rates(made->view(), description.moment, threads);
        all.push_back({made->name(), grid::to_dense(lowest.view()), description});
    }
    std::ranges::stable_sort(all, {},
                             [](const LowestRates& one) { return middle_of(one.description); });
    return all;
}

// Returns the grids from which a total takes its rates: those of RATE, or those of REF if these
// reach further into the span.
Result<std::vector<cache::StoreEntry>> entries_of(const cache::StoreReader& store,
                                                  const std::string& domain, const RainSpan& span) {
    const UtcTime from = span.from - RainTotal::longest_bridge - longest_volume;
    const UtcTime to = span.to + RainTotal::longest_bridge;
    auto rates = store.list(domain, level2::Moment::rate, from, to);
    if (!rates) return rates;
    auto reflectivities = store.list(domain, level2::Moment::ref, from, to);
    if (!reflectivities || reflectivities->empty()) return rates;
    const UtcTime begin = std::max(reflectivities->front().time, span.from);
    const UtcTime end = std::min(reflectivities->back().time, span.to);
    const bool is_covered = !rates->empty() &&
                            rates->front().time <= begin + RainTotal::longest_bridge &&
                            rates->back().time >= end - RainTotal::longest_bridge;
    return is_covered ? rates : reflectivities;
}

// Returns the end of the total: the requested time, or the middle of the newest volume.
Result<UtcTime> end_of_total(const cache::StoreReader& store, const std::string& domain,
                             const RainChoice& choice) {
    if (choice.until) return *choice.until;
    std::optional<cache::StoreEntry> last;
    for (const level2::Moment moment : {level2::Moment::rate, level2::Moment::ref}) {
        auto entries = store.list(domain, moment, std::nullopt, std::nullopt);
        if (!entries) return pass_on(entries);
        cache::leave_out_future(*entries, now_utc());
        if (!entries->empty() && (!last || entries->back().time > last->time))
            last = std::move(entries->back());
    }
    if (!last) {
        return fail(ErrorCode::not_found, "domain '{}' has no grids of rain rates or reflectivity",
                    domain);
    }
    const auto newest = cache::GridFile::open(last->path);
    if (!newest) return pass_on(newest);
    return middle_of(newest->description());
}

}  // namespace

Status check_rain_hours(const std::optional<double>& hours) {
    if (!hours || (*hours > 0 && *hours <= most_rain_hours)) return {};
    return fail(ErrorCode::bad_argument, "--hours must be above 0 and at most {:g}, not {:g}",
                most_rain_hours, *hours);
}

Result<PictureGrid> rain_total_of_files(const GridOptions& options, const RainChoice& choice) {
    if (Status fine = check_rain_hours(choice.hours); !fine) return pass_on(fine);
    auto all = rates_of_files(options, choice.threads);
    if (!all) return pass_on(all);
    if (all->empty()) return fail(ErrorCode::not_found, "none of the files is a volume");
    const auto span =
        span_ending(choice.until.value_or(middle_of(all->back().description)), choice.hours);
    std::erase_if(*all, [&](const LowestRates& one) {
        const UtcTime middle = middle_of(one.description);
        return span ? !tells_about(*span, middle) : choice.until && middle > *choice.until;
    });
    RainTotalGrid total(span);
    for (const LowestRates& one : *all) {
        const grid::BrickGrid bricks = grid::BrickGrid::from(
            one.rates, grid::default_quantization(level2::Moment::rate), choice.threads);
        const Status added = total.add(bricks.view(), one.description, choice.threads);
        if (!added) return pass_on(added);
    }
    total.close();
    return PictureGrid::of_rain(all->empty() ? std::string{} : all->back().name, total);
}

Result<PictureGrid> rain_total_of_domain(const cache::StoreReader& store, const std::string& domain,
                                         const RainChoice& choice) {
    if (Status fine = check_rain_hours(choice.hours); !fine) return pass_on(fine);
    const auto end = end_of_total(store, domain, choice);
    if (!end) return pass_on(end);
    const RainSpan span = *span_ending(*end, choice.hours);
    const auto entries = entries_of(store, domain, span);
    if (!entries) return pass_on(entries);
    RainTotalGrid total(span);
    std::optional<grid::GridSpec> cells;
    if (!entries->empty()) {
        const auto newest = cache::GridFile::open(entries->back().path);
        if (!newest) return pass_on(newest);
        cells = newest->description().spec;
    }
    for (const cache::StoreEntry& entry : *entries) {
        const auto file = cache::GridFile::open(entry.path);
        if (!file) {
            // The cache may have evicted the grid meanwhile. Its minutes count as not seen.
            if (file.error().code != ErrorCode::not_found)
                print_note("left out: " + file.error().message);
            continue;
        }
        cache::GridDescription description = file->description();
        if (!(description.spec == *cells) || !tells_about(span, middle_of(description))) continue;
        const grid::BrickGrid lowest =
            retrieve::lowest_rates(file->view(), entry.moment, choice.threads);
        if (Status whole = file->check_whole(); !whole) return pass_on(whole);
        if (entry.moment == level2::Moment::ref)
            description.provenance.notes.emplace_back(reflectivity_note);
        const Status added = total.add(lowest.view(), description, choice.threads);
        if (!added) return pass_on(added);
    }
    total.close();
    return PictureGrid::of_rain(domain, total);
}

}  // namespace stormcellar::cli
