#include "retrieve/hydrometeors/memberships.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr float least_fit = 0.5F;
constexpr std::size_t variables = 6;

// A corner of a trapezoid: a number, or a function of reflectivity plus a number.
enum class Curve : std::uint8_t { none, f1, f2, f3, g1, g2 };
struct Corner {
    float number = 0;
    Curve curve = Curve::none;
};
using Trapezoid = std::array<Corner, 4>;

constexpr Trapezoid numbers(float a, float b, float c, float d) {
    return {Corner{a}, Corner{b}, Corner{c}, Corner{d}};
}
// The same for all precipitation.
constexpr Trapezoid smooth_dbz = numbers(0, 0.5F, 3, 6), smooth_phase = numbers(0, 1, 15, 30);
constexpr Trapezoid any_kdp = numbers(-30, -25, 10, 20);
constexpr Trapezoid rain_zdr = {Corner{-0.3F, Curve::f1}, Corner{0, Curve::f1},
                                Corner{0, Curve::f2}, Corner{0.5F, Curve::f2}};
constexpr Trapezoid rain_kdp = {Corner{-1, Curve::g1}, Corner{0, Curve::g1}, Corner{0, Curve::g2},
                                Corner{1, Curve::g2}};

// Trapezoids and weights: reflectivity, ZDR, correlation, log KDP, deviations of reflectivity and
// phase.
struct ClassRow {
    Hydrometeor kind = Hydrometeor::none;
    std::array<Trapezoid, variables> fits = {};
    std::array<float, variables> weights = {};
};
constexpr std::array<ClassRow, hydrometeor_count - 1> class_rows = {{
    {Hydrometeor::biological,
     {numbers(5, 10, 20, 30), numbers(0, 2, 10, 12), numbers(0.3F, 0.5F, 0.8F, 0.83F),
      numbers(-30, -25, 10, 10), numbers(1, 2, 4, 7), numbers(8, 10, 40, 60)},
     {0.4F, 0.6F, 1, 0, 0.8F, 0.8F}},
    {Hydrometeor::ground_clutter,
     {numbers(15, 20, 70, 80), numbers(-4, -2, 1, 2), numbers(0.5F, 0.6F, 0.9F, 0.95F), any_kdp,
      numbers(2, 4, 10, 15), numbers(30, 40, 50, 60)},
     {0.2F, 0.4F, 1, 0, 0.6F, 0.8F}},
    {Hydrometeor::ice_crystals,
     {numbers(0, 5, 20, 25), numbers(0.1F, 0.4F, 3, 3.3F), numbers(0.95F, 0.98F, 1, 1.01F),
      numbers(-5, 0, 10, 15), smooth_dbz, smooth_phase},
     {1, 0.6F, 0.4F, 0.5F, 0.2F, 0.2F}},
    {Hydrometeor::dry_snow,
     {numbers(5, 10, 35, 40), numbers(-0.3F, 0, 0.3F, 0.6F), numbers(0.95F, 0.98F, 1, 1.01F),
      any_kdp, smooth_dbz, smooth_phase},
     {1, 0.8F, 0.6F, 0, 0.2F, 0.2F}},
    {Hydrometeor::wet_snow,
     {numbers(25, 30, 40, 50), numbers(0.5F, 1, 2, 3), numbers(0.88F, 0.92F, 0.95F, 0.985F),
      any_kdp, smooth_dbz, smooth_phase},
     {0.6F, 0.8F, 1, 0, 0.2F, 0.2F}},
    {Hydrometeor::rain,
     {numbers(5, 10, 45, 50), rain_zdr, numbers(0.95F, 0.97F, 1, 1.01F), rain_kdp, smooth_dbz,
      smooth_phase},
     {1, 0.8F, 0.6F, 0, 0.2F, 0.2F}},
    {Hydrometeor::heavy_rain,
     {numbers(40, 45, 55, 60), rain_zdr, numbers(0.92F, 0.95F, 1, 1.01F), rain_kdp, smooth_dbz,
      smooth_phase},
     {1, 0.8F, 0.6F, 1, 0.2F, 0.2F}},
    {Hydrometeor::big_drops,
     {numbers(20, 25, 45, 50),
      Trapezoid{Corner{-0.3F, Curve::f2}, Corner{0, Curve::f2}, Corner{0, Curve::f3},
                Corner{1, Curve::f3}},
      numbers(0.92F, 0.95F, 1, 1.01F), rain_kdp, smooth_dbz, smooth_phase},
     {0.8F, 1, 0.6F, 0, 0.2F, 0.2F}},
    {Hydrometeor::graupel,
     {numbers(25, 35, 50, 55),
      Trapezoid{Corner{-0.3F}, Corner{0}, Corner{0, Curve::f1}, Corner{0.3F, Curve::f1}},
      numbers(0.9F, 0.97F, 1, 1.01F), any_kdp, smooth_dbz, smooth_phase},
     {0.8F, 1, 0.4F, 0, 0.2F, 0.2F}},
    {Hydrometeor::hail,
     {numbers(45, 50, 75, 80),
      Trapezoid{Corner{-0.3F}, Corner{0}, Corner{0, Curve::f1}, Corner{0.5F, Curve::f1}},
      numbers(0.85F, 0.9F, 1, 1.01F),
      Trapezoid{Corner{-10}, Corner{-4}, Corner{0, Curve::g1}, Corner{1, Curve::g1}}, smooth_dbz,
      smooth_phase},
     {1, 0.8F, 0.6F, 1, 0.2F, 0.2F}},
}};

// The functions of reflectivity, for one gate.
class Curves {
  public:
    explicit Curves(float dbz)
        : values_{0,
                  -0.50F + 2.50e-3F * dbz + 7.50e-4F * dbz * dbz,
                  0.68F - 4.81e-2F * dbz + 2.92e-3F * dbz * dbz,
                  1.42F + 6.67e-2F * dbz + 4.85e-4F * dbz * dbz,
                  -44.0F + 0.8F * dbz,
                  -22.0F + 0.5F * dbz} {}
    [[nodiscard]] float at(const Corner& corner) const {
        return corner.number + values_[static_cast<std::size_t>(corner.curve)];
    }
    [[nodiscard]] float f2() const { return values_[static_cast<std::size_t>(Curve::f2)]; }

  private:
    std::array<float, 6> values_;
};

// Returns 1 between the inner corners, 0 outside the outer corners. Corners that are functions may
// cross, so the inner corners count first.
float fit_of(const Trapezoid& shape, const Curves& curves, float value) {
    const float begin = curves.at(shape[1]), end = curves.at(shape[2]);
    if (value >= begin && value <= end) return 1;
    const float outer = curves.at(value < begin ? shape[0] : shape[3]);
    const float inner = value < begin ? begin : end;
    const float width = inner - outer;
    return width != 0 ? std::clamp((value - outer) / width, 0.0F, 1.0F) : 0.0F;
}

// Returns the weighted mean of the fits of the known variables.
float total_fit(const ClassRow& row, const Curves& curves,
                const std::array<float, variables>& values) {
    float sum = 0, weights = 0;
    for (std::size_t i = 0; i < variables; ++i) {
        if (row.weights[i] <= 0 || std::isnan(values[i])) continue;
        sum += row.weights[i] * fit_of(row.fits[i], curves, values[i]);
        weights += row.weights[i];
    }
    return weights > 0 ? sum / weights : 0;
}

using Kinds = std::uint16_t;  // a bit for each class
constexpr Kinds bit(Hydrometeor kind) {
    return static_cast<Kinds>(1U << static_cast<unsigned>(kind));
}
template <class... Kind>
constexpr Kinds kinds(Kind... kind) {
    return static_cast<Kinds>((bit(kind) | ...));
}

// The classes that are possible at each place.
constexpr Kinds possible_at(BeamPlace place) {
    using enum Hydrometeor;
    switch (place) {
        case BeamPlace::below:
            return kinds(ground_clutter, biological, big_drops, rain, heavy_rain, hail);
        case BeamPlace::center_below:
            return kinds(ground_clutter, biological, wet_snow, graupel, big_drops, rain, heavy_rain,
                         hail);
        case BeamPlace::inside:
            return kinds(ground_clutter, biological, dry_snow, wet_snow, graupel, big_drops, hail);
        case BeamPlace::center_above:
            return kinds(dry_snow, wet_snow, ice_crystals, graupel, big_drops, hail);
        case BeamPlace::above:
            return kinds(dry_snow, ice_crystals, graupel, hail);
    }
    return 0;
}

// Returns true if a hard limit rules the class out. An unknown variable rules out nothing.
bool is_ruled_out(Hydrometeor kind, const GateVariables& gate, const Curves& curves) {
    const float dbz = gate.reflectivity_dbz, zdr = gate.zdr_db;
    switch (kind) {
        case Hydrometeor::ground_clutter:
            return gate.speed_mps > 1;
        case Hydrometeor::biological:
            return gate.correlation > 0.97F;
        case Hydrometeor::dry_snow:
            return zdr > 2;
        case Hydrometeor::wet_snow:
            return dbz < 20 || zdr < 0;
        case Hydrometeor::ice_crystals:
            return dbz > 40;
        case Hydrometeor::graupel:
            return dbz < 10 || dbz > 60;
        case Hydrometeor::big_drops:
            return zdr < curves.f2() - 0.3F;
        case Hydrometeor::rain:
            return dbz > 50;
        case Hydrometeor::heavy_rain:
            return dbz < 30;
        case Hydrometeor::hail:
            return dbz < 40;
        case Hydrometeor::none:
            return true;
    }
    return true;
}

}  // namespace

Hydrometeor best_class(const GateVariables& gate, BeamPlace place) {
    if (std::isnan(gate.reflectivity_dbz + gate.zdr_db + gate.correlation))
        return Hydrometeor::none;
    const Curves curves(gate.reflectivity_dbz);
    const std::array values = {gate.reflectivity_dbz,
                               gate.zdr_db,
                               gate.correlation,
                               gate.log_kdp,
                               gate.reflectivity_deviation_db,
                               gate.phase_deviation_deg};
    const Kinds possible = possible_at(place);
    Hydrometeor best = Hydrometeor::none;
    float largest = least_fit;
    for (const ClassRow& row : class_rows) {
        if ((possible & bit(row.kind)) == 0 || is_ruled_out(row.kind, gate, curves)) continue;
        const float fit = total_fit(row, curves, values);
        if (fit < largest || (fit == largest && best != Hydrometeor::none)) continue;
        largest = fit;
        best = row.kind;
    }
    return best;
}

}  // namespace stormcellar::retrieve
