// retrieve/quality/gate_field.h -- the codes of one moment of a sweep, and means and textures of
// its values in boxes about each gate.
//
// Sums are integers, so that they are exact and the order of the gates does not matter.
//
// Units     Those of the moment; meters.
// Accuracy  tests/retrieve/gate_field_test.cpp compares with sums over each box: exact up to the
//           rounding of floats, except that a difference of more than 194 codes / sqrt(gates of the
//           box / 27) counts as this limit.
// Threads   Plain data and pure functions.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

struct GateField {
    std::size_t radials = 0, gates = 0;
    double first_gate_m = 0, gate_spacing_m = 0;
    float scale = 1, offset = 0;       // value = (code - offset) / scale
    bool is_circle = false;            // the last radial is next to the first
    std::vector<std::uint16_t> codes;  // radials x gates; 0 where there is no value
    std::vector<std::size_t> ends;     // per radial, the gates up to the last gate with a value

    [[nodiscard]] bool is_empty() const { return codes.empty(); }
    [[nodiscard]] const std::uint16_t* row(std::size_t radial) const {
        return codes.data() + radial * gates;
    }
    [[nodiscard]] double range_m(std::size_t gate) const {
        return first_gate_m + gate_spacing_m * static_cast<double>(gate);
    }
    // Returns the number of the gate at a range, or -1 if the range is outside the field.
    [[nodiscard]] std::int32_t gate_at(double range_m) const;
    [[nodiscard]] float value_of(float code) const { return (code - offset) / scale; }
    // Returns NaN if there is no value.
    [[nodiscard]] float value(std::size_t radial, std::size_t gate) const {
        const std::uint16_t code = row(radial)[gate];
        return code != 0 ? value_of(code) : std::numeric_limits<float>::quiet_NaN();
    }
};

// Returns the valid codes of a moment of the sweep. Empty if the moment has no gates.
[[nodiscard]] GateField gate_field(const level2::Sweep& sweep, const level2::SweepMoment& moment);
// Does the same as gate_field(), but uses the memory of a field again.
void read_gate_field(const level2::Sweep& sweep, const level2::SweepMoment& moment,
                     GateField& field);

// A box of radials x gates about a gate; both numbers are odd. Rows follow the order of arrival,
// and gaps in azimuth do not count. Gates outside the sweep have no value.
struct GateBox {
    int radials = 3;
    int gates = 7;
    [[nodiscard]] int size() const { return radials * gates; }
};
// Returns a box of this many radials and of about this length, but of at least three gates.
[[nodiscard]] GateBox gate_box(int radials, double length_m, const GateField& field);

// The sum and the count of the numbers in a box.
class BoxSum {
  public:
    static constexpr int sum_bits = 22;
    static constexpr std::uint32_t most_sum = (1U << sum_bits) - 1;
    explicit BoxSum(std::uint32_t bits) : bits_(bits) {}

    // Conversions from signed integers are faster.
    [[nodiscard]] float count() const {
        return static_cast<float>(static_cast<std::int32_t>(bits_ >> sum_bits));
    }
    // Returns NaN if there are no numbers.
    [[nodiscard]] float mean() const {
        const auto sum = static_cast<float>(static_cast<std::int32_t>(bits_ & most_sum));
        return bits_ != 0 ? sum / count() : std::numeric_limits<float>::quiet_NaN();
    }

  private:
    std::uint32_t bits_;  // count, then sum
};

enum class Direction : std::uint8_t { range, azimuth };

// Sums numbers over the box about each gate, one radial after another.
class BoxSums {
  public:
    // Sums the codes. The field must outlive the sums.
    [[nodiscard]] static BoxSums of_codes(const GateField& field, const GateBox& box);
    // Sums the squared differences between the codes of successive gates or radials. `turn` is the
    // length of the circle on which the values lie (twice the Nyquist velocity, 360 degrees), or 0.
    [[nodiscard]] static BoxSums of_differences(const GateField& field, const GateBox& box,
                                                Direction direction, float turn = 0);

    // Returns the sums about the gates of the first radial, then of the second, and so on. A BoxSum
    // is made from each sum. The sums are valid until the next call.
    const std::uint32_t* next();

  private:
    // Writes the numbers of a radial (gate_loops.h), 0 where there is none. Returns how many
    // numbers it wrote; the rest of the radial has no numbers.
    using FillRow = std::function<std::size_t(std::size_t radial, std::uint32_t* numbers)>;
    BoxSums(const GateField& field, const GateBox& box, FillRow fill);
    void take(int place);
    std::size_t sum_radial(int place, std::uint32_t* row);

    const GateField* field_;
    GateBox box_;
    FillRow fill_;
    int next_ = 0;
    std::vector<std::uint32_t> padded_, total_, rows_;
    std::vector<std::size_t> ends_;  // of rows_
};

}  // namespace stormcellar::retrieve
