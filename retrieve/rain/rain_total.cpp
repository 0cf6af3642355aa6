#include "stormcellar/retrieve/rain_total.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "grid/mosaic/motion.h"
#include "grid/mosaic/time_interpolation.h"
#include "stormcellar/retrieve/rain_rate.h"

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr double longest_step_s = 60;
constexpr double z_factor = 300, z_exponent = 1.4;

// Returns the reflectivity of the rates, in which motion is found.
grid::BrickGrid reflectivity_of(const grid::BrickGrid& rates) {
    grid::Grid echo = grid::to_dense(rates.view());
    echo.moment = level2::Moment::ref;
    for (std::size_t cell = 0; cell < echo.values.size(); ++cell) {
        if (echo.status[cell] != CellStatus::value) continue;
        const double rate = static_cast<double>(echo.values[cell]);
        if (rate > 0)
            echo.values[cell] =
                static_cast<float>(10 * std::log10(z_factor * std::pow(rate, z_exponent)));
        else
            echo.status[cell] = CellStatus::no_echo;
    }
    return grid::BrickGrid::from(echo, grid::default_quantization(level2::Moment::ref));
}

double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

grid::BrickGrid lowest_rates(const grid::BrickView& view, level2::Moment moment, int threads) {
    const grid::Grid whole = grid::to_dense(view);
    const bool is_rate = moment == level2::Moment::rate;
    grid::Grid lowest;
    lowest.spec = whole.spec;
    lowest.spec.levels_m.resize(1);
    lowest.moment = level2::Moment::rate;
    const std::size_t columns = lowest.spec.cell_count();
    lowest.values.resize(columns);
    lowest.status.resize(columns);
    for (std::size_t cell = 0; cell < whole.status.size(); ++cell) {
        const std::size_t column = cell / whole.spec.levels_m.size();
        const bool is_known = lowest.status[column] != CellStatus::not_seen;
        const bool is_echo = whole.status[cell] == CellStatus::value;
        if (is_known || (!is_echo && whole.status[cell] != CellStatus::no_echo)) continue;
        lowest.status[column] = whole.status[cell];
        if (!is_echo) continue;
        const float value = whole.values[cell];
        lowest.values[column] =
            is_rate ? value
                    : static_cast<float>(rain_by_reflectivity_mm_per_h(static_cast<double>(value)));
    }
    return grid::BrickGrid::from(
        lowest, is_rate ? view.quantization : grid::default_quantization(level2::Moment::rate),
        threads);
}

RainTotal::RainTotal(grid::SitePosition site, RainSteps steps, int threads,
                     std::optional<RainSpan> span)
    : site_(std::move(site)), steps_(steps), threads_(threads), span_(span) {}

Status RainTotal::add(const grid::BrickView& rate, UtcTime middle) {
    if (whole_spec_ && !(*whole_spec_ == *rate.spec))
        return fail(ErrorCode::bad_argument,
                    "the grids of a rain total must have the same place and size");
    if (lowest_ && middle <= middle_)
        return fail(ErrorCode::bad_argument, "the volumes of a rain total must follow each other");
    grid::BrickGrid next = lowest_rates(rate, level2::Moment::rate, threads_);
    if (!lowest_) {
        auto columns = grid::make_column_geometry(site_, next.spec());
        if (!columns) return pass_on(columns);
        columns_ = std::move(*columns);
        whole_spec_ = *rate.spec;
        mm_.assign(next.spec().cell_count(), 0);
        unseen_minutes_.assign(next.spec().cell_count(), 0);
        if (span_) count_gap(seconds_between(span_->from, std::min(middle, span_->to)));
    } else if (Status done = bridge(next, middle); !done) {
        return done;
    }
    lowest_.emplace(std::move(next));
    middle_ = middle;
    return {};
}

void RainTotal::close() {
    if (span_ && lowest_) count_gap(seconds_between(std::max(middle_, span_->from), span_->to));
}

// Counts the part of the time between two volumes that is within the span.
Status RainTotal::bridge(const grid::BrickGrid& next, UtcTime middle) {
    const double seconds = seconds_between(middle_, middle);
    const double begin_s = span_ ? std::max(0.0, seconds_between(middle_, span_->from)) : 0;
    const double end_s = span_ ? std::min(seconds, seconds_between(middle_, span_->to)) : seconds;
    if (!(end_s > begin_s)) return {};
    if (middle - middle_ > longest_bridge) {
        count_gap(end_s - begin_s);
        return {};
    }
    minutes_ += (end_s - begin_s) / 60;
    if (steps_ == RainSteps::advected) return advect(next, middle, begin_s, end_s);
    const double half_s = std::clamp(seconds / 2, begin_s, end_s);
    count(grid::to_dense(lowest_->view()), half_s - begin_s);
    count(grid::to_dense(next.view()), end_s - half_s);
    return {};
}

Status RainTotal::advect(const grid::BrickGrid& next, UtcTime middle, double begin_s,
                         double end_s) {
    const grid::BrickGrid before = reflectivity_of(*lowest_), after = reflectivity_of(next);
    const auto motion = grid::estimate_motion(
        before.view(), after.view(), seconds_between(middle_, middle), {.threads = threads_});
    if (!motion) return pass_on(motion);
    const double seconds = end_s - begin_s;
    const int steps = static_cast<int>(std::ceil(seconds / longest_step_s));
    for (int step = 0; step < steps; ++step) {
        const auto into = std::chrono::duration<double>(begin_s + seconds * (step + 0.5) / steps);
        const grid::InstantOptions options{
            .instant = middle_ + std::chrono::duration_cast<UtcTime::duration>(into),
            .moment = level2::Moment::rate,
            .motion = *motion ? &**motion : nullptr,
            .threads = threads_};
        const auto rates = grid::grid_at({lowest_->view(), middle_},
                                         grid::TimedView{next.view(), middle}, *columns_, options);
        if (!rates) return pass_on(rates);
        count(grid::to_dense(rates->view()), seconds / steps);
    }
    return {};
}

void RainTotal::count_gap(double seconds) {
    if (!(seconds > 0)) return;
    minutes_ += seconds / 60;
    gap_minutes_ += seconds / 60;
    for (float& unseen : unseen_minutes_)
        unseen += static_cast<float>(seconds / 60);
}

void RainTotal::count(const grid::Grid& rates, double seconds) {
    for (std::size_t column = 0; column < mm_.size(); ++column) {
        if (rates.status[column] == CellStatus::value)
            mm_[column] += rates.values[column] * static_cast<float>(seconds / 3600);
        else if (rates.status[column] != CellStatus::no_echo)
            unseen_minutes_[column] += static_cast<float>(seconds / 60);
    }
}

}  // namespace stormcellar::retrieve
