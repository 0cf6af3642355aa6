#include "export/uf_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace stormcellar::netcdf {
namespace {

using level2::GateStatus;
using level2::SweepMoment;

constexpr double largest_word = 32767;
constexpr int usual_factor = 100;
constexpr int most_factor = 1000;

double exact_value(const SweepMoment& moment, int code) {
    if (moment.scale == 0) return code;
    return (code - static_cast<double>(moment.offset)) / static_cast<double>(moment.scale);
}

bool is_whole(double number) {
    return std::abs(number - std::round(number)) < 1e-6;
}

// Returns true if the factor makes a whole number of each value of these gates.
bool is_exact(const SweepMoment& moment, int factor) {
    return is_whole(exact_value(moment, 0) * factor) && is_whole(exact_value(moment, 1) * factor);
}

// Returns the largest code that is a value: for wide codes the largest code of the gates, else 255.
int largest_code(const SweepMoment& moment) {
    if (moment.word_size_bits == 8) return 255;
    int largest = 0;
    for (std::size_t radial = 0; radial < moment.gate_counts.size(); ++radial) {
        for (std::int32_t gate = 0; gate < moment.gate_counts[radial]; ++gate)
            largest = std::max<int>(largest, moment.code(radial, gate));
    }
    return largest;
}

// Returns the largest absolute value of the moment, and of the Nyquist velocity for velocities;
// infinity if a value is not finite.
double largest_value(std::span<const level2::Sweep> sweeps,
                     const std::vector<const SweepMoment*>& moments) {
    const level2::MomentFacts& facts = level2::facts_of(moments.front()->moment);
    double largest = 0;
    for (const SweepMoment* moment : moments) {
        for (const int code : {static_cast<int>(facts.first_valid_code), largest_code(*moment)}) {
            const double value = std::abs(exact_value(*moment, code));
            if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
            largest = std::max(largest, value);
        }
    }
    if (!facts.is_doppler) return largest;
    for (const level2::Sweep& sweep : sweeps) {
        for (const level2::Radial& radial : sweep.radials)
            largest = std::max(largest, static_cast<double>(radial.nyquist_mps));
    }
    return largest;
}

}  // namespace

Result<int> uf_factor(std::span<const level2::Sweep> sweeps, level2::Moment name) {
    std::vector<const SweepMoment*> moments;
    for (const level2::Sweep& sweep : sweeps) {
        for (const SweepMoment& moment : sweep.moments)
            if (moment.moment == name) moments.push_back(&moment);
    }
    if (moments.empty()) return 1;
    const double largest = largest_value(sweeps, moments);
    if (largest > largest_word) {
        return fail(ErrorCode::unsupported,
                    "{} has values to {:.3g}, which UF cannot hold in 16 bits",
                    level2::moment_name(name), largest);
    }
    const auto fits = [&](int factor) { return largest * factor <= largest_word; };
    int factor = 1;
    const auto is_exact_for_all = [&] {
        return std::all_of(moments.begin(), moments.end(),
                           [&](const SweepMoment* moment) { return is_exact(*moment, factor); });
    };
    while (factor <= most_factor && !is_exact_for_all())
        ++factor;
    if (factor <= most_factor && usual_factor % factor == 0 && fits(usual_factor))
        return usual_factor;
    if (factor <= most_factor && fits(factor)) return factor;
    return static_cast<int>(std::min<double>(most_factor, largest_word / std::max(largest, 1.0)));
}

std::vector<std::int16_t> uf_words(const SweepMoment& moment, int factor) {
    const int count = moment.word_size_bits == 8 ? 256 : 65536;
    std::vector<std::int16_t> words;
    words.reserve(static_cast<std::size_t>(count));
    for (int code = 0; code < count; ++code) {
        const auto status = level2::status_of_code(moment.moment, static_cast<std::uint16_t>(code));
        const double word = std::round(exact_value(moment, code) * factor);
        // Codes that no gate has may be beyond the words.
        const bool is_value = status == GateStatus::valid && std::abs(word) <= largest_word;
        words.push_back(is_value ? static_cast<std::int16_t>(word) : uf_missing);
    }
    return words;
}

}  // namespace stormcellar::netcdf
