#include "export/uf_record.h"

#include <chrono>
#include <cmath>
#include <limits>

namespace stormcellar::netcdf {

void UfRecord::add(double number) {
    const double word = std::round(number);
    if (!(std::abs(word) <= std::numeric_limits<std::int16_t>::max())) return add_missing(1);
    words_.push_back(static_cast<std::int16_t>(word));
}

void UfRecord::add(std::optional<double> number) {
    add(number.value_or(std::nan("")));
}

void UfRecord::add_text(std::string text, std::size_t letters) {
    text.resize(letters, ' ');
    for (std::size_t i = 0; i < letters; i += 2) {
        const auto high = static_cast<unsigned char>(text[i]);
        const auto low = static_cast<unsigned char>(text[i + 1]);
        words_.push_back(static_cast<std::int16_t>(high << 8U | low));
    }
}

void UfRecord::add_angle(std::optional<double> degrees) {
    if (!degrees || !std::isfinite(*degrees)) return add_missing(3);
    constexpr long long minute = 60 * 64;
    const long long total = std::llround(*degrees * 60 * minute);
    add(static_cast<double>(total / (60 * minute)));
    add(static_cast<double>(total / minute % 60));
    add(static_cast<double>(total % minute));
}

void UfRecord::add_date(UtcTime time) {
    const std::chrono::year_month_day date{std::chrono::floor<std::chrono::days>(time)};
    add(static_cast<int>(date.year()));
    add(static_cast<unsigned>(date.month()));
    add(static_cast<unsigned>(date.day()));
}

void UfRecord::add_time(UtcTime time) {
    add_date(time);
    const auto second = std::chrono::floor<std::chrono::seconds>(time);
    const std::chrono::hh_mm_ss clock{second - std::chrono::floor<std::chrono::days>(second)};
    add(static_cast<double>(clock.hours().count()));
    add(static_cast<double>(clock.minutes().count()));
    add(static_cast<double>(clock.seconds().count()));
}

void UfRecord::append_to(std::vector<std::byte>& file) const {
    const std::size_t bytes = 2 * words_.size();
    const auto add_length = [&] {
        for (int shift = 24; shift >= 0; shift -= 8)
            file.push_back(static_cast<std::byte>(bytes >> shift));
    };
    add_length();
    for (const std::int16_t word : words_) {
        const auto bits = static_cast<std::uint16_t>(word);
        file.push_back(static_cast<std::byte>(bits >> 8U));
        file.push_back(static_cast<std::byte>(bits));
    }
    add_length();
}

}  // namespace stormcellar::netcdf
