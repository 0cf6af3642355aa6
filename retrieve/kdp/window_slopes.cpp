#include "retrieve/kdp/window_slopes.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "retrieve/kdp/window_slopes.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::retrieve::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Fits each lane's window as line_of() and residual_deg() do.
void fit_windows(const RowSums& sums, const double* HWY_RESTRICT noise, const WindowRule& rule,
                 std::size_t count, WindowSlopes& windows) {
    const hn::CappedTag<double, RowSums::spare> d;
    const hn::Rebind<float, decltype(d)> f;
    const std::ptrdiff_t first = 1 - windows.gates;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0), three = hn::Set(d, 3.0);
    const auto least = hn::Set(d, std::max(rule.least_good, 3.0));
    const auto infinity = hn::Set(f, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto sum = [&](RowSums::Term term) {
            const double* before = sums.before(term, first) + i;
            return hn::Sub(hn::LoadU(d, before + windows.gates), hn::LoadU(d, before));
        };
        const auto own = sum(RowSums::n);
        const auto is_enough = hn::Ge(own, least);
        // Lanes without a slope divide by numbers that raise no floating-point trap.
        const auto n = hn::IfThenElse(is_enough, own, three);
        const auto x = sum(RowSums::x), y = sum(RowSums::y);
        const auto width = hn::Sub(sum(RowSums::xx), hn::Div(hn::Mul(x, x), n));
        const auto has_slope = hn::And(is_enough, hn::Gt(width, zero));
        const auto spread = hn::IfThenElse(has_slope, width, one);
        const auto slope = hn::Div(hn::Sub(sum(RowSums::xy), hn::Div(hn::Mul(x, y), n)), spread);
        const auto squares = hn::Sub(hn::Sub(sum(RowSums::yy), hn::Div(hn::Mul(y, y), n)),
                                     hn::Mul(hn::Mul(slope, slope), spread));
        const auto residual =
            hn::Sqrt(hn::Div(hn::Max(zero, squares), hn::Sub(n, hn::Set(d, 2.0))));
        const auto scale = hn::Div(one, hn::Sqrt(spread));
        const auto noise_deg = hn::LoadU(d, noise + i);
        const auto error = hn::DemoteTo(f, hn::Mul(noise_deg, scale));
        const auto fit = hn::Mul(hn::Max(noise_deg, residual), scale);
        // Divide in whole vectors: the unused lanes of a part are 0 and would raise a trap.
        const auto known = hn::IfThenElseZero(has_slope, hn::Div(one, hn::Mul(fit, fit)));
        const auto precision = hn::DemoteTo(f, known);
        const auto of_window = hn::DemoteTo(f, slope);

        // Windows without a slope contradict no other window, and weigh nothing.
        const auto valid = hn::Ne(hn::DemoteTo(f, hn::IfThenElseZero(has_slope, one)), hn::Zero(f));
        const auto wide = hn::Mul(hn::Set(f, rule.confidence), error);
        const auto most = hn::Mul(hn::Set(d, rule.most_residual), noise_deg);
        const auto score = hn::IfThenElse(hn::Le(residual, most), one, hn::Set(d, -2.0));
        hn::StoreU(of_window, f, windows.slope.data() + i);
        hn::StoreU(hn::DemoteTo(f, fit), f, windows.fit_error.data() + i);
        hn::StoreU(hn::IfThenElse(valid, hn::Sub(of_window, wide), hn::Neg(infinity)), f,
                   windows.low.data() + i);
        hn::StoreU(hn::IfThenElse(valid, hn::Add(of_window, wide), infinity), f,
                   windows.high.data() + i);
        hn::StoreU(precision, f, windows.precision.data() + i);
        hn::StoreU(hn::Mul(precision, error), f, windows.weight.data() + i);
        hn::StoreU(hn::DemoteTo(f, hn::IfThenElseZero(has_slope, score)), f,
                   windows.line_score.data() + i);
    }
}

// Returns the place of the window of which `part` of `parts` parts are before a gate.
HWY_INLINE std::size_t place_of(const WindowSlopes& length, std::ptrdiff_t part,
                                std::ptrdiff_t parts, std::size_t gate) {
    const std::ptrdiff_t before = part * (length.gates - 1) / parts;
    return gate + static_cast<std::size_t>(length.gates - 1 - before);
}

void find_even(const WindowSlopes& longest, std::ptrdiff_t parts, std::size_t gates,
               float* HWY_RESTRICT is_even) {
    const hn::CappedTag<float, RowSums::spare> f;
    for (std::size_t gate = 0; gate < gates; gate += hn::Lanes(f)) {
        auto score = hn::Zero(f);
        for (std::ptrdiff_t part = 0; part <= parts; ++part) {
            const std::size_t at = place_of(longest, part, parts, gate);
            score = hn::Add(score, hn::LoadU(f, longest.line_score.data() + at));
        }
        hn::StoreU(hn::IfThenElseZero(hn::Gt(score, hn::Zero(f)), hn::Set(f, 1.0F)), f,
                   is_even + gate);
    }
}

void add_windows(std::span<const WindowSlopes> lengths, std::ptrdiff_t part, std::ptrdiff_t parts,
                 float share, std::size_t gates, SlopeSums& sums) {
    const hn::CappedTag<float, RowSums::spare> f;
    const auto infinity = hn::Set(f, std::numeric_limits<float>::infinity());
    const auto shared = hn::Set(f, share);
    for (std::size_t gate = 0; gate < gates; gate += hn::Lanes(f)) {
        const auto is_even = hn::Gt(hn::LoadU(f, sums.is_even.data() + gate), hn::Zero(f));
        auto low = hn::Neg(infinity), high = infinity;
        auto weights = hn::LoadU(f, sums.weights.data() + gate);
        auto slopes = hn::LoadU(f, sums.slopes.data() + gate);
        auto squares = hn::LoadU(f, sums.squares.data() + gate);
        auto errors = hn::LoadU(f, sums.errors.data() + gate);
        for (const WindowSlopes& length : lengths) {
            const std::size_t at = place_of(length, part, parts, gate);
            low = hn::Max(low, hn::LoadU(f, length.low.data() + at));
            high = hn::Min(high, hn::LoadU(f, length.high.data() + at));
            const auto full = hn::IfThenElse(is_even, hn::LoadU(f, length.precision.data() + at),
                                             hn::LoadU(f, length.weight.data() + at));
            const auto weight = hn::IfThenElseZero(hn::Le(low, high), hn::Mul(shared, full));
            const auto slope = hn::LoadU(f, length.slope.data() + at);
            const auto weighted = hn::Mul(weight, slope);
            weights = hn::Add(weights, weight);
            slopes = hn::Add(slopes, weighted);
            squares = hn::Add(squares, hn::Mul(weighted, slope));
            errors = hn::Add(errors, hn::Mul(weight, hn::LoadU(f, length.fit_error.data() + at)));
        }
        hn::StoreU(weights, f, sums.weights.data() + gate);
        hn::StoreU(slopes, f, sums.slopes.data() + gate);
        hn::StoreU(squares, f, sums.squares.data() + gate);
        hn::StoreU(errors, f, sums.errors.data() + gate);
    }
}

}  // namespace stormcellar::retrieve::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::retrieve {

HWY_EXPORT(fit_windows);
HWY_EXPORT(find_even);
HWY_EXPORT(add_windows);

void fit_windows(const RowSums& sums, std::span<const double> noise_deg, std::size_t reach,
                 const WindowRule& rule, WindowSlopes& windows) {
    const auto length = static_cast<std::size_t>(windows.gates);
    const std::size_t row = noise_deg.size() - 2 * reach - RowSums::spare;
    const std::size_t count = row + length - 1;
    for (std::vector<float>* values :
         {&windows.slope, &windows.fit_error, &windows.low, &windows.high, &windows.precision,
          &windows.weight, &windows.line_score})
        values->resize(count + 2 * RowSums::spare);
    // The middle of the first window.
    const double* noise = noise_deg.data() + (reach + 1 + length / 2 - length);
    HWY_DYNAMIC_DISPATCH(fit_windows)(sums, noise, rule, count, windows);
}

void SlopeSums::begin(const WindowSlopes& longest, std::ptrdiff_t parts, std::size_t gates) {
    is_even.resize(gates + RowSums::spare);
    for (std::vector<float>* values : {&weights, &slopes, &squares, &errors})
        values->assign(gates + RowSums::spare, 0);
    HWY_DYNAMIC_DISPATCH(find_even)(longest, parts, gates, is_even.data());
}

void add_windows(std::span<const WindowSlopes> lengths, std::ptrdiff_t part, std::ptrdiff_t parts,
                 float share, std::size_t gates, SlopeSums& sums) {
    HWY_DYNAMIC_DISPATCH(add_windows)(lengths, part, parts, share, gates, sums);
}

}  // namespace stormcellar::retrieve
#endif
