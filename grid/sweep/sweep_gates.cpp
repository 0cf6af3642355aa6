#include "grid/sweep/sweep_gates.h"

#include <algorithm>
#include <cmath>

#include "grid/beam/detection_limit.h"

namespace stormcellar::grid {
namespace {

// The gate number for an arc over which the beam does not pass.
constexpr double no_gate = -1e9;

ArcTable gate_table(const BeamPath& path, const level2::SweepMoment& moment, std::size_t size) {
    return {size, [&](double arc_m) {
                const double range_m = path.over(arc_m).range_m;
                if (std::isnan(range_m)) return no_gate;
                return (range_m - moment.first_gate_m) / moment.gate_spacing_m + 0.5;
            }};
}

float in_unit(float value, Averaging averaging) {
    if (averaging == Averaging::in_db) return value;
    // No radar measures values outside these limits. A float would overflow at 385 dBZ.
    return std::pow(10.0F, std::clamp(value, -300.0F, 300.0F) / 10);
}

std::vector<float> value_table(const level2::SweepMoment& moment, Averaging averaging) {
    std::vector<float> values;
    if (moment.word_size_bits != 8) return values;
    for (std::uint16_t code = 0; code < 256; ++code)
        values.push_back(in_unit(moment.value_of(code), averaging));
    return values;
}

// Returns how many gates a radial really has, even if its counts are damaged.
std::int32_t gates_of(const level2::SweepMoment& moment, std::size_t radial) {
    if (radial >= moment.gate_counts.size() || moment.gate_spacing_m <= 0) return 0;
    const std::size_t held =
        moment.word_size_bits == 8 ? moment.codes8.size() : moment.codes16.size();
    const auto stride = static_cast<std::size_t>(std::max(moment.gate_stride, 0));
    if ((radial + 1) * stride > held) return 0;
    return std::min<std::int32_t>(moment.gate_counts[radial], moment.gate_stride);
}

CellStatus status_of_flag(level2::Moment moment, std::uint16_t code) {
    const level2::GateStatus status = level2::status_of_code(moment, code);
    if (status == level2::GateStatus::no_data) return CellStatus::not_seen;
    if (status == level2::GateStatus::ambiguous) return CellStatus::ambiguous;
    return status == level2::GateStatus::below_threshold ? CellStatus::no_echo
                                                         : CellStatus::range_folded;
}

}  // namespace

SweepGates::SweepGates(const level2::Sweep& sweep, const ChosenSweep& chosen, const BeamModel& beam,
                       const PolarSweepOptions& options)
    : blending_(options.on_circle || !is_circular(blending_of(options.moment))
                    ? blending_of(options.moment)
                    : Blending::values_only),
      averaging_(options.averaging),
      cell_(options.cell) {
    for (const level2::SweepMoment& moment : sweep.moments) {
        if (moment.moment != options.moment || moment.gate_spacing_m <= 0) continue;
        add_kind(moment, beam.path(chosen.elevation_deg), options.table_size);
    }
    add_rows(sweep, chosen, options);
    mark_blocks();
}

void SweepGates::add_kind(const level2::SweepMoment& moment, const BeamPath& path,
                          std::size_t table_size) {
    Kind kind;
    kind.moment = &moment;
    kind.gate = gate_table(path, moment, table_size);
    kind.first_gate = static_cast<std::int32_t>(std::max(
        0.0, std::ceil(-static_cast<double>(moment.first_gate_m) / moment.gate_spacing_m)));
    kind.first_valid_code = level2::facts_of(moment.moment).first_valid_code;
    kind.values = value_table(moment, averaging_);
    kinds_.push_back(std::move(kind));
}

// Tabulates what the range of each gate adds to the detection limit. Uses the attenuation of the
// first radial; detection_limit_of() corrects the result for radials with another attenuation.
void SweepGates::add_losses(float attenuation_db_per_m, Kind& kind) const {
    const DetectionLimit at_zero_dbz{0, 0};
    kind.attenuation_db_per_m = attenuation_db_per_m;
    kind.losses.reserve(static_cast<std::size_t>(std::max(kind.moment->gate_stride, 0)));
    for (std::int32_t gate = 0; gate < kind.moment->gate_stride; ++gate) {
        const double range_m = kind.moment->range_m(gate);
        const float attenuation_db = attenuation_db_per_m * static_cast<float>(range_m);
        kind.losses.push_back({static_cast<float>(at_zero_dbz.at(range_m)), attenuation_db});
    }
    // The mean over a cell with an extent sums the limits of long runs of gates. With running sums,
    // a run costs only one subtraction (add_gates()).
    if (averaging_ == Averaging::in_db && cell_ == CellExtent::area) {
        double sum = 0;
        kind.loss_sums.push_back(sum);
        for (const Kind::Loss& loss : kind.losses) {
            sum += static_cast<double>(loss.spreading) + static_cast<double>(loss.attenuation);
            kind.loss_sums.push_back(sum);
        }
    }
    if (averaging_ == Averaging::in_db) return;
    for (Kind::Loss& loss : kind.losses)
        loss = {in_unit(loss.spreading, averaging_), in_unit(loss.attenuation, averaging_)};
}

// Makes a row for each used radial, with its codes, its limits and its circle. A radial belongs to
// the first kind of which it has gates.
void SweepGates::add_rows(const level2::Sweep& sweep, const ChosenSweep& chosen,
                          const PolarSweepOptions& options) {
    for (const std::uint32_t radial : chosen.radials) {
        Row row;
        row.radial = radial;
        row.half_period = half_period_of(options.moment, sweep.radials[radial].nyquist_mps);
        row.elevation_offset_deg = static_cast<float>(
            static_cast<double>(sweep.radials[radial].elevation_deg) - chosen.elevation_deg);
        for (std::size_t kind = 0; kind < kinds_.size() && row.gate_count == 0; ++kind) {
            const level2::SweepMoment& moment = *kinds_[kind].moment;
            row.kind = static_cast<std::uint32_t>(kind);
            row.gate_count = gates_of(moment, radial);
            const DetectionLimit limit =
                detection_limit(sweep.radials[radial], moment, options.is_tdwr);
            row.limit_at_1km = in_unit(static_cast<float>(limit.at_1km_dbz), averaging_);
            row.attenuation_db_per_m = static_cast<float>(limit.attenuation_db_per_km / 1000);
            if (row.gate_count > 0 && moment.word_size_bits == 8) {
                row.codes8 =
                    moment.codes8.data() + radial * static_cast<std::size_t>(moment.gate_stride);
            }
        }
        if (row.gate_count > 0 && blending_ == Blending::with_detection_limit) {
            Kind& kind = kinds_[row.kind];
            if (kind.losses.empty()) add_losses(row.attenuation_db_per_m, kind);
            row.has_simple_limit = averaging_ == Averaging::in_db &&
                                   row.attenuation_db_per_m == kind.attenuation_db_per_m;
        }
        rows_.push_back(row);
    }
}

// Marks the blocks of gates that hold anything but code 0. With the marks, uniform_status() sees at
// once that a tile has only no echo. Does so only for the usual coding: one kind of radials, 8-bit
// codes, and code 0 for no echo.
void SweepGates::mark_blocks() {
    if (rows_.empty()) return;
    const auto [fewest, most] =
        std::minmax_element(rows_.begin(), rows_.end(),
                            [](const Row& a, const Row& b) { return a.gate_count < b.gate_count; });
    fewest_gates_ = fewest->gate_count;
    most_gates_ = most->gate_count;
    const bool simple = kinds_.size() == 1 && kinds_[0].moment->word_size_bits == 8 &&
                        kinds_[0].first_valid_code == 2;
    if (!simple) return;
    busy_ = BusyBlocks(rows_.size(), static_cast<std::size_t>(most_gates_));
    for (std::size_t position = 0; position < rows_.size(); ++position) {
        const Row& row = rows_[position];
        busy_.mark(position, std::span(row.codes8, static_cast<std::size_t>(row.gate_count)));
    }
}

SweepGates::Between SweepGates::between(float least_arc_m, float greatest_arc_m) const {
    if (busy_.is_empty()) return {};
    const Kind& kind = kinds_[0];
    // Make the tables end beyond the last gate.
    const auto table_end =
        static_cast<float>(ArcTable::step_m) * static_cast<float>(kind.gate.size() - 2);
    const auto number_at = [&](float arc_m) {
        return kind.gate.at(ArcTable::place_of(std::min(arc_m, table_end)));
    };
    const float nearest = number_at(least_arc_m);
    const float farthest = number_at(greatest_arc_m);
    // The number of the gate rises with the arc, up to the end of the beam.
    if (nearest >= static_cast<float>(most_gates_)) return {CellStatus::not_seen, {}};
    const bool within = nearest >= static_cast<float>(kind.first_gate) && farthest >= nearest &&
                        farthest < static_cast<float>(fewest_gates_);
    if (!within) return {};
    return {{},
            BusyBlocks::blocks_of(static_cast<std::int32_t>(nearest),
                                  static_cast<std::int32_t>(farthest))};
}

Sample SweepGates::wide_gate_of(const Row& row, const Kind& kind, std::int32_t gate) const {
    const std::uint16_t code = kind.moment->code(row.radial, gate);
    if (code < kind.first_valid_code) return without_value(row, kind, gate, code);
    return {CellStatus::value, in_unit(kind.moment->value_of(code), averaging_), 0,
            row.half_period};
}

Sample SweepGates::without_value(const Row& row, const Kind& kind, std::int32_t gate,
                                 std::uint16_t code) const {
    const CellStatus status = status_of_flag(kind.moment->moment, code);
    if (status != CellStatus::no_echo || blending_ != Blending::with_detection_limit) {
        return {status, 0, 0, 0};
    }
    return {status, 0, detection_limit_of(row, kind, gate), 0};
}

float SweepGates::detection_limit_of(const Row& row, const Kind& kind, std::int32_t gate) const {
    const Kind::Loss& loss = kind.losses[static_cast<std::size_t>(gate)];
    float attenuation = loss.attenuation;
    if (row.attenuation_db_per_m != kind.attenuation_db_per_m) {
        const auto range_m = static_cast<float>(kind.moment->range_m(gate));
        attenuation = in_unit(row.attenuation_db_per_m * range_m, averaging_);
    }
    if (averaging_ == Averaging::in_db) return row.limit_at_1km + loss.spreading + attenuation;
    return row.limit_at_1km * loss.spreading * attenuation;
}

SweepGates::GatePlace SweepGates::gate_place(int position, ArcPlace place) const {
    const Row& row = rows_[static_cast<std::size_t>(position)];
    if (row.gate_count == 0) return {};
    const Kind& kind = kinds_[row.kind];
    return {kind.gate.at(place), kind.first_gate, row.gate_count};
}

float SweepGates::gates_per_m_of_arc(ArcPlace place) const {
    if (kinds_.empty()) return 0;
    const float here = kinds_[0].gate.at({place.index, 0});
    const float next = kinds_[0].gate.at({place.index, 1});
    return std::max(0.0F, (next - here) / static_cast<float>(ArcTable::step_m));
}

Sample SweepGates::gate(int position, std::int32_t gate) const {
    const Row& row = rows_[static_cast<std::size_t>(position)];
    return gate_of(row, kinds_[row.kind], gate);
}

// Adds a run of gates with weight 1. The two branches differ only in how they read a code and its
// value. So equal codes of 8 and of 16 bits give the same result.
void SweepGates::add_gates(int position, std::int32_t first, std::int32_t end,
                           Mixture& mixture) const {
    if (first >= end) return;
    const Row& row = rows_[static_cast<std::size_t>(position)];
    const Kind& kind = kinds_[row.kind];
    const bool has_limits = blending_ == Blending::with_detection_limit;
    const bool plain = kind.first_valid_code == 2 && !is_circular(blending_) &&
                       (!has_limits || (row.has_simple_limit && !kind.loss_sums.empty()));
    if (!plain) {
        for (std::int32_t gate = first; gate < end; ++gate)
            mixture.add(gate_of(row, kind, gate), 1, blending_);
        return;
    }
    if (row.codes8 != nullptr) {
        add_plain_gates(
            row, kind, first, end, [&](std::int32_t gate) { return row.codes8[gate]; },
            [&](std::uint8_t code) { return kind.values[code]; }, mixture);
    } else {
        add_plain_gates(
            row, kind, first, end,
            [&](std::int32_t gate) { return kind.moment->code(row.radial, gate); },
            [&](std::uint16_t code) { return in_unit(kind.moment->value_of(code), averaging_); },
            mixture);
    }
}

template <class CodeAt, class ValueOf>
void SweepGates::add_plain_gates(const Row& row, const Kind& kind, std::int32_t first,
                                 std::int32_t end, const CodeAt& code_at, const ValueOf& value_of,
                                 Mixture& mixture) const {
    const bool has_limits = blending_ == Blending::with_detection_limit;
    // Most runs hold only code 0, no echo. An "or" over the run shows that. Then the running sums
    // of the kind give the sum of the detection limits.
    unsigned any = 0;
    for (std::int32_t gate = first; gate < end; ++gate)
        any |= code_at(gate);
    if (any == 0) {
        double sum = 0;
        if (has_limits) {
            sum = static_cast<double>(end - first) * static_cast<double>(row.limit_at_1km) +
                  kind.loss_sums[static_cast<std::size_t>(end)] -
                  kind.loss_sums[static_cast<std::size_t>(first)];
        }
        mixture.add_counted(CellStatus::no_echo, end - first, static_cast<float>(sum), blending_);
        return;
    }
    // Otherwise count the gates by state, and sum their values and limits.
    int valued = 0, quiet = 0, ambiguous = 0;
    float values = 0, limits = 0;
    for (std::int32_t gate = first; gate < end; ++gate) {
        const auto code = code_at(gate);
        if (code >= kind.first_valid_code) {
            ++valued;
            values += value_of(code);
        } else if (code == 0) {
            ++quiet;
            if (!has_limits) continue;
            const Kind::Loss& loss = kind.losses[static_cast<std::size_t>(gate)];
            limits += row.limit_at_1km + loss.spreading + loss.attenuation;
        } else if (code == 2) {  // code 2 is a state only for derived moments
            ++ambiguous;
        }
    }
    mixture.add_counted(CellStatus::value, valued, values, blending_);
    mixture.add_counted(CellStatus::no_echo, quiet, limits, blending_);
    mixture.add_counted(CellStatus::ambiguous, ambiguous, 0, blending_);
    mixture.add_counted(CellStatus::range_folded, end - first - valued - quiet - ambiguous, 0,
                        blending_);
}

void SweepGates::add_along_radial(int position, ArcPlace place, float weight,
                                  Mixture& mixture) const {
    const Row& row = rows_[static_cast<std::size_t>(position)];
    const GatePlace at = gate_place(position, place);
    const bool within = row.gate_count > 0 && at.number_and_half >= static_cast<float>(at.first) &&
                        at.number_and_half < static_cast<float>(at.end);
    if (!within) return mixture.add_unseen(weight);
    const Kind& kind = kinds_[row.kind];
    const auto nearest = static_cast<std::int32_t>(at.number_and_half);
    // The distance of the place from the center of the nearest gate, from -1/2 to 1/2 gates.
    const float beyond = at.number_and_half - static_cast<float>(nearest) - 0.5F;
    const std::int32_t other = beyond < 0 ? nearest - 1 : nearest + 1;
    const bool alone = other < at.first || other >= at.end;
    const float other_weight = alone ? 0 : std::abs(beyond);
    mixture.add(gate_of(row, kind, nearest), weight * (1 - other_weight), blending_);
    if (!alone) mixture.add(gate_of(row, kind, other), weight * other_weight, blending_);
}

double greatest_arc_m(const level2::Sweep& sweep, const ChosenSweep& chosen, level2::Moment moment,
                      const BeamModel& beam) {
    const BeamPath path = beam.path(chosen.elevation_deg);
    double greatest_m = 0;
    for (const level2::SweepMoment& kind : sweep.moments) {
        if (kind.moment != moment) continue;
        const double range_m = std::max(0.0, kind.range_m(kind.gate_stride));
        const double arc_m = path.at(range_m).arc_m;
        greatest_m = std::max(greatest_m, std::isnan(arc_m) ? range_m : arc_m);
    }
    return greatest_m;
}

}  // namespace stormcellar::grid
