#include "stormcellar/grid/sweep_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "grid/sweep/polar_sweep.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::grid {
namespace {

constexpr double farthest_place_m = 1e6;  // no radar sees farther; bounds the size of tables

// Returns the numbers of the sweeps that hold the moment, as a text for a message.
std::string numbers_of_sweeps(const level2::Volume& volume, level2::Moment moment) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
        if (volume.sweeps[i].find(moment) != nullptr) numbers.push_back(i);
    }
    return fmt::format("{}", fmt::join(numbers, ", "));
}

Result<ChosenSweep> wanted_sweep(const level2::Volume& volume, level2::Moment moment,
                                 double half_beam_deg, const SweepWish& wish) {
    if (wish.number) {
        auto chosen = sweep_by_number(volume, *wish.number, moment, half_beam_deg);
        if (chosen) return std::move(*chosen);
        const std::string missing =
            *wish.number < volume.sweeps.size()
                ? fmt::format("sweep {} holds no {}", *wish.number, level2::moment_name(moment))
                : fmt::format("there is no sweep {}", *wish.number);
        return fail(ErrorCode::not_found, "{}; the sweeps with {} are {}", missing,
                    level2::moment_name(moment), numbers_of_sweeps(volume, moment));
    }
    auto sweeps = choose_sweeps(volume, moment, half_beam_deg, wish.nearest_to);
    if (sweeps.empty()) {
        return fail(ErrorCode::not_found, "no sweep holds {}", level2::moment_name(moment));
    }
    if (!wish.elevation_deg) return std::move(sweeps.front());
    const auto off_deg = [&](const ChosenSweep& sweep) {
        return std::abs(sweep.fixed_angle_deg - *wish.elevation_deg);
    };
    const auto nearest = std::ranges::min_element(sweeps, {}, off_deg);
    if (off_deg(*nearest) <= SweepWish::farthest_deg) return std::move(*nearest);
    std::vector<std::string> angles;
    for (const ChosenSweep& sweep : sweeps)
        angles.push_back(fmt::format("{:.1f}", sweep.fixed_angle_deg));
    return fail(ErrorCode::not_found,
                "no sweep with {} is within {:g} degree of {:g} degrees; the sweeps with it have "
                "elevations of {} degrees",
                level2::moment_name(moment), SweepWish::farthest_deg, *wish.elevation_deg,
                fmt::join(angles, ", "));
}

// Notes the first and the last time of the radials.
void note_times(const level2::Sweep& sweep, const ChosenSweep& chosen, SweepFacts& facts) {
    bool is_first = true;
    for (const std::uint32_t radial : chosen.radials) {
        const UtcTime time = sweep.radials[radial].time;
        if (!level2::is_plausible(time)) continue;
        facts.start = is_first ? time : std::min(facts.start, time);
        facts.end = is_first ? time : std::max(facts.end, time);
        is_first = false;
    }
}

}  // namespace

struct SweepLookup::Prepared {
    std::shared_ptr<const level2::Volume> volume;
    SitePosition site;
    level2::Moment moment;
    ChosenSweep chosen;
    SweepFacts facts;
    BeamGeometry beam;
    PolarSweep polar;
    float end_m;  // where the tables end

    [[nodiscard]] const level2::Sweep& sweep() const { return volume->sweeps[chosen.sweep_index]; }
};

SweepLookup::SweepLookup(std::unique_ptr<const Prepared> prepared)
    : prepared_(std::move(prepared)) {}
SweepLookup::SweepLookup(SweepLookup&&) noexcept = default;
SweepLookup& SweepLookup::operator=(SweepLookup&&) noexcept = default;
SweepLookup::~SweepLookup() = default;

Result<SweepLookup> SweepLookup::find(std::shared_ptr<const level2::Volume> volume,
                                      const SitePosition& site, level2::Moment moment,
                                      double half_beam_deg, const SweepWish& wish) {
    auto chosen = wanted_sweep(*volume, moment, half_beam_deg, wish);
    if (!chosen) return pass_on(chosen);
    const level2::Sweep& sweep = volume->sweeps[chosen->sweep_index];
    const BeamModel model = BeamModel::four_thirds(site.latitude_deg, site.altitude_m);
    const double reach_m =
        std::min(greatest_arc_m(sweep, *chosen, moment, model), farthest_place_m);

    SweepFacts facts;
    facts.number = chosen->sweep_index;
    facts.cut = sweep.elevation_number;
    facts.elevation_deg = chosen->elevation_deg;
    facts.fixed_angle_deg = chosen->fixed_angle_deg;
    facts.radial_count = chosen->radials.size();
    facts.nyquist_mps = sweep.radials[chosen->radials.front()].nyquist_mps;
    facts.greatest_arc_m = reach_m;
    facts.gate_spacing_m = std::numeric_limits<double>::infinity();
    for (const level2::SweepMoment& kind : sweep.moments) {
        if (kind.moment != moment || kind.gate_spacing_m <= 0) continue;
        facts.gate_spacing_m = std::min<double>(facts.gate_spacing_m, kind.gate_spacing_m);
        facts.last_gate_m =
            std::max(facts.last_gate_m, kind.range_m(kind.gate_stride) - 0.5 * kind.gate_spacing_m);
    }
    note_times(sweep, *chosen, facts);

    const std::size_t table_size = 3 + static_cast<std::size_t>(reach_m / ArcTable::step_m);
    const PolarSweepOptions options{
        .moment = moment, .half_beam_deg = half_beam_deg, .table_size = table_size};
    PolarSweep polar(sweep, *chosen, model, options);
    facts.azimuth_spacing_deg = static_cast<double>(polar.azimuths().spacing_deg());
    const auto end_m = static_cast<float>(ArcTable::step_m * static_cast<double>(table_size - 1));
    return SweepLookup(std::make_unique<const Prepared>(
        Prepared{std::move(volume), site, moment, std::move(*chosen), facts,
                 BeamGeometry(site.latitude_deg, site.altitude_m), std::move(polar), end_m}));
}

const SweepFacts& SweepLookup::facts() const {
    return prepared_->facts;
}

const SitePosition& SweepLookup::site() const {
    return prepared_->site;
}

level2::Moment SweepLookup::moment() const {
    return prepared_->moment;
}

GateValue SweepLookup::at(PolarPoint place) const {
    const auto arc_m = static_cast<float>(place.arc_m);
    if (!(arc_m >= 0 && arc_m < prepared_->end_m)) return {};
    const auto azimuth_deg = static_cast<float>(place.azimuth_deg);
    const Sample sample =
        prepared_->polar.sample(azimuth_deg < 360 ? azimuth_deg : 0.0F, ArcTable::place_of(arc_m));
    return {sample.status, sample.value};
}

std::optional<GatePosition> SweepLookup::position(PolarPoint place) const {
    const auto arc_m = static_cast<float>(place.arc_m);
    if (!(arc_m >= 0 && arc_m < prepared_->end_m)) return std::nullopt;
    const auto azimuth_deg = static_cast<float>(place.azimuth_deg);
    const PolarSweep& polar = prepared_->polar;
    const int at = polar.radial_at(azimuth_deg < 360 ? azimuth_deg : 0.0F);
    if (at == AzimuthTable::none) return std::nullopt;
    const level2::SweepMoment* moment = polar.gates().moment_of(at);
    if (moment == nullptr) return std::nullopt;
    const SweepGates::GatePlace gate = polar.gates().gate_place(at, ArcTable::place_of(arc_m));
    const float number = std::floor(gate.number_and_half);
    if (!(number >= static_cast<float>(gate.first) && number < static_cast<float>(gate.end))) {
        return std::nullopt;
    }
    GatePosition found;
    found.radial = polar.gates().radial_index(at);
    found.gate = static_cast<std::int32_t>(number);
    const level2::Radial& radial = prepared_->sweep().radials[found.radial];
    found.azimuth_deg = static_cast<double>(normal_azimuth(radial.azimuth_deg).value_or(0.0F));
    found.elevation_deg = static_cast<double>(radial.elevation_deg);
    found.range_m = moment->range_m(found.gate);
    found.height_m =
        prepared_->beam.forward({found.range_m, prepared_->facts.elevation_deg}).height_m;
    found.time = radial.time;
    return found;
}

std::vector<double> elevations_deg(const level2::Volume& volume, level2::Moment moment,
                                   double half_beam_deg) {
    std::vector<double> angles_deg;
    for (const ChosenSweep& sweep : choose_sweeps(volume, moment, half_beam_deg))
        angles_deg.push_back(sweep.fixed_angle_deg);
    return angles_deg;
}

}  // namespace stormcellar::grid
