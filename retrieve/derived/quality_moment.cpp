#include "retrieve/derived/quality_moment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
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
            // A gate with echo of unknown probability has no value in POW; flags stay.
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

// Returns the least probability that is not below `least` when it is rounded.
float least_kept(float least) {
    // The bits of floats from 0 on have the order of their values.
    auto low = std::bit_cast<std::uint32_t>(0.0F), high = std::bit_cast<std::uint32_t>(2.0F);
    while (low < high) {
        const std::uint32_t middle = low + (high - low) / 2;
        if (rounded(std::bit_cast<float>(middle)) < least)
            low = middle + 1;
        else
            high = middle;
    }
    return std::bit_cast<float>(low);
}

// The gates from `begin` to `end` - 1 of a moment are at gates of the judged moment.
struct JudgedGates {
    std::size_t begin = 0, end = 0;
    std::vector<std::size_t> gates;  // by gate - begin
    bool follow_each_other = true;
};

JudgedGates judged_gates(const SweepMoment& moment, const SweepMoment& judged) {
    JudgedGates found;
    for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
        const auto there =
            std::llround((moment.range_m(gate) - judged.first_gate_m) / judged.gate_spacing_m);
        if (there < 0 || there >= judged.gate_stride) continue;
        if (found.gates.empty()) found.begin = static_cast<std::size_t>(gate);
        found.gates.push_back(static_cast<std::size_t>(there));
        found.follow_each_other = found.follow_each_other &&
                                  found.gates.back() == found.gates[0] + found.gates.size() - 1;
    }
    found.end = found.begin + found.gates.size();
    return found;
}

// Removes the gates of one sweep whose probability is too low.
class WeatherKeeper {
  public:
    // `judged` is the moment that has the probabilities. `radials` has, for each radial of the
    // sweep, the number of the radial of `judged`, or -1.
    WeatherKeeper(const SweepMoment& judged, std::span<const float> probabilities, float kept,
                  const std::vector<std::int32_t>& radials)
        : judged_(judged), radials_(radials), is_low_(probabilities.size()) {
        for (std::size_t at = 0; at < is_low_.size(); ++at)
            is_low_[at] = probabilities[at] < kept ? 1 : 0;  // false for NaN
    }

    void keep_in(SweepMoment& moment) const {
        for_each_row(moment, [&](auto* codes, std::size_t, const std::uint8_t* is_low,
                                 const JudgedGates& gates, std::size_t end) {
            const std::uint16_t first_valid = level2::facts_of(moment.moment).first_valid_code;
            if (gates.follow_each_other) {
                const std::uint8_t* low = is_low + gates.gates.at(0);
                keep_row(codes + gates.begin, end - gates.begin, first_valid,
                         [low](std::size_t i) { return low[i]; });
            } else {
                keep_row(codes + gates.begin, end - gates.begin, first_valid,
                         [&](std::size_t i) { return is_low[gates.gates[i]]; });
            }
        });
    }
    // Counts the gates of a reflectivity moment; `kinds` are those of the judged moment, or empty.
    void count(SweepMoment& moment, std::span<const EchoKind> kinds, LeftOutEcho& left_out) const {
        for_each_row(moment, [&](auto* codes, std::size_t row, const std::uint8_t* is_low,
                                 const JudgedGates& gates, std::size_t end) {
            const std::uint16_t first_valid = level2::facts_of(moment.moment).first_valid_code;
            for (std::size_t gate = gates.begin; gate < end; ++gate) {
                if (codes[gate] < first_valid) continue;
                ++left_out.echo;
                const std::size_t there = gates.gates[gate - gates.begin];
                if (is_low[there] == 0) continue;
                ++left_out.left_out;
                if (!kinds.empty())
                    ++left_out.of_kind[static_cast<std::size_t>(kinds[row + there])];
            }
        });
    }

  private:
    template <class Code, class IsLow>
    static void keep_row(Code* codes, std::size_t count, std::uint16_t first_valid, IsLow is_low) {
        // Compilers vectorize this loop, because it has no branch.
        for (std::size_t i = 0; i < count; ++i) {
            const Code code = codes[i], kept = is_low(i) != 0 ? Code{0} : code;
            codes[i] = code >= first_valid ? kept : code;
        }
    }
    template <class Visit>
    void for_each_row(SweepMoment& moment, Visit visit) const {
        if (moment.gate_spacing_m <= 0) return;
        const JudgedGates gates = judged_gates(moment, judged_);
        for (std::size_t radial = 0; radial < moment.gate_counts.size(); ++radial) {
            if (radials_[radial] < 0) continue;
            const std::size_t row = static_cast<std::size_t>(radials_[radial]) *
                                    static_cast<std::size_t>(judged_.gate_stride);
            const std::size_t own = radial * static_cast<std::size_t>(moment.gate_stride);
            const std::size_t end = std::min<std::size_t>(gates.end, moment.gate_counts[radial]);
            if (end <= gates.begin) continue;
            if (moment.word_size_bits == 8)
                visit(moment.codes8.data() + own, row, is_low_.data() + row, gates, end);
            else
                visit(moment.codes16.data() + own, row, is_low_.data() + row, gates, end);
        }
    }

    const SweepMoment& judged_;
    const std::vector<std::int32_t>& radials_;
    std::vector<std::uint8_t> is_low_;
};

// Returns the sweep from which a sweep takes its probabilities. A sweep with reflectivity takes its
// own.
std::optional<std::size_t> judged_sweep(const level2::Volume& volume, std::size_t number) {
    return companion_sweep(volume, number, volume.sweeps[number].mean_elevation_deg(), Moment::ref);
}

// Removes gates of a sweep by the probabilities of the sweep that judged_sweep() gave. `kinds` is
// null or has the kinds of the same moment.
LeftOutEcho keep_weather_in(level2::Volume& volume, std::size_t number, const SweepQuality& quality,
                            const SweepKinds* kinds, double least) {
    level2::Sweep& sweep = volume.sweeps[number];
    const level2::Sweep& from = volume.sweeps[quality.sweep];
    std::vector<std::int32_t> radials(sweep.radials.size());
    if (quality.sweep == number)
        std::iota(radials.begin(), radials.end(), 0);
    else
        radials = nearest_radials(azimuths_of(sweep), from);
    const WeatherKeeper keeper(from.moments[quality.moment], quality.probabilities,
                               least_kept(static_cast<float>(least)), radials);
    std::span<const EchoKind> named;
    if (kinds != nullptr) named = kinds->kinds;
    LeftOutEcho left_out;
    for (SweepMoment& moment : sweep.moments) {
        if (moment.moment == Moment::ref) keeper.count(moment, named, left_out);
        keeper.keep_in(moment);
    }
    return left_out;
}

}  // namespace

LeftOutEcho& LeftOutEcho::operator+=(const LeftOutEcho& other) {
    echo += other.echo;
    left_out += other.left_out;
    for (std::size_t i = 0; i < of_kind.size(); ++i)
        of_kind[i] += other.of_kind[i];
    return *this;
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
    const std::vector<SweepQuality> qualities = weather_probabilities(volume);
    const std::vector<SweepKinds> kinds = echo_kinds(volume, qualities, least);
    LeftOutEcho left_out;
    for (std::size_t number = 0; number < volume.sweeps.size(); ++number) {
        const auto judged = judged_sweep(volume, number);
        if (!judged) continue;
        const auto quality = std::ranges::find(qualities, *judged, &SweepQuality::sweep);
        if (quality == qualities.end()) continue;
        const auto named = std::ranges::find_if(kinds, [&](const SweepKinds& of) {
            return of.sweep == quality->sweep && of.moment == quality->moment;
        });
        left_out += keep_weather_in(volume, number, *quality,
                                    named != kinds.end() ? &*named : nullptr, least);
    }
    return left_out;
}

LeftOutEcho keep_weather(level2::Sweep& sweep, std::span<const level2::Sweep> others,
                         double least) {
    level2::Volume volume;
    volume.sweeps.assign(others.begin(), others.end());
    volume.sweeps.push_back(std::move(sweep));
    LeftOutEcho left_out;
    if (const auto judged = judged_sweep(volume, others.size())) {
        const auto qualities = weather_probabilities_of(volume, *judged);
        if (!qualities.empty())
            left_out = keep_weather_in(volume, others.size(), qualities.front(), nullptr, least);
    }
    sweep = std::move(volume.sweeps.back());
    return left_out;
}

}  // namespace stormcellar::retrieve
