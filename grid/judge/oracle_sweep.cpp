#include "grid/judge/oracle_sweep.h"

#include <algorithm>
#include <cmath>

#include "grid/beam/detection_limit.h"
#include "grid/judge/oracle.h"
#include "grid/sweep/mixture.h"

namespace stormcellar::grid {
namespace {

double turn_to(double from_deg, double to_deg) {
    const double turn = std::fmod(to_deg - from_deg + 1080, 360);
    return turn > 180 ? turn - 360 : turn;
}

// Returns the angle between two azimuths, each of which may be up to two turns outside [0, 360).
double apart_deg(double a_deg, double b_deg) {
    double apart = std::abs(a_deg - b_deg);
    while (apart > 360)
        apart -= 360;
    return std::min(apart, 360 - apart);
}

double full_turn_to(double from_deg, double to_deg) {
    return std::fmod(to_deg - from_deg + 1080, 360);
}

}  // namespace

double oracle_pattern(double offset, double width) {
    if (std::abs(offset) >= width) return 0;
    const double ratio = offset / width;
    return (std::pow(0.0625, ratio * ratio) - 0.0625) / (1 - 0.0625);
}

OracleSweep::OracleSweep(const level2::Sweep& sweep, const ChosenSweep& chosen,
                         const OracleSetting& setting)
    : sweep_(sweep), chosen_(chosen), setting_(setting) {
    std::vector<double> azimuths_deg;
    for (const std::uint32_t index : chosen.radials) {
        Radial radial{index, full_turn_to(0, static_cast<double>(sweep.radials[index].azimuth_deg)),
                      nullptr};
        azimuths_deg.push_back(radial.azimuth_deg);
        for (const level2::SweepMoment& kind : sweep.moments) {
            const bool has = kind.moment == setting.moment && kind.gate_counts[index] > 0;
            if (has && radial.kind == nullptr) radial.kind = &kind;
        }
        std::erase_if(radials_,
                      [&](const Radial& other) { return other.azimuth_deg == radial.azimuth_deg; });
        radials_.push_back(radial);
    }
    std::sort(radials_.begin(), radials_.end(),
              [](const Radial& a, const Radial& b) { return a.azimuth_deg < b.azimuth_deg; });
    std::sort(azimuths_deg.begin(), azimuths_deg.end());
    std::vector<double> steps_deg;
    for (std::size_t i = 1; i < azimuths_deg.size(); ++i)
        steps_deg.push_back(azimuths_deg[i] - azimuths_deg[i - 1]);
    std::sort(steps_deg.begin(), steps_deg.end());
    const double step_deg = steps_deg.empty() ? 0 : steps_deg[steps_deg.size() / 2];
    spacing_deg_ =
        std::min(2.0, std::max(static_cast<double>(sweep.azimuth_spacing_deg), step_deg));
    if (!(spacing_deg_ > 0)) spacing_deg_ = 1;
}

// Returns true if there is no gap between a radial and the next radial, clockwise.
bool OracleSweep::is_joined(std::size_t at) const {
    if (radials_.size() == 1) return false;
    const Radial& next = radials_[(at + 1) % radials_.size()];
    return full_turn_to(radials_[at].azimuth_deg, next.azimuth_deg) <= 1.5 * spacing_deg_;
}

int OracleSweep::nearest(double azimuth_deg, bool& doubtful) const {
    int best = -1;
    double best_deg = 1e9;
    double next_deg = 1e9;
    for (std::size_t i = 0; i < radials_.size(); ++i) {
        const double off_deg = apart_deg(azimuth_deg, radials_[i].azimuth_deg);
        if (off_deg < best_deg) {
            next_deg = best_deg;
            best_deg = off_deg;
            best = static_cast<int>(i);
        } else {
            next_deg = std::min(next_deg, off_deg);
        }
    }
    if (best < 0) return best;
    const auto at = static_cast<std::size_t>(best);
    const bool ahead = turn_to(azimuth_deg, radials_[at].azimuth_deg) >= 0;
    const bool joined = is_joined(ahead ? (at + radials_.size() - 1) % radials_.size() : at);
    if (joined) {
        if (next_deg - best_deg < 2 * OracleColumn::doubt_azimuth_deg) doubtful = true;
        return best;
    }
    if (std::abs(best_deg - spacing_deg_ / 2) < OracleColumn::doubt_azimuth_deg) doubtful = true;
    return best_deg <= spacing_deg_ / 2 ? best : -1;
}

double OracleSweep::elevation_deg(double azimuth_deg, bool& doubtful) const {
    const int at = nearest(azimuth_deg, doubtful);
    if (at < 0) return chosen_.elevation_deg;
    const Radial& radial = radials_[static_cast<std::size_t>(at)];
    return static_cast<double>(sweep_.radials[radial.index].elevation_deg);
}

WeightedGate OracleSweep::gate(const Radial& radial, std::int32_t number, double weight) const {
    const level2::SweepMoment& kind = *radial.kind;
    WeightedGate gate{.weight = weight};
    if (number < 0 || kind.range_m(number) < 0) return gate;
    const level2::Radial& header = sweep_.radials[radial.index];
    switch (kind.status(radial.index, number)) {
        case level2::GateStatus::valid:
            gate.status = CellStatus::value;
            gate.value = static_cast<double>(kind.value_of(kind.code(radial.index, number)));
            gate.half_period =
                static_cast<double>(half_period_of(setting_.moment, header.nyquist_mps));
            break;
        case level2::GateStatus::below_threshold:
            gate.status = CellStatus::no_echo;
            gate.limit_dbz =
                detection_limit(header, kind, setting_.is_tdwr).at(kind.range_m(number));
            break;
        case level2::GateStatus::range_folded:
            gate.status = CellStatus::range_folded;
            break;
        case level2::GateStatus::ambiguous:
            gate.status = CellStatus::ambiguous;
            break;
        case level2::GateStatus::no_data:
            break;
    }
    return gate;
}

// Adds the nearest gate of a radial. If `two` is true, adds two of its gates, linear in range.
void OracleSweep::add_along(const Radial& radial, double range_m, double weight, bool two,
                            std::vector<WeightedGate>& gates, bool& doubtful) const {
    if (radial.kind == nullptr) {
        gates.push_back({CellStatus::not_seen, 0, 0, 0, weight});
        return;
    }
    const level2::SweepMoment& kind = *radial.kind;
    const double number = (range_m - kind.first_gate_m) / kind.gate_spacing_m;
    const auto nearest = static_cast<std::int32_t>(std::floor(number + 0.5));
    const double beyond = number - nearest;
    const std::int32_t next = beyond < 0 ? nearest - 1 : nearest + 1;
    const auto exists = [&](std::int32_t gate) {
        return gate >= 0 && kind.range_m(gate) >= 0 && gate < kind.gate_counts[radial.index];
    };
    const bool both = two && exists(nearest) && exists(next);
    const double border_m = (0.5 - std::abs(beyond)) * kind.gate_spacing_m;
    if (border_m < OracleColumn::doubt_range_m && !both) doubtful = true;
    if (!both) {
        gates.push_back(gate(radial, nearest, weight));
        return;
    }
    gates.push_back(gate(radial, nearest, weight * (1 - std::abs(beyond))));
    gates.push_back(gate(radial, next, weight * std::abs(beyond)));
}

// Adds two radials, or all radials weighted by the antenna's pattern.
void OracleSweep::add_radials(double azimuth_deg, std::size_t nearest, double range_m,
                              std::vector<WeightedGate>& gates, bool& doubtful) const {
    const bool by_pattern = setting_.method.interpolation == Interpolation::beam_weighted;
    const std::size_t count = radials_.size();
    const auto offset = [&](std::size_t at) {
        return turn_to(azimuth_deg, radials_[at].azimuth_deg);
    };
    std::vector<std::size_t> joined = {nearest};
    for (std::size_t at = nearest; is_joined(at) && joined.size() < count; at = (at + 1) % count) {
        const std::size_t next = (at + 1) % count;
        if (offset(next) < 0 || offset(next) > 5) break;
        joined.push_back(next);
    }
    for (std::size_t at = nearest; is_joined((at + count - 1) % count) && joined.size() < count;
         at = (at + count - 1) % count) {
        const std::size_t next = (at + count - 1) % count;
        if (offset(next) > 0 || offset(next) < -5) break;
        joined.push_back(next);
    }
    std::vector<double> weights;
    if (by_pattern) {
        const double width_deg = std::max(setting_.beam_width_deg, spacing_deg_);
        for (const std::size_t at : joined)
            weights.push_back(oracle_pattern(offset(at), width_deg));
    } else {
        double other_deg = 1e9;
        for (const std::size_t at : joined) {
            const bool other_side = at != nearest && (offset(at) > 0) != (offset(nearest) > 0);
            if (other_side) other_deg = std::min(other_deg, std::abs(offset(at)));
        }
        const double near_deg = std::abs(offset(nearest));
        for (const std::size_t at : joined) {
            const bool is_other = at != nearest && std::abs(offset(at)) == other_deg &&
                                  (offset(at) > 0) != (offset(nearest) > 0);
            const double whole = other_deg < 1e9 ? near_deg + other_deg : 1;
            weights.push_back(at == nearest ? (other_deg < 1e9 ? other_deg / whole : 1)
                              : is_other    ? near_deg / whole
                                            : 0);
        }
    }
    double total = 0;
    for (const double weight : weights)
        total += weight;
    if (!(total > 0)) {
        weights[0] = total = 1;
    }
    for (std::size_t i = 0; i < joined.size(); ++i) {
        if (weights[i] > 0) {
            add_along(radials_[joined[i]], range_m, weights[i] / total, true, gates, doubtful);
        }
    }
}

std::vector<WeightedGate> OracleSweep::point(double azimuth_deg, double range_m,
                                             bool& doubtful) const {
    const int at = nearest(azimuth_deg, doubtful);
    if (at < 0) return {WeightedGate{}};
    const auto place = static_cast<std::size_t>(at);
    std::vector<WeightedGate> gates;
    if (facts_of(setting_.method.interpolation).takes_one_gate) {
        add_along(radials_[place], range_m, 1, false, gates, doubtful);
    } else {
        add_radials(azimuth_deg, place, range_m, gates, doubtful);
    }
    return gates;
}

double OracleSweep::seen_share(double azimuth_deg, double near_deg) const {
    constexpr int steps = 2000;
    int seen = 0;
    bool ignored = false;
    for (int i = 0; i < steps; ++i) {
        const double offset_deg = near_deg * ((i + 0.5) / steps * 2 - 1);
        if (nearest(full_turn_to(0, azimuth_deg + offset_deg), ignored) >= 0) ++seen;
    }
    return static_cast<double>(seen) / steps;
}

std::vector<WeightedGate> OracleSweep::inside(const Inside& is_inside, double azimuth_deg,
                                              double near_deg, double nearest_m,
                                              double farthest_m) const {
    std::vector<WeightedGate> gates;
    for (const Radial& radial : radials_) {
        const bool is_near = std::abs(turn_to(azimuth_deg, radial.azimuth_deg)) <= near_deg;
        if (!is_near || radial.kind == nullptr) continue;
        const level2::SweepMoment& kind = *radial.kind;
        const auto number = [&](double range_m) {
            return (range_m - kind.first_gate_m) / kind.gate_spacing_m;
        };
        const auto first = static_cast<std::int32_t>(std::floor(number(nearest_m)));
        const auto last = static_cast<std::int32_t>(std::ceil(number(farthest_m)));
        for (std::int32_t at = std::max(0, first); at <= last; ++at) {
            if (kind.range_m(at) < 0 || !is_inside(radial.azimuth_deg, kind.range_m(at))) continue;
            gates.push_back(gate(radial, at, 1));
        }
    }
    if (gates.empty()) return gates;
    const double share = near_deg < 180 ? seen_share(azimuth_deg, near_deg) : 1;
    for (WeightedGate& gate : gates)
        gate.weight = share / static_cast<double>(gates.size());
    if (share < 1) gates.push_back({CellStatus::not_seen, 0, 0, 0, 1 - share});
    return gates;
}

}  // namespace stormcellar::grid
