#include "retrieve/derived/quality_moment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "retrieve/sweeps/nearest_sweep.h"
#include "stormcellar/retrieve/quality.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr float steps = 250;
constexpr float code_of_zero = 3;

// Returns the probability in whole steps, as POW has it, so that a picture of POW and a volume
// without other echo agree.
float rounded(float probability) {
    return std::round(probability * steps) / steps;
}

SweepMoment quality_moment(const SweepMoment& reflectivity, const SweepQuality& quality) {
    SweepMoment made = reflectivity;
    made.moment = Moment::pow;
    made.word_size_bits = 8;
    made.scale = steps;
    made.offset = code_of_zero;
    made.codes16.clear();
    made.codes8.resize(quality.probabilities.size());
    for (std::size_t radial = 0; radial < made.gate_counts.size(); ++radial)
        for (std::int32_t gate = 0; gate < made.gate_counts[radial]; ++gate) {
            const std::size_t at = radial * static_cast<std::size_t>(made.gate_stride) +
                                   static_cast<std::size_t>(gate);
            const float probability = quality.probabilities[at];
            // Echo whose probability is unknown is no measurement of POW; flags stay.
            const std::uint16_t flag = reflectivity.code(radial, gate) < 2
                                           ? reflectivity.code(radial, gate)
                                           : std::uint16_t{2};
            made.codes8[at] = static_cast<std::uint8_t>(
                std::isnan(probability) ? static_cast<long>(flag)
                                        : std::lrint(probability * steps + code_of_zero));
        }
    return made;
}

// Returns for example ": birds and insects 8.1 %, ground clutter 3.0 %"; empty if no echo was
// removed.
std::string largest_kinds(const LeftOutEcho& left_out) {
    constexpr std::size_t most_kinds = 2;
    std::vector<std::pair<std::int64_t, EchoKind>> kinds;
    for (std::size_t i = 0; i < echo_kind_count; ++i)
        if (left_out.of_kind[i] > 0)
            kinds.emplace_back(left_out.of_kind[i], static_cast<EchoKind>(i));
    std::ranges::stable_sort(kinds, std::greater{}, &std::pair<std::int64_t, EchoKind>::first);
    std::string text;
    for (const auto& [gates, kind] : std::span(kinds).first(std::min(kinds.size(), most_kinds)))
        text += fmt::format("{} {} {:.1f} %", text.empty() ? ":" : ",", echo_kind_name(kind),
                            left_out.percent(gates));
    return text;
}

// Removes gates of one moment after another.
class WeatherKeeper {
  public:
    WeatherKeeper(level2::Volume& volume, double least)
        : volume_(volume),
          qualities_(weather_probabilities(volume)),
          kinds_(echo_kinds(volume, qualities_, least)),
          least_(static_cast<float>(least)) {}

    // Removes gates of one sweep.
    void keep_in(std::size_t number) {
        level2::Sweep& sweep = volume_.sweeps[number];
        const auto companion =
            companion_sweep(volume_, number, sweep.mean_elevation_deg(), Moment::ref);
        const SweepQuality* quality = companion ? quality_of(*companion) : nullptr;
        if (quality == nullptr) return;
        const level2::Sweep& from = volume_.sweeps[*companion];
        std::vector<std::int32_t> radials(sweep.radials.size());
        if (*companion == number)
            std::iota(radials.begin(), radials.end(), 0);
        else
            radials = nearest_radials(azimuths_of(sweep), from);
        for (SweepMoment& moment : sweep.moments)
            keep_gates(moment, from.moments[quality->moment], *quality, radials);
    }
    [[nodiscard]] const LeftOutEcho& left_out() const { return left_out_; }

  private:
    [[nodiscard]] const SweepQuality* quality_of(std::size_t sweep) const {
        const auto found = std::ranges::find(qualities_, sweep, &SweepQuality::sweep);
        return found != qualities_.end() ? &*found : nullptr;
    }
    // Returns the kinds of the moment that was judged.
    [[nodiscard]] const SweepKinds& kinds_of(const SweepQuality& quality) const {
        return *std::ranges::find_if(kinds_, [&](const SweepKinds& of) {
            return of.sweep == quality.sweep && of.moment == quality.moment;
        });
    }
    void keep_gates(SweepMoment& moment, const SweepMoment& judged, const SweepQuality& quality,
                    const std::vector<std::int32_t>& radials) {
        if (moment.gate_spacing_m <= 0) return;
        std::vector<std::int64_t> gates(static_cast<std::size_t>(moment.gate_stride));
        for (std::size_t gate = 0; gate < gates.size(); ++gate)
            gates[gate] = std::llround(
                (moment.range_m(static_cast<std::int32_t>(gate)) - judged.first_gate_m) /
                judged.gate_spacing_m);
        const std::uint16_t first_valid = level2::facts_of(moment.moment).first_valid_code;
        const std::vector<EchoKind>& kinds = kinds_of(quality).kinds;
        for (std::size_t radial = 0; radial < moment.gate_counts.size(); ++radial) {
            if (radials[radial] < 0) continue;
            const auto stride = static_cast<std::size_t>(judged.gate_stride);
            const std::size_t row = static_cast<std::size_t>(radials[radial]) * stride;
            for (std::size_t gate = 0; gate < moment.gate_counts[radial]; ++gate) {
                const std::int64_t there = gates[gate];
                if (there < 0 || there >= judged.gate_stride) continue;
                const std::size_t at = radial * static_cast<std::size_t>(moment.gate_stride) + gate;
                const bool is_echo =
                    moment.code(radial, static_cast<std::int32_t>(gate)) >= first_valid;
                if (!is_echo) continue;
                const std::size_t judged_at = row + static_cast<std::size_t>(there);
                const float probability = quality.probabilities[judged_at];
                const bool is_removed = !std::isnan(probability) && rounded(probability) < least_;
                if (moment.moment == Moment::ref) {
                    ++left_out_.echo;
                    if (is_removed) left_out_.count(kinds[judged_at]);
                }
                if (!is_removed) continue;
                if (moment.word_size_bits == 8)
                    moment.codes8[at] = 0;
                else
                    moment.codes16[at] = 0;
            }
        }
    }

    level2::Volume& volume_;
    std::vector<SweepQuality> qualities_;
    std::vector<SweepKinds> kinds_;
    float least_;
    LeftOutEcho left_out_;
};

}  // namespace

LeftOutEcho& LeftOutEcho::operator+=(const LeftOutEcho& other) {
    echo += other.echo;
    left_out += other.left_out;
    for (std::size_t i = 0; i < of_kind.size(); ++i)
        of_kind[i] += other.of_kind[i];
    return *this;
}

void LeftOutEcho::count(EchoKind kind) {
    ++left_out;
    ++of_kind[static_cast<std::size_t>(kind)];
}

double LeftOutEcho::percent(std::int64_t gates) const {
    return echo > 0 ? 100 * static_cast<double>(gates) / static_cast<double>(echo) : 0;
}

void add_quality_moment(level2::Volume& volume) {
    for (SweepQuality& quality : weather_probabilities(volume)) {
        level2::Sweep& sweep = volume.sweeps[quality.sweep];
        SweepMoment made = quality_moment(sweep.moments[quality.moment], quality);
        sweep.moments.push_back(std::move(made));
    }
}

std::string weather_note(double least, const LeftOutEcho& left_out) {
    std::string note = fmt::format("{}{:g}", quality_words, least);
    if (left_out.echo == 0) return note;
    return note + fmt::format("; {:.1f} % of the echo left out{}",
                              left_out.percent(left_out.left_out), largest_kinds(left_out));
}

LeftOutEcho keep_weather(level2::Volume& volume, double least) {
    WeatherKeeper keeper(volume, least);
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep)
        keeper.keep_in(sweep);
    return keeper.left_out();
}

LeftOutEcho keep_weather(level2::Sweep& sweep, std::span<const level2::Sweep> others,
                         double least) {
    level2::Volume volume;
    volume.sweeps.assign(others.begin(), others.end());
    volume.sweeps.push_back(std::move(sweep));
    WeatherKeeper keeper(volume, least);
    keeper.keep_in(others.size());
    sweep = std::move(volume.sweeps.back());
    return keeper.left_out();
}

}  // namespace stormcellar::retrieve
