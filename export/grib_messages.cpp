// The module stormcellar_grib.so: makes the messages of a map with ecCodes (export/grib_map.h).
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <eccodes.h>

#include "export/cf_attributes.h"
#include "export/grib_map.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grib {
namespace {

// Numbers of WMO's code tables.
constexpr long tables_version = 28;
constexpr long missing_center = 255, unknown_status = 255, unknown_process = 255;
constexpr long observation_time = 3;                  // table 1.2
constexpr long processed_radar = 7;                   // table 1.4
constexpr long wgs84_earth = 5;                       // table 3.2
constexpr long observation = 8;                       // table 4.3
constexpr long point_in_time = 0, sum_over_time = 8;  // templates of section 4
constexpr long accumulation = 1;                      // table 4.10
constexpr long unit_second = 13;                      // table 4.4
constexpr long local_parameter = 192;
constexpr double missing_value = 9.999e20;

Mutex& library_mutex() {
    static Mutex mutex;
    return mutex;
}

struct Delete {
    void operator()(codes_handle* handle) const { codes_handle_delete(handle); }
};

// A message while it is made. Keeps the first failure, like netcdf::NetcdfBuilder.
class Message {
  public:
    Message() : handle_(codes_grib_handle_new_from_samples(nullptr, "GRIB2")) {
        if (!handle_) failure_ = "the sample GRIB2 of ecCodes is missing";
    }
    void set(const char* key, long number) {
        if (failure_.empty()) note(key, codes_set_long(handle_.get(), key, number));
    }
    void set_number(const char* key, double number) {
        if (failure_.empty()) note(key, codes_set_double(handle_.get(), key, number));
    }
    void set_text(const char* key, const char* text) {
        std::size_t length = std::char_traits<char>::length(text);
        if (failure_.empty()) note(key, codes_set_string(handle_.get(), key, text, &length));
    }
    void set_values(const std::vector<double>& values) {
        if (failure_.empty())
            note("values",
                 codes_set_double_array(handle_.get(), "values", values.data(), values.size()));
    }
    Result<std::vector<std::byte>> bytes() const {
        const void* first = nullptr;
        std::size_t size = 0;
        if (!failure_.empty()) return fail(ErrorCode::internal, "ecCodes: {}", failure_);
        if (const int code = codes_get_message(handle_.get(), &first, &size); code != 0)
            return fail(ErrorCode::internal, "ecCodes: {}", codes_get_error_message(code));
        const auto* begin = static_cast<const std::byte*>(first);
        return std::vector<std::byte>(begin, begin + size);
    }

  private:
    void note(const char* key, int code) {
        if (code != 0) failure_ = fmt::format("{}: {}", key, codes_get_error_message(code));
    }
    std::unique_ptr<codes_handle, Delete> handle_;
    std::string failure_;
};

// Longitudes of GRIB are 0 to 360.
double from_zero(double longitude_deg) {
    const double turned = std::fmod(longitude_deg, 360);
    return turned < 0 ? turned + 360 : turned;
}

void place_in_degrees(Message& message, const grid::GridSpec& spec) {
    const std::vector<double> rows = netcdf::row_places(spec);
    const std::vector<double> columns = netcdf::column_places(spec);
    message.set_text("gridType", "regular_ll");
    message.set("Ni", spec.nx);
    message.set("Nj", spec.ny);
    message.set_number("latitudeOfFirstGridPointInDegrees", rows.front());
    message.set_number("longitudeOfFirstGridPointInDegrees", from_zero(columns.front()));
    message.set_number("latitudeOfLastGridPointInDegrees", rows.back());
    message.set_number("longitudeOfLastGridPointInDegrees", from_zero(columns.back()));
    message.set_number("iDirectionIncrementInDegrees", spec.spacing_deg);
    message.set_number("jDirectionIncrementInDegrees", spec.spacing_deg);
}

void place_on_cone(Message& message, const grid::GridSpec& spec) {
    constexpr long south_pole_on_plane = 128;
    const grid::GeoPoint first = grid::GridProjection(spec).to_geo({0, 0});
    const auto [latitude_1, latitude_2] = spec.parallels_deg;
    message.set_text("gridType", "lambert");
    message.set("Nx", spec.nx);
    message.set("Ny", spec.ny);
    message.set_number("latitudeOfFirstGridPointInDegrees", first.latitude_deg);
    message.set_number("longitudeOfFirstGridPointInDegrees", from_zero(first.longitude_deg));
    message.set_number("LaDInDegrees", latitude_1);
    message.set_number("LoVInDegrees", from_zero(spec.center_longitude_deg));
    message.set_number("DxInMetres", spec.spacing_m);
    message.set_number("DyInMetres", spec.spacing_m);
    message.set("projectionCentreFlag", latitude_1 + latitude_2 < 0 ? south_pole_on_plane : 0);
    message.set_number("Latin1InDegrees", latitude_1);
    message.set_number("Latin2InDegrees", latitude_2);
}

struct Parts {
    long year, month, day, hour, minute, second;
};
Parts parts_of(UtcTime time) {
    const auto whole = std::chrono::floor<std::chrono::seconds>(time);
    const auto day = std::chrono::floor<std::chrono::days>(whole);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(whole - day);
    return {int{date.year()},
            static_cast<long>(unsigned{date.month()}),
            static_cast<long>(unsigned{date.day()}),
            clock.hours().count(),
            clock.minutes().count(),
            clock.seconds().count()};
}

void set_time(Message& message, const Map& map) {
    const Parts reference = parts_of(map.since.value_or(map.time));
    message.set("significanceOfReferenceTime", observation_time);
    message.set("year", reference.year);
    message.set("month", reference.month);
    message.set("day", reference.day);
    message.set("hour", reference.hour);
    message.set("minute", reference.minute);
    message.set("second", reference.second);
    message.set("productDefinitionTemplateNumber", map.since ? sum_over_time : point_in_time);
    message.set("typeOfGeneratingProcess", observation);
    message.set("generatingProcessIdentifier", unknown_process);
    if (!map.since) return;
    const Parts end = parts_of(map.time);
    message.set("yearOfEndOfOverallTimeInterval", end.year);
    message.set("monthOfEndOfOverallTimeInterval", end.month);
    message.set("dayOfEndOfOverallTimeInterval", end.day);
    message.set("hourOfEndOfOverallTimeInterval", end.hour);
    message.set("minuteOfEndOfOverallTimeInterval", end.minute);
    message.set("secondOfEndOfOverallTimeInterval", end.second);
    message.set("typeOfStatisticalProcessing", accumulation);
    message.set("indicatorOfUnitForTimeRange", unit_second);
    const auto length = std::chrono::floor<std::chrono::seconds>(map.time) -
                        std::chrono::floor<std::chrono::seconds>(*map.since);
    message.set("lengthOfTimeRange", static_cast<long>(length.count()));
}

void set_surface(Message& message, const Parameter& parameter) {
    message.set("typeOfFirstFixedSurface", parameter.surface);
    if (!parameter.height_m) return;
    message.set("scaleFactorOfFirstFixedSurface", 0);
    message.set("scaledValueOfFirstFixedSurface", std::lround(*parameter.height_m));
}

// Says everything but the values.
void describe(Message& message, const Map& map, long number) {
    message.set("tablesVersion", tables_version);
    message.set("centre", missing_center);
    message.set("subCentre", missing_center);
    message.set("productionStatusOfProcessedData", unknown_status);
    message.set("typeOfProcessedData", processed_radar);
    message.set("discipline", map.parameter.discipline);
    if (map.spec.in_degrees()) {
        place_in_degrees(message, map.spec);
    } else {
        place_on_cone(message, map.spec);
    }
    message.set("shapeOfTheEarth", wgs84_earth);
    message.set("jScansPositively", 1);
    set_time(message, map);
    message.set("parameterCategory", map.parameter.category);
    message.set("parameterNumber", number);
    set_surface(message, map.parameter);
}

void append_big_endian(std::vector<std::byte>& bytes, std::uint64_t number, int count) {
    for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
        bytes.push_back(static_cast<std::byte>(number >> shift));
}

// Puts section 2 between sections 1 and 3. ecCodes can write only the sections 2 of centers that it
// knows.
std::vector<std::byte> with_notes(const std::vector<std::byte>& message, const Map& map) {
    constexpr std::size_t section_0 = 16, length_at = 8, section_header = 5;
    std::string text;
    for (const auto& [name, value] : map.notes) {
        text += name + ": ";
        std::ranges::replace_copy(value, std::back_inserter(text), '\n', ' ');
        text += '\n';
    }
    std::size_t section_1 = 0;
    for (std::size_t at = section_0; at < section_0 + 4; ++at)
        section_1 = section_1 << 8 | std::to_integer<std::size_t>(message[at]);
    const auto cut = message.begin() + static_cast<std::ptrdiff_t>(section_0 + section_1);
    std::vector<std::byte> whole(message.begin(), message.begin() + length_at);
    append_big_endian(whole, message.size() + section_header + text.size(), 8);
    whole.insert(whole.end(), message.begin() + section_0, cut);
    append_big_endian(whole, section_header + text.size(), 4);
    whole.push_back(std::byte{2});
    for (const char letter : text)
        whole.push_back(static_cast<std::byte>(letter));
    whole.insert(whole.end(), cut, message.end());
    return whole;
}

// Uses simple packing: the PNG packing of ecCodes ends the program if a map does not compress.
void pack(Message& message, long bits, const std::vector<double>& numbers) {
    message.set_text("packingType", "grid_simple");
    message.set("bitsPerValue", bits);
    message.set_values(numbers);
}

Result<std::vector<std::byte>> message_of_values(const Map& map) {
    Message message;
    describe(message, map, map.parameter.number);
    std::vector<double> values(map.values.begin(), map.values.end());
    for (double& value : values)
        if (std::isnan(value)) value = missing_value;
    message.set("bitmapPresent", 1);
    message.set_number("missingValue", missing_value);
    constexpr long bits_of_values = 16;
    pack(message, bits_of_values, values);
    return message.bytes();
}

Result<std::vector<std::byte>> message_of_states(const Map& map) {
    Message message;
    describe(message, map, local_parameter);
    constexpr long bits_of_states = 3;
    pack(message, bits_of_states, {map.states.begin(), map.states.end()});
    return message.bytes();
}

Result<std::vector<std::byte>> messages_of(const Map& map) {
    const MutexLock lock(library_mutex());
    // Keep ecCodes from printing its failures, because the results report them.
    grib_context_set_logging_proc(grib_context_get_default(),
                                  [](const grib_context*, int, const char*) {});
    const auto values = message_of_values(map);
    if (!values) return pass_on(values);
    const auto states = message_of_states(map);
    if (!states) return pass_on(states);
    std::vector<std::byte> file = with_notes(*values, map);
    const std::vector<std::byte> second = with_notes(*states, map);
    file.insert(file.end(), second.begin(), second.end());
    return file;
}

}  // namespace
}  // namespace stormcellar::grib

extern "C" __attribute__((visibility("default"))) void stormcellar_grib_map(
    const stormcellar::grib::Map& map, stormcellar::Result<std::vector<std::byte>>& bytes) {
    bytes = stormcellar::grib::messages_of(map);
}
