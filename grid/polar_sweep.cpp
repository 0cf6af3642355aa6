#include "grid/polar_sweep.h"

#include <algorithm>
#include <cmath>

#include "grid/detection_limit.h"

namespace stormcellar::grid {
namespace {

// Stand in for a beam that never passes over an arc: no gate, and above everything.
constexpr double no_gate = -1;
constexpr double above_everything_m = 1e9;

ArcTable height_table(const BeamGeometry& beam, double elevation_deg, std::size_t size) {
    return {size, [&](double arc_m) {
                const double height_m = beam.over(arc_m, elevation_deg).height_m;
                return std::isnan(height_m) ? above_everything_m : height_m;
            }};
}

ArcTable gate_table(const BeamGeometry& beam, double elevation_deg,
                    const level2::SweepMoment& moment, std::size_t size) {
    return {size, [&](double arc_m) {
                const double range_m = beam.over(arc_m, elevation_deg).range_m;
                if (std::isnan(range_m)) return no_gate;
                return (range_m - moment.first_gate_m) / moment.gate_spacing_m + 0.5;
            }};
}

std::uint16_t first_valid_code(level2::Moment moment) {
    return moment == level2::Moment::cfp ? 8 : 2;
}

std::vector<float> value_table(const level2::SweepMoment& moment) {
    std::vector<float> values;
    if (moment.word_size_bits != 8) return values;
    for (std::uint16_t code = 0; code < 256; ++code)
        values.push_back(moment.value_of(code));
    return values;
}

std::vector<float> spreading_curve(const level2::SweepMoment& moment) {
    const DetectionLimit at_zero_dbz{0, 0};
    std::vector<float> curve;
    curve.reserve(static_cast<std::size_t>(std::max(moment.gate_stride, 0)));
    for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate)
        curve.push_back(static_cast<float>(at_zero_dbz.at(moment.range_m(gate))));
    return curve;
}

// Gates of a radial that are really there, whatever the counts say.
std::int32_t gates_of(const level2::SweepMoment& moment, std::size_t radial) {
    if (radial >= moment.gate_counts.size() || moment.gate_spacing_m <= 0) return 0;
    const std::size_t held =
        moment.word_size_bits == 8 ? moment.codes8.size() : moment.codes16.size();
    const auto stride = static_cast<std::size_t>(std::max(moment.gate_stride, 0));
    if ((radial + 1) * stride > held) return 0;
    return std::min<std::int32_t>(moment.gate_counts[radial], moment.gate_stride);
}

std::vector<float> azimuths_of(const level2::Sweep& sweep, const ChosenSweep& chosen) {
    std::vector<float> azimuths_deg;
    for (const std::uint32_t radial : chosen.radials)
        azimuths_deg.push_back(normal_azimuth(sweep.radials[radial].azimuth_deg).value_or(0.0F));
    return azimuths_deg;
}

AzimuthTable azimuth_table(const level2::Sweep& sweep, const ChosenSweep& chosen) {
    const std::vector<float> azimuths_deg = azimuths_of(sweep, chosen);
    std::vector<float> sorted = azimuths_deg;
    std::sort(sorted.begin(), sorted.end());
    return {azimuths_deg, azimuth_spacing_deg(sorted, sweep.azimuth_spacing_deg)};
}

CellStatus status_of_flag(level2::Moment moment, std::uint16_t code) {
    if (moment == level2::Moment::cfp) return CellStatus::not_seen;
    return code == 0 ? CellStatus::no_echo : CellStatus::range_folded;
}

}  // namespace

PolarSweep::PolarSweep(const level2::Sweep& sweep, const ChosenSweep& chosen,
                       const BeamGeometry& beam, const PolarSweepOptions& options)
    : height_(height_table(beam, chosen.elevation_deg, options.table_size)),
      lower_edge_(
          height_table(beam, chosen.elevation_deg - options.half_beam_deg, options.table_size)),
      upper_edge_(
          height_table(beam, chosen.elevation_deg + options.half_beam_deg, options.table_size)),
      azimuths_(azimuth_table(sweep, chosen)) {
    for (const level2::SweepMoment& moment : sweep.moments) {
        if (moment.moment != options.moment || moment.gate_spacing_m <= 0) continue;
        Kind kind;
        kind.moment = &moment;
        kind.gate = gate_table(beam, chosen.elevation_deg, moment, options.table_size);
        kind.first_gate = static_cast<float>(std::max(
            0.0, std::ceil(-static_cast<double>(moment.first_gate_m) / moment.gate_spacing_m)));
        kind.values = value_table(moment);
        kind.spreading_db = spreading_curve(moment);
        kinds_.push_back(std::move(kind));
    }
    add_rows(sweep, chosen, options);
}

void PolarSweep::add_rows(const level2::Sweep& sweep, const ChosenSweep& chosen,
                          const PolarSweepOptions& options) {
    for (const std::uint32_t radial : chosen.radials) {
        Row row;
        row.radial = radial;
        for (std::size_t kind = 0; kind < kinds_.size() && row.gate_count == 0; ++kind) {
            const level2::SweepMoment& moment = *kinds_[kind].moment;
            row.kind = static_cast<std::uint32_t>(kind);
            row.gate_count = gates_of(moment, radial);
            const DetectionLimit limit =
                detection_limit(sweep.radials[radial], moment, options.is_tdwr);
            row.limit_at_1km_dbz = static_cast<float>(limit.at_1km_dbz);
            row.attenuation_db_per_m = static_cast<float>(limit.attenuation_db_per_km / 1000);
        }
        rows_.push_back(row);
    }
}

Sample PolarSweep::sample(float azimuth_deg, ArcPlace place) const {
    const int position = azimuths_.find(azimuth_deg);
    if (position == AzimuthTable::none) return {};
    const Row& row = rows_[static_cast<std::size_t>(position)];
    if (row.gate_count == 0) return {};
    const Kind& kind = kinds_[row.kind];
    const float gate_and_half = kind.gate.at(place);
    const bool within =
        gate_and_half >= kind.first_gate && gate_and_half < static_cast<float>(row.gate_count);
    if (!within) return {};

    const level2::SweepMoment& moment = *kind.moment;
    const auto gate = static_cast<std::int32_t>(gate_and_half);
    const std::uint16_t code = moment.code(row.radial, gate);
    if (code >= first_valid_code(moment.moment)) {
        const float value = moment.word_size_bits == 8 ? kind.values[code] : moment.value_of(code);
        return {CellStatus::value, value, 0};
    }
    const auto range_m = static_cast<float>(moment.range_m(gate));
    const float limit_dbz = row.limit_at_1km_dbz +
                            kind.spreading_db[static_cast<std::size_t>(gate)] +
                            row.attenuation_db_per_m * range_m;
    return {status_of_flag(moment.moment, code), 0, limit_dbz};
}

double greatest_arc_m(const level2::Sweep& sweep, const ChosenSweep& chosen, level2::Moment moment,
                      const BeamGeometry& beam) {
    double greatest_m = 0;
    for (const level2::SweepMoment& kind : sweep.moments) {
        if (kind.moment != moment) continue;
        const double range_m = std::max(0.0, kind.range_m(kind.gate_stride));
        greatest_m = std::max(greatest_m, beam.forward({range_m, chosen.elevation_deg}).arc_m);
    }
    return greatest_m;
}

}  // namespace stormcellar::grid
