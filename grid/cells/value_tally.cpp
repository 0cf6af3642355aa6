#include "grid/cells/value_tally.h"

#include <cmath>

namespace stormcellar::grid {
namespace {

std::uint8_t bin_of_value(double dbz) {
    const double bin =
        std::floor((dbz - ValueTally::first_edge_dbz) / ValueTally::bin_width_db) + 1;
    return static_cast<std::uint8_t>(
        std::clamp(bin, 0.0, static_cast<double>(ValueTally::bins - 1)));
}

}  // namespace

double ValueTally::edge_dbz(std::size_t bin) {
    return first_edge_dbz + bin_width_db * (static_cast<double>(bin) - 1);
}

ValueTally::ValueTally(std::size_t places, Quantization quantization)
    : quantization_(quantization),
      seen_(places),
      in_bins_(places * bins),
      greatest_(places),
      codes_(places),
      powers_(places) {
    // Tabulate the numbers that depend on the code alone.
    const std::size_t codes = std::size_t{quantization_.largest_code()} + 1;
    bin_of_.resize(codes);
    power_of_.resize(codes);
    for (std::size_t code = quantization_.first_code(); code < codes; ++code) {
        const double dbz = quantization_.value_of(static_cast<std::uint16_t>(code));
        bin_of_[code] = bin_of_value(dbz);
        power_of_[code] =
            static_cast<std::uint64_t>(std::llround(1000 * std::pow(10, std::min(dbz, 95.5) / 10)));
    }
}

void ValueTally::count_value(std::size_t place, std::uint16_t code) {
    ++in_bins_[place * bins + bin_of_[code]];
    greatest_[place] = std::max(greatest_[place], code);
    codes_[place] += code;
    powers_[place] += power_of_[code];
}

void ValueTally::add(const ValueTally& more) {
    add_numbers(more.seen_, seen_);
    add_numbers(more.in_bins_, in_bins_);
    add_numbers(more.codes_, codes_);
    add_numbers(more.powers_, powers_);
    std::ranges::transform(more.greatest_, greatest_, greatest_.begin(),
                           [](auto a, auto b) { return std::max(a, b); });
}

std::uint32_t ValueTally::from_bin_on(std::size_t place, std::size_t bin) const {
    std::uint32_t count = 0;
    for (; bin < bins; ++bin)
        count += in_bin(place, bin);
    return count;
}

std::uint32_t ValueTally::with_value(std::size_t place) const {
    return from_bin_on(place, 0);
}

double ValueTally::greatest_dbz(std::size_t place) const {
    return quantization_.value_of(greatest_[place]);
}

double ValueTally::mean_dbz(std::size_t place) const {
    const double code = static_cast<double>(codes_[place]) / with_value(place);
    return double{quantization_.first_value} +
           double{quantization_.step} * (code - first_value_code);
}

double ValueTally::mean_z_as_dbz(std::size_t place) const {
    return 10 * std::log10(static_cast<double>(powers_[place]) / 1000 / with_value(place));
}

double ValueTally::quantile_dbz(std::size_t place, double share) const {
    const double wanted = share * with_value(place);
    std::uint32_t count = 0;
    std::size_t bin = 0;
    for (; bin + 1 < bins; ++bin) {
        count += in_bin(place, bin);
        if (count >= wanted) break;
    }
    return edge_dbz(bin) + bin_width_db / 2;
}

void ValueTally::append_to(std::vector<std::byte>& bytes) const {
    append_numbers(codes_, bytes);
    append_numbers(powers_, bytes);
    append_numbers(seen_, bytes);
    append_numbers(in_bins_, bytes);
    append_numbers(greatest_, bytes);
}

Status ValueTally::take_from(std::span<const std::byte>& bytes) {
    take_numbers(bytes, codes_);
    take_numbers(bytes, powers_);
    take_numbers(bytes, seen_);
    take_numbers(bytes, in_bins_);
    take_numbers(bytes, greatest_);
    const auto is_code = [&](std::uint16_t code) { return code <= quantization_.largest_code(); };
    if (std::ranges::all_of(greatest_, is_code)) return {};
    return fail(ErrorCode::corrupt, "has a greatest value that no grid can have");
}

std::uint64_t ValueTally::bytes_of(std::size_t places) {
    constexpr std::uint64_t a_place = 2 * 8 + 4 + 4 * bins + 2;
    return places * a_place;
}

}  // namespace stormcellar::grid
