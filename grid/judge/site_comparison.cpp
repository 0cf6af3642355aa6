#include "grid/judge/site_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "grid/judge/robust_fit.h"
#include "grid/judge/site_pairs.h"
#include "stormcellar/grid/grid_sampler.h"

namespace stormcellar::grid {
namespace {

enum Fault : std::size_t { bias, azimuth, elevation, time };
constexpr std::array<const char*, fit_size> fault_names = {"bias", "azimuth", "elevation", "time"};

constexpr std::size_t fewest_blocks = 8;
constexpr std::size_t fewest_cells = 400;
constexpr double slowest_mps = 2;
// If the motion is unknown, the times at which the two sites looked may be at most this far apart.
// In a longer time, echo would move as far as a fault moves it.
constexpr double longest_apart_s = 90;
constexpr int most_rounds = 12;
// No step is longer than this (dB, degrees, degrees, seconds).
constexpr std::array<double, fit_size> longest_step = {10, 0.5, 0.5, 60};
// A step counts as no change if it is below this share of the standard error, or of the longest
// step if that is less.
constexpr double settled = 0.02;

using Numbers = std::array<double, fit_size>;

// The value of B at a place, and its derivatives there.
struct Local {
    double value = 0;
    double by_x = 0, by_y = 0, by_up_m = 0;
};

std::optional<Local> local_at(const GridSampler& b, ColumnPoint column, double height_m) {
    const double level = b.level_at(height_m);
    const auto here = b.value(column, level);
    if (!here) return std::nullopt;
    const std::vector<double>& levels_m = b.view().spec->levels_m;
    const auto below = std::min(static_cast<std::size_t>(level), levels_m.size() - 1);
    const std::size_t next = std::min(below + 1, levels_m.size() - 1);
    const double step_m = next > below ? levels_m[next] - levels_m[below] : 0;
    const auto east = b.value({column.x + 1, column.y}, level);
    const auto west = b.value({column.x - 1, column.y}, level);
    const auto north = b.value({column.x, column.y + 1}, level);
    const auto south = b.value({column.x, column.y - 1}, level);
    const auto above = b.value(column, b.level_at(height_m + step_m));
    const auto under = b.value(column, b.level_at(height_m - step_m));
    if (!east || !west || !north || !south || !above || !under || step_m <= 0) return std::nullopt;
    const auto slope = [](float more, float less, double way) {
        return static_cast<double>(more - less) / way;
    };
    return Local{static_cast<double>(*here), slope(*east, *west, 2), slope(*north, *south, 2),
                 slope(*above, *under, 2 * step_m)};
}

double along(const Local& local, const SiteShift& shift) {
    return local.by_x * shift.x + local.by_y * shift.y + local.by_up_m * shift.up_m;
}

double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
    const auto count = static_cast<double>(a.size());
    const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / count;
    const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / count;
    double aa = 0, ab = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// Returns a row for each cell, with A minus B after the removal of B's faults. Also computes the
// correlation of A and B.
std::vector<FitRow> rows_of(const std::vector<SitePair>& pairs, const GridSampler& b,
                            const Numbers& numbers, double least_dbz, double& correlation) {
    std::vector<FitRow> rows;
    std::vector<double> seen_dbz, expected;
    for (const SitePair& pair : pairs) {
        ColumnPoint column = moved(pair.column, pair.by_azimuth, numbers[azimuth]);
        column = moved(column, pair.by_elevation, numbers[elevation]);
        column = moved(column, pair.by_time, numbers[time]);
        const auto local =
            local_at(b, column, pair.height_m + pair.by_elevation.up_m * numbers[elevation]);
        if (!local) continue;
        const double expected_dbz = local->value - numbers[bias];
        if ((pair.a_dbz + expected_dbz) / 2 < least_dbz) continue;
        FitRow row;
        row.residual = pair.a_dbz - expected_dbz;
        row.gradient = {-1, along(*local, pair.by_azimuth), along(*local, pair.by_elevation),
                        along(*local, pair.by_time)};
        row.block = pair.block;
        rows.push_back(row);
        seen_dbz.push_back(pair.a_dbz);
        expected.push_back(expected_dbz);
    }
    correlation = rows.empty() ? 0 : correlation_of(seen_dbz, expected);
    return rows;
}

std::array<Estimate*, fit_size> estimates_of(SiteComparison& comparison) {
    return {&comparison.bias_db, &comparison.azimuth_deg, &comparison.elevation_deg,
            &comparison.time_s};
}

// Returns the reason why there are too few cells, or an empty text if there are enough.
std::string too_little(std::size_t pairs, std::size_t rows, std::size_t blocks) {
    if (pairs == 0) return "there is no echo where both sites look";
    if (rows >= fewest_cells && blocks >= fewest_blocks) return "";
    return fmt::format("the sites have too little echo in common: {} cells in {} blocks", rows,
                       blocks);
}

void tell_nothing(const std::string& why, SiteComparison& comparison) {
    for (Estimate* estimate : estimates_of(comparison)) {
        *estimate = {};
        estimate->untold = why;
    }
}

std::size_t blocks_of(const std::vector<FitRow>& rows) {
    std::vector<std::uint32_t> blocks;
    blocks.reserve(rows.size());
    for (const FitRow& row : rows)
        blocks.push_back(row.block);
    std::sort(blocks.begin(), blocks.end());
    return static_cast<std::size_t>(std::unique(blocks.begin(), blocks.end()) - blocks.begin());
}

// Adds a step, limited to the longest step. Returns false if the step is too small to count.
bool take_step(const Fit& found, Numbers& numbers) {
    bool changes = false;
    for (std::size_t i = 0; i < fit_size; ++i) {
        const double step = std::clamp(found.step[i], -longest_step[i], longest_step[i]);
        numbers[i] += step;
        changes = changes ||
                  std::abs(step) > settled * std::min(found.standard_error[i], longest_step[i]);
    }
    return changes;
}

double median_apart_s(const std::vector<SitePair>& pairs) {
    std::vector<double> apart_s;
    apart_s.reserve(pairs.size());
    for (const SitePair& pair : pairs)
        apart_s.push_back(std::abs(pair.apart_s));
    if (apart_s.empty()) return 0;
    const auto middle = apart_s.begin() + static_cast<std::ptrdiff_t>(apart_s.size() / 2);
    std::nth_element(apart_s.begin(), middle, apart_s.end());
    return *middle;
}

// Returns the faults to estimate. For all other faults, sets `untold` in the estimate to the
// reason.
FitChoice choose_faults(const ComparisonOptions& options, SiteComparison& comparison) {
    FitChoice sought{true, true, true, true};
    const auto give_up = [&](Fault fault, std::string why) {
        sought[fault] = false;
        estimates_of(comparison)[fault]->untold = std::move(why);
    };
    if (!options.motion) {
        give_up(time, "the motion is not known");
    } else if (std::hypot(options.motion->east_mps, options.motion->north_mps) < slowest_mps) {
        give_up(time, "the weather stands still");
    }
    if (!options.motion && comparison.apart_s > longest_apart_s) {
        for (const Fault fault : {azimuth, elevation}) {
            give_up(fault,
                    fmt::format("the sites looked {:.0f} s apart and the motion is not known",
                                comparison.apart_s));
        }
    }
    return sought;
}

void estimate(const std::vector<SitePair>& pairs, const GridSampler& b,
              const ComparisonOptions& options, SiteComparison& comparison) {
    FitChoice sought = choose_faults(options, comparison);
    Numbers numbers{};
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<FitRow> rows =
            rows_of(pairs, b, numbers, options.least_dbz, comparison.correlation);
        comparison.cells = rows.size();
        comparison.blocks = blocks_of(rows);
        const std::string why = too_little(pairs.size(), rows.size(), comparison.blocks);
        if (!why.empty()) return tell_nothing(why, comparison);
        std::size_t unclear = 0;
        const auto found = fit(rows, sought, &unclear);
        if (!found) {
            sought[unclear] = false;
            *estimates_of(comparison)[unclear] = {
                0, 0, "the echo in common does not separate it from the others"};
            numbers[unclear] = 0;
            continue;
        }
        comparison.deviation_db = found->deviation;
        const bool changes = take_step(*found, numbers);
        for (std::size_t i = 0; i < fit_size; ++i) {
            if (!sought[i]) continue;
            estimates_of(comparison)[i]->value = numbers[i];
            estimates_of(comparison)[i]->standard_error = found->standard_error[i];
        }
        if (!changes) break;
    }
    if (comparison.correlation < options.least_correlation) {
        tell_nothing(fmt::format("the sites see different echo: the correlation is {:.2f}",
                                 comparison.correlation),
                     comparison);
    }
}

struct FaultText {
    const char* more;  // the words that describe a positive value
    const char* less;
    const char* unit;
    double limit = 0;
};

std::array<FaultText, fit_size> texts(const FaultLimits& limits) {
    return {FaultText{"too strong by", "too weak by", "dB", limits.bias_db},
            FaultText{"turned clockwise by", "turned counter-clockwise by", "degrees",
                      limits.azimuth_deg},
            FaultText{"raised by", "lowered by", "degrees", limits.elevation_deg},
            FaultText{"clock late by", "clock early by", "s", limits.time_s}};
}

// Returns a sentence for each of the four estimates, unless `words_for` returns no words for it.
template <class WordsFor>
std::vector<std::string> sentences(const SiteComparison& comparison, WordsFor words_for) {
    const std::array estimates = {&comparison.bias_db, &comparison.azimuth_deg,
                                  &comparison.elevation_deg, &comparison.time_s};
    std::vector<std::string> listed;
    for (std::size_t i = 0; i < fit_size; ++i) {
        const std::string words = words_for(i, *estimates[i]);
        if (words.empty()) continue;
        listed.push_back(fmt::format("{} against {}: {}", comparison.b, comparison.a, words));
    }
    return listed;
}

}  // namespace

Result<SiteComparison> compare_sites(const SiteGrid& a, const SiteGrid& b,
                                     const ComparisonOptions& options) {
    const bool good_motion = !options.motion || (std::isfinite(options.motion->east_mps) &&
                                                 std::isfinite(options.motion->north_mps));
    if (!good_motion || !std::isfinite(options.least_dbz) ||
        !std::isgreaterequal(options.least_range_m, 0.0) ||
        !std::isgreater(options.greatest_range_m, 0.0) || std::isnan(options.least_correlation) ||
        options.most_columns < 1) {
        return fail(ErrorCode::bad_argument, "sites cannot be compared with these options");
    }
    for (const SiteGrid* one : {&a, &b}) {
        const bool fits =
            one->details == nullptr || one->details->size() == one->view.spec->cell_count();
        if (!fits) {
            return fail(ErrorCode::bad_argument, "{}: details of {} cells for {} cells",
                        one->site.icao, one->details->size(), one->view.spec->cell_count());
        }
    }
    SiteComparison made;
    made.a = a.site.icao;
    made.b = b.site.icao;
    const std::vector<SitePair> pairs = pairs_of(a, b, options);
    made.apart_s = median_apart_s(pairs);
    estimate(pairs, GridSampler(b.view), options, made);
    return made;
}

std::vector<std::string> faults(const SiteComparison& comparison, const FaultLimits& limits) {
    return sentences(comparison, [&](std::size_t i, const Estimate& estimate) -> std::string {
        const FaultText text = texts(limits)[i];
        const double size = std::abs(estimate.value);
        const bool is_fault = estimate.untold.empty() && size > text.limit &&
                              size > limits.standard_errors * estimate.standard_error;
        if (!is_fault) return {};
        return fmt::format("{} {:.2f} +- {:.2f} {}", estimate.value > 0 ? text.more : text.less,
                           size, estimate.standard_error, text.unit);
    });
}

std::vector<std::string> untold(const SiteComparison& comparison, const FaultLimits& limits) {
    return sentences(comparison, [&](std::size_t i, const Estimate& estimate) -> std::string {
        const FaultText text = texts(limits)[i];
        std::string why = estimate.untold;
        if (why.empty() && limits.standard_errors * estimate.standard_error > 2 * text.limit) {
            why =
                fmt::format("it is known only to +- {:.2f} {}", estimate.standard_error, text.unit);
        }
        return why.empty() ? why : fmt::format("{} cannot be determined: {}", fault_names[i], why);
    });
}

}  // namespace stormcellar::grid
