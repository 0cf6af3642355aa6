#include "level2/foreign/cfradial_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/printable.h"

namespace stormcellar::level2 {

using arrayfile::Array;
using arrayfile::ElementKind;
using arrayfile::Group;

namespace {

struct TimeUnit {
    std::string_view begin;
    double seconds = 1;
};
constexpr auto time_units = std::to_array<TimeUnit>({
    {"sec", 1},
    {"s ", 1},
    {"milli", 1e-3},
    {"micro", 1e-6},
    {"nano", 1e-9},
    {"min", 60},
    {"hour", 3600},
    {"day", 86'400},
});

}  // namespace

std::vector<double> CfradialValues::numbers(const Array& array) const {
    // Coordinates have an element for each ray or gate, not for each gate of each ray.
    constexpr std::uint64_t most_coordinates = 10'000'000;
    if (!array.type.is_number() || array.count().value_or(~0ULL) > most_coordinates) return {};
    const auto elements = arrayfile::read_array(bytes_, array, most_bytes_);
    if (!elements) return {};
    const double scale = array.attributes.number("scale_factor").value_or(1);
    const double offset = array.attributes.number("add_offset").value_or(0);
    const auto fill = array.attributes.number("_FillValue");
    std::vector<double> numbers;
    numbers.reserve(elements->size());
    for (std::size_t i = 0; i < elements->size(); ++i) {
        const double element = (*elements)[i];
        const bool is_fill = fill && *fill == element;
        numbers.push_back(is_fill ? std::numeric_limits<double>::quiet_NaN()
                                  : element * scale + offset);
    }
    return numbers;
}

std::vector<double> CfradialValues::numbers(const Group& group, std::string_view name) const {
    const Array* array = group.array(name);
    return array == nullptr ? std::vector<double>{} : numbers(*array);
}

std::vector<std::string> CfradialValues::texts(const Group& group, std::string_view name) const {
    const Array* array = group.array(name);
    if (array == nullptr || array->type.kind != ElementKind::text || array->type.size == 0)
        return {};
    constexpr std::uint64_t most_letters = 1'000'000;
    const auto elements = arrayfile::read_array(bytes_, *array, most_letters);
    if (!elements) return {};
    // In netCDF, a letter is an element, and the last dimension has the letters of a text.
    const bool has_letters = array->type.size == 1 && !array->shape.empty();
    const std::size_t length =
        has_letters ? static_cast<std::size_t>(array->shape.back()) : array->type.size;
    std::vector<std::string> texts;
    const auto letters = elements->bytes();
    for (std::size_t at = 0; length > 0 && at + length <= letters.size(); at += length) {
        std::string text{reinterpret_cast<const char*>(letters.data()) + at, length};
        text.resize(std::min(text.find('\0'), text.size()));
        while (!text.empty() && text.back() == ' ')
            text.pop_back();
        texts.push_back(std::move(text));
    }
    return texts;
}

Result<std::vector<UtcTime>> CfradialValues::times(const Group& group) const {
    const Array* array = group.array("time");
    if (array == nullptr) return fail(ErrorCode::corrupt, "the CfRadial file has no times of rays");
    const std::string units = array->attributes.text("units").value_or("");
    constexpr std::string_view since = " since ";
    const std::size_t found = units.find(since);
    const auto unit = std::ranges::find_if(
        time_units, [&](const TimeUnit& one) { return units.starts_with(one.begin); });
    if (found == std::string::npos || unit == time_units.end())
        return fail(ErrorCode::corrupt,
                    "the times of rays have the unit '{}', not such as 'seconds since 2018-11-10'",
                    printable(units.substr(0, 60)));
    std::string text = units.substr(found + since.size());
    for (const std::string_view zone : {" UTC", "+00:00", " +0:00"}) {
        if (text.ends_with(zone)) text.resize(text.size() - zone.size());
    }
    const auto start = parse_utc(text, UtcTime{});
    if (!start) return fail(ErrorCode::corrupt, "the times of rays: {}", start.error().message);
    std::vector<UtcTime> times;
    constexpr double longest_s = 1e10;
    for (const double number : numbers(*array)) {
        const double seconds = number * unit->seconds;
        if (!(std::abs(seconds) < longest_s))
            return fail(ErrorCode::corrupt, "a ray has the time {} s", seconds);
        times.push_back(*start + std::chrono::milliseconds{std::llround(seconds * 1000)});
    }
    return times;
}

}  // namespace stormcellar::level2
