#include "tests/retrieve/layered_volume.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>

#include "stormcellar/grid/beam_geometry.h"
#include "tests/retrieve/empty_moment.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr int nearest_gate_m = 2125, gate_spacing_m = 250;
constexpr double beam_sigma_deg = 0.95 / 3.33;
constexpr std::array beam_places = {-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0};

std::uint16_t dual_code(const level2::SweepMoment& moment, double value) {
    const double code =
        value * static_cast<double>(moment.scale) + static_cast<double>(moment.offset);
    return static_cast<std::uint16_t>(std::clamp(std::lround(code), 2L, 1058L));
}

// Sums powers of both polarizations and their correlation over the beam.
class BeamMean {
  public:
    void add(const DualPoint& point, double weight) {
        weights_ += weight;
        if (point.dbz < -50) return;
        const double horizontal = weight * std::pow(10, point.dbz / 10);
        const double vertical = horizontal * std::pow(10, -point.zdr_db / 10);
        horizontal_ += horizontal;
        vertical_ += vertical;
        correlated_ += point.rho * std::sqrt(horizontal * vertical);
        phase_ += point.kdp_deg_per_km * horizontal;
    }
    [[nodiscard]] DualPoint mean() const {
        if (horizontal_ <= 0) return {};
        return {10 * std::log10(horizontal_ / weights_), 10 * std::log10(horizontal_ / vertical_),
                correlated_ / std::sqrt(horizontal_ * vertical_), phase_ / horizontal_};
    }

  private:
    double weights_ = 0, horizontal_ = 0, vertical_ = 0, correlated_ = 0, phase_ = 0;
};

class SweepMaker {
  public:
    using Point = std::function<DualPoint(double, double, double)>;
    SweepMaker(const LayeredSpec& spec, const Point& point)
        : spec_(spec), point_(point), random_(spec.seed) {}

    level2::Sweep make(double elevation_deg) {
        using namespace std::chrono;
        level2::Sweep sweep;
        for (int i = 0; i < spec_.radials; ++i) {
            level2::Radial& radial = sweep.radials.emplace_back();
            radial.time = sys_days{year{2016} / 6 / 1};
            radial.azimuth_deg =
                0.5F + 360.0F * static_cast<float>(i) / static_cast<float>(spec_.radials);
            radial.elevation_deg = static_cast<float>(elevation_deg);
            radial.nyquist_mps = 26;
        }
        const GateLayout layout = {spec_.radials, spec_.gates, nearest_gate_m, gate_spacing_m};
        for (const Moment kind : {Moment::ref, Moment::zdr, Moment::phi, Moment::rho})
            sweep.moments.push_back(empty_moment(layout, kind));
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
            fill(sweep, radial, elevation_deg);
        return sweep;
    }

  private:
    void fill(level2::Sweep& sweep, std::size_t radial, double elevation_deg) {
        const auto azimuth = static_cast<double>(sweep.radials[radial].azimuth_deg);
        if (azimuth < spec_.azimuth_from_deg || azimuth > spec_.azimuth_to_deg) return;
        double phase = 60;
        for (int gate = 0; gate < spec_.gates; ++gate) {
            const double range = sweep.moments[0].range_m(gate);
            BeamMean mean;
            for (const double place : beam_places) {
                const grid::EarthPoint at =
                    beam_.forward({range, elevation_deg + place * beam_sigma_deg});
                mean.add(point_(azimuth, at.arc_m, at.height_m), std::exp(-place * place / 2));
            }
            const DualPoint seen = mean.mean();
            if (seen.dbz < -10) continue;
            phase += 2 * seen.kdp_deg_per_km * gate_spacing_m / 1000;
            const std::array values = {
                seen.dbz + normal_(random_), seen.zdr_db + 0.3 * normal_(random_),
                phase + 2 * normal_(random_),
                std::min(seen.rho + (0.006 + (1 - seen.rho) / 8) * normal_(random_), 1.0)};
            const std::size_t to =
                radial * static_cast<std::size_t>(spec_.gates) + static_cast<std::size_t>(gate);
            for (std::size_t i = 0; i < values.size(); ++i)
                sweep.moments[i].codes16[to] = dual_code(sweep.moments[i], values[i]);
        }
    }

    const LayeredSpec& spec_;
    const Point& point_;
    grid::BeamGeometry beam_{40, 0};
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
};

// A smooth bump between 0 and 1 with a height of 1 at `peak`.
double bump(double at, double peak, double sharpness) {
    if (at <= 0 || at >= 1) return 0;
    const double first = peak * sharpness, second = (1 - peak) * sharpness;
    return std::pow(at / peak, first) * std::pow((1 - at) / (1 - peak), second);
}

}  // namespace

level2::Volume layered_volume(
    const LayeredSpec& spec,
    const std::function<DualPoint(double azimuth_deg, double arc_m, double height_m)>& point) {
    level2::Volume volume;
    volume.station = "KTLX";
    SweepMaker maker(spec, point);
    for (const double elevation : spec.elevations_deg)
        volume.sweeps.push_back(maker.make(elevation));
    return volume;
}

DualPoint MeltingProfile::at(double height_m) const {
    const double melted = std::clamp((top_m - height_m) / (top_m - bottom_m), 0.0, 1.0);
    const double snow_dbz = rain_dbz - 4 - 3.5e-3 * std::max(height_m - top_m, 0.0);
    const double rain_zdr = std::max(0.2, 0.03 * (rain_dbz - 15));
    return {std::lerp(snow_dbz, rain_dbz, melted) + bright_db * bump(melted, 0.4, sharpness),
            std::lerp(0.2, rain_zdr, melted) + zdr_db * bump(melted, 0.65, sharpness),
            0.993 - depth * bump(melted, low_place, sharpness), 0};
}

}  // namespace stormcellar::retrieve
