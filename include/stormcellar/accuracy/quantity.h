// stormcellar/accuracy/quantity.h -- what an error is measured in, and how it is written.
//
// Three quantities, never mixed: how far a cell's sample lies from where it should (metres), how
// far a value is off (in the unit of its moment), how far a picture's colour is off (CIEDE2000).
// Sizes are magnitudes: never negative, never NaN; infinity says that no bound is known.
// Thread contract: values and pure functions.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace stormcellar::accuracy {

// Decibels for REF, ZDR and CFP, metres per second for VEL and SW, degrees for PHI, a ratio for
// RHO.
enum class ValueUnit { db, mps, degree, ratio };
[[nodiscard]] std::string_view name_of(ValueUnit unit);  // "dB", "m/s", "deg", "ratio"

enum class Quantity { position, value, image };
inline constexpr std::array all_quantities = {Quantity::position, Quantity::value, Quantity::image};

// Of three figures the one for a quantity.
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
    double value = 0;     // in the ValueUnit of the chain or budget that it stands beside
    double image_de = 0;  // CIEDE2000

    [[nodiscard]] double of(Quantity quantity) const;
    ErrorSize& operator+=(const ErrorSize& other);
    bool operator==(const ErrorSize&) const = default;
};

// Whether no bound is known of any quantity.
[[nodiscard]] bool is_unbounded(const ErrorSize& size);

// Three significant digits, rounded UP, so that no error looks smaller than it is; "unbounded" for
// infinity. For people: budgets are written by format_budget(), which loses nothing.
[[nodiscard]] std::string format_number(double number);
[[nodiscard]] std::string format_quantity(Quantity quantity, double size, ValueUnit unit);
// The quantities that are not zero, as in "412 m, 0.2 dB"; "0" when all are.
[[nodiscard]] std::string format_size(const ErrorSize& size, ValueUnit unit);
// As in "1.25 s", "20 ms", "3.1 us"; "0 s".
[[nodiscard]] std::string format_seconds(double seconds);

}  // namespace stormcellar::accuracy
