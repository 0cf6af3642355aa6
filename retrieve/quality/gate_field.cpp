#include "retrieve/quality/gate_field.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr std::uint32_t one_number = 1U << BoxSum::sum_bits;

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

// Writes the numbers of a radial, each with one_number added, and 0 where there is none. Returns
// how many it wrote; the rest of the radial has no numbers.
using FillRow = std::function<std::size_t(std::size_t radial, std::uint32_t* numbers)>;

// Sums numbers over boxes, one radial after another. Most radials have values in their first part
// only, so that each step ends where the sums of its radials become 0.
class BoxSums {
  public:
    BoxSums(const GateField& field, const GateBox& box, const FillRow& fill)
        : field_(field),
          box_(box),
          fill_(fill),
          padded_(field.gates + static_cast<std::size_t>(box.gates) - 1),
          total_(field.gates, 0),
          rows_(static_cast<std::size_t>(box.radials + 1) * field.gates, 0),
          ends_(static_cast<std::size_t>(box.radials) + 1, 0) {}

    void visit(const SumVisitor& visit) {
        const int reach = box_.radials / 2;
        for (int place = -reach; place < reach; ++place)
            take(place);
        for (int radial = 0; radial < static_cast<int>(field_.radials); ++radial) {
            take(radial + reach);
            visit(static_cast<std::size_t>(radial), total_.data());
        }
    }

  private:
    // Replaces the oldest radial of the box by the radial at a place, which may be beyond the ends.
    void take(int place) {
        const int slots = box_.radials + 1;
        const auto slot = static_cast<std::size_t>((place + slots) % slots);
        const auto oldest = static_cast<std::size_t>((place + slots + 1) % slots);
        std::uint32_t* row = rows_.data() + slot * field_.gates;
        const std::uint32_t* old = rows_.data() + oldest * field_.gates;
        ends_[slot] = sum_radial(place, row);
        const std::size_t common = std::min(ends_[slot], ends_[oldest]);
        std::uint32_t* total = total_.data();
        for (std::size_t gate = 0; gate < common; ++gate)
            total[gate] += row[gate] - old[gate];
        for (std::size_t gate = common; gate < ends_[slot]; ++gate)
            total[gate] += row[gate];
        for (std::size_t gate = common; gate < ends_[oldest]; ++gate)
            total[gate] -= old[gate];
    }
    // Writes the sums along a radial. Returns the number of gates before the sums become 0.
    std::size_t sum_radial(int place, std::uint32_t* row) {
        const int radials = static_cast<int>(field_.radials);
        if (place < 0 || place >= radials) {
            if (!field_.is_circle || radials <= box_.radials) return 0;
            place = (place + radials) % radials;
        }
        const auto radial = static_cast<std::size_t>(place);
        const std::size_t values = fill_(radial, padded_.data() + half());
        if (values == 0) return 0;
        const std::size_t end = std::min(values + half(), field_.gates);
        std::fill_n(padded_.data(), half(), 0U);
        std::fill_n(padded_.data() + half() + values, end + half() - values, 0U);
        sum_along(row, end);
        return end;
    }
    // Sums the padded numbers over the gates of the box. Doubles the length of the sums as often
    // as possible, and adds those that make up the length of the box.
    void sum_along(std::uint32_t* row, std::size_t end) {
        const std::size_t padded_end = end + 2 * half();
        std::size_t length = 1, begin = 0;
        bool is_first = true;
        for (auto left = static_cast<unsigned>(box_.gates);; left >>= 1U) {
            if ((left & 1U) != 0) {
                const std::uint32_t* from = padded_.data() + begin;
                if (is_first) {
                    std::copy_n(from, end, row);
                } else {
                    for (std::size_t gate = 0; gate < end; ++gate)
                        row[gate] += from[gate];
                }
                is_first = false;
                begin += length;
            }
            if (left <= 1) return;
            for (std::size_t i = 0; i + length < padded_end; ++i)
                padded_[i] += padded_[i + length];
            length *= 2;
        }
    }
    [[nodiscard]] std::size_t half() const { return static_cast<std::size_t>(box_.gates / 2); }

    const GateField& field_;
    GateBox box_;
    const FillRow& fill_;
    std::vector<std::uint32_t> padded_, total_, rows_;
    std::vector<std::size_t> ends_;  // of rows_
};

// Differences of codes, in whole codes.
struct Differ {
    int turn = 0;  // codes around the circle
    int most = 0;  // a larger difference counts as this

    [[nodiscard]] std::uint32_t number(std::uint16_t a, std::uint16_t b) const {
        int apart = std::abs(static_cast<int>(a) - static_cast<int>(b));
        apart = std::min({apart, std::abs(turn - apart), most});
        const bool has_both = a != 0 && b != 0;
        return has_both ? one_number + static_cast<std::uint32_t>(apart * apart) : 0;
    }
};

}  // namespace

std::int32_t GateField::gate_at(double range_m) const {
    const double gate = std::round((range_m - first_gate_m) / gate_spacing_m);
    return gate >= 0 && gate < static_cast<double>(gates) ? static_cast<std::int32_t>(gate) : -1;
}

std::size_t GateField::end_of_values(std::size_t radial) const {
    const std::uint16_t* of_radial = row(radial);
    std::size_t end = gates;
    // Skips blocks without a value first, because compilers vectorize this loop.
    constexpr std::size_t block = 64;
    while (end >= block) {
        std::uint16_t any = 0;
        for (std::size_t gate = end - block; gate < end; ++gate)
            any |= of_radial[gate];
        if (any != 0) break;
        end -= block;
    }
    while (end > 0 && of_radial[end - 1] == 0)
        --end;
    return end;
}

GateField gate_field(const level2::Sweep& sweep, const level2::SweepMoment& moment) {
    GateField field;
    if (moment.gate_spacing_m <= 0 || moment.gate_stride <= 0) return field;
    field.radials = sweep.radials.size();
    field.gates = static_cast<std::size_t>(moment.gate_stride);
    field.first_gate_m = moment.first_gate_m;
    field.gate_spacing_m = moment.gate_spacing_m;
    field.scale = moment.scale != 0 ? moment.scale : 1;
    field.offset = moment.scale != 0 ? moment.offset : 0;
    field.is_circle = ends_meet(sweep);
    field.codes.assign(field.radials * field.gates, 0);
    const std::uint16_t first_valid = level2::facts_of(moment.moment).first_valid_code;
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        const std::size_t begin = radial * field.gates, gates = moment.gate_counts[radial];
        const auto keep = [to = field.codes.data() + begin, begin, gates,
                           first_valid](const auto& codes) {
            const auto* from = codes.data() + begin;
            for (std::size_t gate = 0; gate < gates; ++gate)
                to[gate] = from[gate] >= first_valid ? from[gate] : std::uint16_t{0};
        };
        if (moment.word_size_bits == 8)
            keep(moment.codes8);
        else
            keep(moment.codes16);
    }
    return field;
}

GateBox gate_box(int radials, double length_m, const GateField& field) {
    const auto half = static_cast<int>(std::lround((length_m / field.gate_spacing_m - 1) / 2));
    return {radials, 2 * std::clamp(half, 1, 40) + 1};
}

void visit_code_sums(const GateField& field, const GateBox& box, const SumVisitor& visit) {
    const auto most = static_cast<std::int32_t>(BoxSum::most_sum) / box.size();
    const FillRow fill = [&](std::size_t radial, std::uint32_t* numbers) {
        const std::uint16_t* codes = field.row(radial);
        const std::size_t end = field.end_of_values(radial);
        for (std::size_t gate = 0; gate < end; ++gate) {
            const std::int32_t code = codes[gate];
            const auto number = static_cast<std::uint32_t>(std::min(code, most));
            numbers[gate] = code != 0 ? one_number + number : 0;
        }
        return end;
    };
    BoxSums(field, box, fill).visit(visit);
}

void visit_difference_sums(const GateField& field, const GateBox& box, Direction direction,
                           float turn, const SumVisitor& visit) {
    // Without a circle, the way round is never the shorter one.
    const int way_round = turn > 0 ? static_cast<int>(std::lround(turn * field.scale)) : 1 << 20;
    const auto most = static_cast<int>(
        std::sqrt(static_cast<double>(BoxSum::most_sum / static_cast<std::uint32_t>(box.size()))));
    const Differ differ{way_round, most};
    const FillRow along_range = [&](std::size_t radial, std::uint32_t* numbers) {
        const std::uint16_t* codes = field.row(radial);
        const std::size_t end = field.end_of_values(radial);
        numbers[0] = 0;
        for (std::size_t gate = 1; gate < end; ++gate)
            numbers[gate] = differ.number(codes[gate], codes[gate - 1]);
        return end;
    };
    const FillRow along_azimuth = [&](std::size_t radial, std::uint32_t* numbers) {
        if (radial == 0 && !field.is_circle) return std::size_t{0};
        const std::uint16_t* codes = field.row(radial);
        const std::uint16_t* before = field.row(radial == 0 ? field.radials - 1 : radial - 1);
        const std::size_t end = field.end_of_values(radial);
        for (std::size_t gate = 0; gate < end; ++gate)
            numbers[gate] = differ.number(codes[gate], before[gate]);
        return end;
    };
    BoxSums(field, box, direction == Direction::range ? along_range : along_azimuth).visit(visit);
}

}  // namespace stormcellar::retrieve
