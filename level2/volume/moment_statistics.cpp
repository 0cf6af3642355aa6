#include "stormcellar/level2/moment_statistics.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "base/checksum.h"

namespace stormcellar::level2 {
namespace {

// Counts of each code in one SweepMoment.
using Histogram = std::vector<std::uint64_t>;

void count_codes(const SweepMoment& moment, std::size_t radial, Histogram& histogram) {
    const std::size_t row = radial * static_cast<std::size_t>(moment.gate_stride);
    const std::size_t gates = moment.gate_counts[radial];
    if (moment.word_size_bits == 8) {
        for (std::size_t gate = 0; gate < gates; ++gate)
            ++histogram[moment.codes8[row + gate]];
    } else {
        for (std::size_t gate = 0; gate < gates; ++gate)
            ++histogram[moment.codes16[row + gate]];
    }
}

std::uint32_t continue_crc(const SweepMoment& moment, std::size_t radial, std::uint32_t crc) {
    const std::size_t row = radial * static_cast<std::size_t>(moment.gate_stride);
    const std::size_t gates = moment.gate_counts[radial];
    if (moment.word_size_bits == 8) {
        return crc32(std::as_bytes(std::span{moment.codes8}.subspan(row, gates)), crc);
    }
    std::vector<std::byte> big_endian;
    big_endian.reserve(2 * gates);
    for (const std::uint16_t code : std::span{moment.codes16}.subspan(row, gates)) {
        big_endian.push_back(static_cast<std::byte>(code >> 8));
        big_endian.push_back(static_cast<std::byte>(code & 0xFFU));
    }
    return crc32(big_endian, crc);
}

bool has_radial(const SweepMoment& moment, std::size_t radial) {
    return radial < moment.gate_counts.size() && moment.gate_counts[radial] > 0;
}

void note_kind(MomentStatistics& statistics, const SweepMoment& kind) {
    if (statistics.first == nullptr) statistics.first = &kind;
    const SweepMoment& first = *statistics.first;
    if (kind.first_gate_m != first.first_gate_m || kind.gate_spacing_m != first.gate_spacing_m) {
        statistics.geometry_constant = false;
    }
    if (kind.scale != first.scale || kind.offset != first.offset ||
        kind.word_size_bits != first.word_size_bits) {
        statistics.scale_constant = false;
    }
}

// Adds the counts of one SweepMoment to the statistics, and returns the sum of its valid values.
double add_histogram(MomentStatistics& statistics, const SweepMoment& kind,
                     const Histogram& histogram) {
    const std::size_t first_valid = facts_of(kind.moment).first_valid_code;
    double sum = 0;
    for (std::size_t code = 0; code < histogram.size(); ++code) {
        const std::uint64_t count = histogram[code];
        if (count == 0) continue;
        statistics.codes += count;
        if (code == 0) statistics.code_0 += count;
        if (code == 1) statistics.code_1 += count;
        if (code >= 2 && code < 8) statistics.code_2_to_7 += count;
        if (code < first_valid) continue;
        const auto number = static_cast<double>(code);
        const double value = kind.scale == 0 ? number
                                             : (number - static_cast<double>(kind.offset)) /
                                                   static_cast<double>(kind.scale);
        statistics.valid += count;
        statistics.min = std::min(statistics.min.value_or(value), value);
        statistics.max = std::max(statistics.max.value_or(value), value);
        sum += value * static_cast<double>(count);
    }
    return sum;
}

}  // namespace

std::optional<MomentStatistics> moment_statistics(const Sweep& sweep, Moment moment) {
    std::vector<const SweepMoment*> kinds;
    for (const SweepMoment& kind : sweep.moments) {
        if (kind.moment == moment) kinds.push_back(&kind);
    }
    MomentStatistics statistics;
    statistics.gates_min = std::numeric_limits<std::uint16_t>::max();
    std::vector<Histogram> histograms;
    histograms.reserve(kinds.size());
    for (const SweepMoment* kind : kinds)
        histograms.emplace_back(kind->word_size_bits == 8 ? 256 : 65536);
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            if (!has_radial(*kinds[k], radial)) continue;
            const std::uint16_t gates = kinds[k]->gate_counts[radial];
            note_kind(statistics, *kinds[k]);
            if (statistics.radials++ == 0) statistics.gates_first = gates;
            statistics.gates_min = std::min(statistics.gates_min, gates);
            statistics.gates_max = std::max(statistics.gates_max, gates);
            statistics.crc32 = continue_crc(*kinds[k], radial, statistics.crc32);
            count_codes(*kinds[k], radial, histograms[k]);
        }
    }
    if (statistics.radials == 0) return std::nullopt;
    double sum = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k)
        sum += add_histogram(statistics, *kinds[k], histograms[k]);
    if (statistics.valid > 0) statistics.mean = sum / static_cast<double>(statistics.valid);
    return statistics;
}

}  // namespace stormcellar::level2
