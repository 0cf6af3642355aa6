#include "retrieve/quality/gate_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retrieve/quality/gate_loops.h"

namespace stormcellar::retrieve {
namespace {

// Returns true if the gap between the last and the first radial is no wider than two radials.
bool ends_meet(const level2::Sweep& sweep) {
    const std::size_t radials = sweep.radials.size();
    if (radials < 3) return false;
    const double gap =
        std::abs(std::remainder(static_cast<double>(sweep.radials.front().azimuth_deg) -
                                    static_cast<double>(sweep.radials.back().azimuth_deg),
                                360));
    return gap * static_cast<double>(radials) <= 2 * 360;
}

// Returns the number of codes up to the last code that is not 0.
std::size_t end_of_values(const std::uint16_t* codes, std::size_t gates) {
    // Skips empty blocks first, because compilers vectorize this loop.
    constexpr std::size_t block = 64;
    while (gates >= block) {
        std::uint16_t any = 0;
        for (std::size_t gate = gates - block; gate < gates; ++gate)
            any |= codes[gate];
        if (any != 0) break;
        gates -= block;
    }
    while (gates > 0 && codes[gates - 1] == 0)
        --gates;
    return gates;
}

}  // namespace

std::int32_t GateField::gate_at(double range_m) const {
    const double gate = std::round((range_m - first_gate_m) / gate_spacing_m);
    return gate >= 0 && gate < static_cast<double>(gates) ? static_cast<std::int32_t>(gate) : -1;
}

void read_gate_field(const level2::Sweep& sweep, const level2::SweepMoment& moment,
                     GateField& field) {
    field.codes.clear();
    field.ends.clear();
    if (moment.gate_spacing_m <= 0 || moment.gate_stride <= 0) return;
    field.radials = sweep.radials.size();
    field.gates = static_cast<std::size_t>(moment.gate_stride);
    field.first_gate_m = moment.first_gate_m;
    field.gate_spacing_m = moment.gate_spacing_m;
    field.scale = moment.scale != 0 ? moment.scale : 1;
    field.offset = moment.scale != 0 ? moment.offset : 0;
    field.is_circle = ends_meet(sweep);
    field.codes.resize(field.radials * field.gates);
    field.ends.resize(field.radials);
    const std::uint16_t first_valid = level2::facts_of(moment.moment).first_valid_code;
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        const std::size_t begin = radial * field.gates, gates = moment.gate_counts[radial];
        std::uint16_t* to = field.codes.data() + begin;
        if (moment.word_size_bits == 8)
            keep_valid_codes(moment.codes8.data() + begin, gates, first_valid, to);
        else
            keep_valid_codes(moment.codes16.data() + begin, gates, first_valid, to);
        std::fill(to + gates, to + field.gates, std::uint16_t{0});
        field.ends[radial] = end_of_values(to, gates);
    }
}

GateField gate_field(const level2::Sweep& sweep, const level2::SweepMoment& moment) {
    GateField field;
    read_gate_field(sweep, moment, field);
    return field;
}

GateBox gate_box(int radials, double length_m, const GateField& field) {
    const auto half = static_cast<int>(std::lround((length_m / field.gate_spacing_m - 1) / 2));
    return {radials, 2 * std::clamp(half, 1, 40) + 1};
}

BoxSums::BoxSums(const GateField& field, const GateBox& box, FillRow fill)
    : field_(&field),
      box_(box),
      fill_(std::move(fill)),
      padded_(field.gates + static_cast<std::size_t>(box.gates) - 1),
      total_(field.gates, 0),
      rows_(static_cast<std::size_t>(box.radials + 1) * field.gates, 0),
      ends_(static_cast<std::size_t>(box.radials) + 1, 0) {
    const int reach = box.radials / 2;
    for (int place = -reach; place < reach; ++place)
        take(place);
}

BoxSums BoxSums::of_codes(const GateField& field, const GateBox& box) {
    const std::uint32_t most = BoxSum::most_sum / static_cast<std::uint32_t>(box.size());
    return {field, box, [&field, most](std::size_t radial, std::uint32_t* numbers) {
                const std::size_t end = field.ends[radial];
                number_codes(field.row(radial), end, most, numbers);
                return end;
            }};
}

BoxSums BoxSums::of_differences(const GateField& field, const GateBox& box, Direction direction,
                                float turn) {
    // If the values are not on a circle, the difference must never go around it.
    const int way_round = turn > 0 ? static_cast<int>(std::lround(turn * field.scale)) : 1 << 20;
    const auto most = static_cast<int>(
        std::sqrt(static_cast<double>(BoxSum::most_sum / static_cast<std::uint32_t>(box.size()))));
    const CodeDifferences differences{way_round, most};
    if (direction == Direction::range)
        return {field, box, [&field, differences](std::size_t radial, std::uint32_t* numbers) {
                    const std::uint16_t* codes = field.row(radial);
                    const std::size_t end = field.ends[radial];
                    if (end == 0) return std::size_t{0};
                    numbers[0] = 0;
                    number_differences(codes + 1, codes, end - 1, differences, numbers + 1);
                    return end;
                }};
    return {field, box, [&field, differences](std::size_t radial, std::uint32_t* numbers) {
                if (radial == 0 && !field.is_circle) return std::size_t{0};
                const std::size_t before = radial == 0 ? field.radials - 1 : radial - 1;
                const std::size_t end = std::min(field.ends[radial], field.ends[before]);
                number_differences(field.row(radial), field.row(before), end, differences, numbers);
                return end;
            }};
}

const std::uint32_t* BoxSums::next() {
    take(next_ + box_.radials / 2);
    ++next_;
    return total_.data();
}

// Replaces the oldest radial of the box by the radial at a place, which may be beyond the ends.
// Most radials have values in their first part only, so that each step ends where the sums of its
// radials become 0.
void BoxSums::take(int place) {
    const int slots = box_.radials + 1;
    const auto slot = static_cast<std::size_t>((place + slots) % slots);
    const auto oldest = static_cast<std::size_t>((place + slots + 1) % slots);
    std::uint32_t* row = rows_.data() + slot * field_->gates;
    const std::size_t end = sum_radial(place, row);
    // Fill the rest of the row with 0, so that it can be added as far as a longer row.
    if (end < ends_[slot]) std::fill(row + end, row + ends_[slot], 0U);
    ends_[slot] = end;
    exchange_rows(row, rows_.data() + oldest * field_->gates, std::max(end, ends_[oldest]),
                  total_.data());
}

// Writes the sums along a radial. Returns the number of gates before the sums become 0.
std::size_t BoxSums::sum_radial(int place, std::uint32_t* row) {
    const int radials = static_cast<int>(field_->radials);
    if (place < 0 || place >= radials) {
        if (!field_->is_circle || radials <= box_.radials) return 0;
        place = (place + radials) % radials;
    }
    const auto half = static_cast<std::size_t>(box_.gates / 2);
    std::uint32_t* numbers = padded_.data() + half;
    const std::size_t values = fill_(static_cast<std::size_t>(place), numbers);
    if (values == 0) return 0;
    const std::size_t end = std::min(values + half, field_->gates);
    std::fill_n(padded_.data(), half, 0U);
    std::fill_n(numbers + values, end + half - values, 0U);
    sum_windows(padded_.data(), end, static_cast<unsigned>(box_.gates), row);
    return end;
}

}  // namespace stormcellar::retrieve
