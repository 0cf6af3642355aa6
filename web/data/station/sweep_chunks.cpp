#include "web/data/station/sweep_chunks.h"

#include <algorithm>
#include <cmath>

#include "export/zarr_chunks.h"

namespace stormcellar::web {
namespace {

constexpr double farthest_of_spacing = 0.75;

// Makes a chunk of result_of(code) for each gate, and `nothing` where there is no gate.
template <class Value, class ResultOf>
std::optional<std::string> gates_chunk(const level2::Sweep& sweep, const SweepPlace& place,
                                       const PlacedMoment& moment, Value nothing,
                                       ResultOf result_of) {
    const level2::SweepMoment* const array = sweep.find(moment.moment);
    if (array == nullptr) return std::nullopt;
    const GateAxis& axis = place.axis_of(moment);
    const auto repeats =
        static_cast<std::size_t>(repeats_on(*array, axis.first_gate_m, axis.gate_spacing_m));
    if (repeats == 0) return std::nullopt;
    // Each code has one result, so compute it once.
    std::vector<Value> results(array->word_size_bits == 8 ? 256 : 65'536);
    for (std::size_t code = 0; code < results.size(); ++code)
        results[code] = result_of(static_cast<std::uint16_t>(code));
    const std::vector<int> radials = radials_of(sweep, place);
    std::vector<Value> gates(radials.size() * axis.gates, nothing);
    for (std::size_t row = 0; row < radials.size(); ++row) {
        if (radials[row] < 0) continue;
        const auto radial = static_cast<std::size_t>(radials[row]);
        Value* out = gates.data() + row * axis.gates;
        const std::size_t count =
            std::min<std::size_t>(array->gate_counts[radial], axis.gates / repeats);
        for (std::size_t gate = 0; gate < count; ++gate)
            out = std::fill_n(out, repeats,
                              results[array->code(radial, static_cast<std::int32_t>(gate))]);
    }
    return zarr::bytes_of(gates);
}

template <class Value, class FactOf>
std::string radials_chunk(const level2::Sweep& sweep, const SweepPlace& place, Value nothing,
                          FactOf fact_of) {
    std::vector<Value> facts;
    for (const int radial : radials_of(sweep, place))
        facts.push_back(radial < 0 ? nothing
                                   : fact_of(sweep.radials[static_cast<std::size_t>(radial)]));
    return zarr::bytes_of(facts);
}

}  // namespace

std::vector<double> azimuths_of(const SweepPlace& place) {
    std::vector<double> azimuths;
    for (std::size_t i = 0; i < place.azimuths(); ++i)
        azimuths.push_back((static_cast<double>(i) + 0.5) * place.kind.azimuth_spacing_deg);
    return azimuths;
}

std::vector<int> radials_of(const level2::Sweep& sweep, const SweepPlace& place) {
    struct Around {
        double azimuth_deg = 0;
        int radial = 0;
    };
    // Sort the radials by azimuth. Repeat the last one before the first and the first one behind
    // the last, so that each azimuth of the axis has a neighbor on both sides.
    std::vector<Around> around;
    for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
        double azimuth_deg = std::fmod(double{sweep.radials[i].azimuth_deg}, 360);
        if (azimuth_deg < 0) azimuth_deg += 360;
        around.push_back({azimuth_deg, static_cast<int>(i)});
    }
    std::ranges::stable_sort(around, {}, &Around::azimuth_deg);
    if (around.empty()) return std::vector<int>(place.azimuths(), -1);
    const Around first = around.front(), last = around.back();
    around.insert(around.begin(), {last.azimuth_deg - 360, last.radial});
    around.push_back({first.azimuth_deg + 360, first.radial});

    const double farthest_deg = farthest_of_spacing * place.kind.azimuth_spacing_deg;
    std::vector<int> radials;
    for (const double azimuth_deg : azimuths_of(place)) {
        auto after = std::ranges::lower_bound(around, azimuth_deg, {}, &Around::azimuth_deg);
        after = std::clamp(after, around.begin() + 1, around.end() - 1);
        const auto before = after - 1;
        const bool is_before =
            azimuth_deg - before->azimuth_deg <= after->azimuth_deg - azimuth_deg;
        const Around& nearest = is_before ? *before : *after;
        const bool is_near = std::abs(nearest.azimuth_deg - azimuth_deg) <= farthest_deg;
        radials.push_back(is_near ? nearest.radial : -1);
    }
    return radials;
}

std::optional<std::string> sweep_values(const level2::Sweep& sweep, const SweepPlace& place,
                                        const PlacedMoment& moment) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    const level2::SweepMoment* const array = sweep.find(moment.moment);
    return gates_chunk(sweep, place, moment, none, [array](std::uint16_t code) {
        const bool is_valid =
            level2::status_of_code(array->moment, code) == level2::GateStatus::valid;
        return is_valid ? array->value_of(code) : none;
    });
}

std::optional<std::string> sweep_states(const level2::Sweep& sweep, const SweepPlace& place,
                                        const PlacedMoment& moment) {
    return gates_chunk(
        sweep, place, moment, static_cast<std::uint8_t>(level2::GateStatus::no_data),
        [&](std::uint16_t code) {
            return static_cast<std::uint8_t>(level2::status_of_code(moment.moment, code));
        });
}

std::string radial_facts(const level2::Sweep& sweep, const SweepPlace& place, RadialFact fact) {
    if (fact == RadialFact::time) {
        return radials_chunk(sweep, place, no_time_ms, [](const level2::Radial& radial) {
            return std::int64_t{radial.time.time_since_epoch().count()};
        });
    }
    return radials_chunk(sweep, place, std::numeric_limits<float>::quiet_NaN(),
                         [fact](const level2::Radial& radial) {
                             if (fact == RadialFact::azimuth) return radial.azimuth_deg;
                             return fact == RadialFact::elevation ? radial.elevation_deg
                                                                  : radial.nyquist_mps;
                         });
}

}  // namespace stormcellar::web
