#include "retrieve/shear/gate_shear.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"
#include "retrieve/shear/median_filter.h"
#include "retrieve/shear/plane_fit.h"

namespace stormcellar::retrieve {
namespace {

constexpr double largest_kernel_m = 100e3;
constexpr double widest_super_resolution_deg = 0.75;
// A beam that points higher says little about horizontal winds.
constexpr double steepest_deg = 60;

bool needs_median(const VelocityRows& rows, MedianFilter filter) {
    switch (filter) {
        case MedianFilter::off:
            return false;
        case MedianFilter::super_resolution:
            return rows.azimuth_spacing_deg <= widest_super_resolution_deg;
        case MedianFilter::always:
            return true;
    }
    return false;
}

Kernel kernel_of(const ShearOptions& options, const VelocityRows& rows) {
    const double gates = options.kernel_range_m / 2 / rows.gate_spacing_m;
    return {options.kernel_azimuth_m / 2, static_cast<std::size_t>(std::max(gates, 1.0)),
            static_cast<float>(options.least_share)};
}

// Converts slopes of V per gate and per angle to slopes of V / cos(elevation) per meter over the
// ground.
void convert(const VelocityRows& rows, const std::vector<PlaneSlope>& slopes, ShearOfGate* gates) {
    const double level = std::cos(rows.elevation_deg * degree);
    const auto per_gate = static_cast<float>(1 / (level * level * rows.gate_spacing_m));
    for (std::size_t gate = 0; gate < rows.gates; ++gate) {
        const PlaneSlope& slope = slopes[gate];
        if (!slope.is_fitted) continue;
        const auto per_radian = static_cast<float>(1 / (level * level * rows.range_m(gate)));
        gates[gate] = {slope.along_azimuth * per_radian, slope.azimuth_error * per_radian,
                       slope.along_range * per_gate, slope.range_error * per_gate, true};
    }
}

}  // namespace

Result<void> check_shear_options(const ShearOptions& options) {
    for (const double size_m : {options.kernel_azimuth_m, options.kernel_range_m})
        if (!std::isgreater(size_m, 0.0) || size_m > largest_kernel_m)
            return fail(ErrorCode::bad_argument, "a kernel of {} m is not above 0 and up to {} m",
                        size_m, largest_kernel_m);
    if (!std::isgreater(options.least_share, 0.0) || options.least_share > 1)
        return fail(ErrorCode::bad_argument, "the share of gates {} is not above 0 and up to 1",
                    options.least_share);
    return {};
}

Result<void> check_folds(const level2::Volume& volume, const SweepFolds& folds) {
    if (folds.sweep >= volume.sweeps.size())
        return fail(ErrorCode::bad_argument, "the volume has no sweep {}", folds.sweep);
    const level2::Sweep& sweep = volume.sweeps[folds.sweep];
    if (folds.moment >= sweep.moments.size() ||
        sweep.moments[folds.moment].moment != level2::Moment::vel)
        return fail(ErrorCode::bad_argument, "moment {} of sweep {} is no velocity", folds.moment,
                    folds.sweep);
    const auto stride =
        static_cast<std::size_t>(std::max(sweep.moments[folds.moment].gate_stride, 0));
    const std::size_t gates = sweep.radials.size() * stride;
    if (folds.folds.size() != gates || folds.ambiguous.size() != gates)
        return fail(ErrorCode::bad_argument, "sweep {} has {} gates, not {} fold numbers",
                    folds.sweep, gates, folds.folds.size());
    return {};
}

Result<GateShear> gate_shear(const level2::Volume& volume, const SweepFolds& folds,
                             const ShearOptions& options, double farthest_m) {
    if (const auto checked = check_shear_options(options); !checked) return pass_on(checked);
    if (const auto checked = check_folds(volume, folds); !checked) return pass_on(checked);
    GateShear shear;
    shear.rows = velocity_rows(volume.sweeps[folds.sweep], folds, farthest_m);
    const VelocityRows& rows = shear.rows;
    shear.gates.resize(rows.row_count() * rows.gates);
    if (shear.gates.empty() || std::abs(rows.elevation_deg) > steepest_deg) return shear;
    const std::vector<float> filtered =
        needs_median(rows, options.median) ? median_filtered(rows) : rows.velocities_mps;
    const PlaneFit fit(rows, filtered, kernel_of(options, rows));
    std::vector<PlaneSlope> slopes(rows.gates);
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        fit.fit_row(row, slopes);
        convert(rows, slopes, shear.gates.data() + row * rows.gates);
    }
    return shear;
}

}  // namespace stormcellar::retrieve
