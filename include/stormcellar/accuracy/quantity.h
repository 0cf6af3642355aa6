// stormcellar/accuracy/quantity.h -- the quantities that errors are measured in, and how they are
// written.
//
// There are three quantities, which are never mixed: the distance of a cell's sample from its true
// place, the error of a value, and the error of a picture's color. Sizes are magnitudes: never
// negative and never NaN. Infinity means that no bound is known.
//
// Units     Meters for positions, the unit of the moment (ValueUnit) for values, CIEDE2000 for
//           colors.
// Threads   Plain values and pure functions.
// Errors    None.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace stormcellar::accuracy {

// The unit of a moment's values: decibels for REF, ZDR and CFP, meters per second for VEL and SW,
// degrees for PHI, a ratio for RHO.
enum class ValueUnit { db, mps, degree, ratio };
[[nodiscard]] std::string_view name_of(ValueUnit unit);  // "dB", "m/s", "deg", "ratio"

enum class Quantity { position, value, image };
inline constexpr std::array all_quantities = {Quantity::position, Quantity::value, Quantity::image};

// Returns the figure of the three that belongs to the quantity.
template <class Figure>
[[nodiscard]] const Figure& figure_of(Quantity quantity, const Figure& position,
                                      const Figure& value, const Figure& image) {
    switch (quantity) {
        case Quantity::position:
            return position;
        case Quantity::value:
            return value;
        case Quantity::image:
            break;
    }
    return image;
}

struct ErrorSize {
    double position_m = 0;
    double value = 0;     // in the ValueUnit of the chain or budget that holds it
    double image_de = 0;  // CIEDE2000

    // Returns the size of one quantity.
    [[nodiscard]] double of(Quantity quantity) const;
    ErrorSize& operator+=(const ErrorSize& other);
    bool operator==(const ErrorSize&) const = default;
};

// Returns true if no bound is known for any quantity.
[[nodiscard]] bool is_unbounded(const ErrorSize& size);

// Writes a number with three significant digits, rounded UP so that no error looks smaller than it
// is, or "unbounded" for infinity. The text is for people; format_budget() writes budgets without
// loss.
[[nodiscard]] std::string format_number(double number);
// Writes one size with its unit, by format_number().
[[nodiscard]] std::string format_quantity(Quantity quantity, double size, ValueUnit unit);
// Writes the quantities that are not zero, such as "412 m, 0.2 dB", or "0" if all are zero.
[[nodiscard]] std::string format_size(const ErrorSize& size, ValueUnit unit);
// Writes a time such as "1.25 s", "20 ms", "3.1 us" or "0 s".
[[nodiscard]] std::string format_seconds(double seconds);

}  // namespace stormcellar::accuracy
