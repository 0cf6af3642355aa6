// stormcellar/accuracy/quantity.h -- the quantities of errors, and how they are written as text.
//
// There are three quantities, which are never mixed: the distance of a cell's sample from its true
// place, the error of a value, and the error of a picture's color. Sizes are magnitudes: never
// negative and never NaN. An infinite size means that no bound is known.
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
// degrees for PHI, a ratio for RHO and POW, thousandths per second for AZSH and DIVG, degrees per
// kilometer for KDP, millimeters per hour for RATE.
enum class ValueUnit { db, mps, degree, ratio, per_1000_s, degree_per_km, mm_per_h };
// Returns "dB", "m/s", "deg", "ratio", "0.001/s", "deg/km" or "mm/h".
[[nodiscard]] std::string_view name_of(ValueUnit unit);

enum class Quantity { position, value, image };
inline constexpr std::array all_quantities = {Quantity::position, Quantity::value, Quantity::image};

// Returns the figure for `quantity`.
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
    double value = 0;     // in the ValueUnit of the chain or budget
    double image_de = 0;  // CIEDE2000

    // Returns the size in one quantity.
    [[nodiscard]] double of(Quantity quantity) const;
    ErrorSize& operator+=(const ErrorSize& other);
    bool operator==(const ErrorSize&) const = default;
};

// Returns true if the size in at least one quantity is infinite.
[[nodiscard]] bool is_unbounded(const ErrorSize& size);

// Writes a number with three significant digits, rounded up so that no error looks smaller than it
// is (except beyond 1e290 or below 1e-290). Writes "unbounded" for infinity and "unknown" for NaN.
// The text is for people; format_budget() writes budgets without loss.
[[nodiscard]] std::string format_number(double number);
// Writes a size with its unit, by format_number(); "unbounded" has no unit.
[[nodiscard]] std::string format_quantity(Quantity quantity, double size, ValueUnit unit);
// Writes the quantities that are not zero, such as "412 m, 0.2 dB", or "0" if all are zero.
[[nodiscard]] std::string format_size(const ErrorSize& size, ValueUnit unit);
// Writes a time such as "1.25 s", "20 ms", "3.1 us" or "0 s".
[[nodiscard]] std::string format_seconds(double seconds);

}  // namespace stormcellar::accuracy
