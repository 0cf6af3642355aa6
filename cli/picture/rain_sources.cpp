#include "cli/picture/rain_sources.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/shared/commands.h"
#include "cli/shared/input_files.h"
#include "render/products/rain_of_domain.h"
#include "render/products/rain_total_grid.h"
#include "stormcellar/retrieve/rain_total.h"

namespace stormcellar::cli {
namespace {

// The lowest rates of a volume. Cells take less memory than bricks.
struct LowestRates {
    std::string name;
    grid::Grid rates;
    cache::GridDescription description;
};

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
    std::ranges::stable_sort(
        all, {}, [](const LowestRates& one) { return render::middle_of(one.description); });
    return all;
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
    return render::middle_of(newest->description());
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
    std::optional<retrieve::RainSpan> span;
    if (choice.hours) {
        const UtcTime newest = render::middle_of(all->back().description);
        span = render::span_ending(choice.until.value_or(newest), *choice.hours);
    }
    std::erase_if(*all, [&](const LowestRates& one) {
        const UtcTime middle = render::middle_of(one.description);
        return span ? !render::tells_about(*span, middle) : choice.until && middle > *choice.until;
    });
    render::RainTotalGrid total(span);
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
    std::vector<std::string> left_out;
    const auto total = render::rain_total_of_domain(
        store, {domain, render::span_ending(*end, *choice.hours), {}, choice.threads, {}},
        &left_out);
    for (const std::string& text : left_out)
        print_note("left out: " + text);
    if (!total) return pass_on(total);
    return PictureGrid::of_rain(domain, *total);
}

}  // namespace stormcellar::cli
