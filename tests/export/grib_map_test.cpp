#include "export/grib_map.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <eccodes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/projection.h"

namespace stormcellar::grib {
namespace {

using ::testing::HasSubstr;

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

struct Delete {
    void operator()(codes_handle* handle) const { codes_handle_delete(handle); }
};
using Handle = std::unique_ptr<codes_handle, Delete>;

// Returns the messages of a file, as ecCodes finds them.
std::vector<Handle> messages_in(const std::vector<std::byte>& file) {
    std::vector<Handle> messages;
    std::vector<std::byte> rest = file;
    while (!rest.empty()) {
        std::uint64_t size = 0;
        for (std::size_t at = 8; at < 16; ++at)
            size = size << 8 | std::to_integer<std::uint64_t>(rest[at]);
        messages.emplace_back(codes_handle_new_from_message_copy(nullptr, rest.data(), size));
        EXPECT_EQ(std::memcmp(rest.data() + size - 4, "7777", 4), 0);
        rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return messages;
}

long number_of(const Handle& message, const char* key) {
    long number = -1;
    EXPECT_EQ(codes_get_long(message.get(), key, &number), 0) << key;
    return number;
}

// The values with NaN where they are missing, and the places of the columns.
struct Read {
    std::vector<double> values, latitudes_deg, longitudes_deg;
};
Read read(const Handle& message) {
    Read all;
    int error = 0;
    codes_set_double(message.get(), "missingValue", 1e30);
    codes_iterator* iterator = codes_grib_iterator_new(message.get(), 0, &error);
    EXPECT_EQ(error, 0) << codes_get_error_message(error);
    if (iterator == nullptr) return all;
    double latitude = 0, longitude = 0, value = 0;
    while (codes_grib_iterator_next(iterator, &latitude, &longitude, &value) != 0) {
        all.values.push_back(value == 1e30 ? std::nan("") : value);
        all.latitudes_deg.push_back(latitude);
        all.longitudes_deg.push_back(longitude);
    }
    codes_grib_iterator_delete(iterator);
    return all;
}

grid::GridSpec degrees_spec() {
    grid::GridSpec spec;
    spec.projection = grid::Projection::latitude_longitude;
    spec.center_latitude_deg = 35.25;
    spec.center_longitude_deg = -97.5;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.01;
    spec.nx = 30;
    spec.ny = 20;
    spec.levels_m = {1000};
    return spec;
}

grid::GridSpec lambert_spec(std::array<double, 2> parallels_deg) {
    grid::GridSpec spec;
    spec.projection = grid::Projection::lambert_conformal;
    spec.center_latitude_deg = (parallels_deg[0] + parallels_deg[1]) / 2;
    spec.center_longitude_deg = -97.5;
    spec.parallels_deg = parallels_deg;
    spec.spacing_m = 2000;
    spec.nx = 40;
    spec.ny = 50;
    spec.levels_m = {1000};
    return spec;
}

// Values from -12 to 70 and holes.
struct Content {
    std::vector<float> values;
    std::vector<std::uint8_t> states;
    explicit Content(const grid::GridSpec& spec) {
        for (std::size_t at = 0; at < spec.column_count(); ++at) {
            const bool has_value = at % 7 != 3;
            values.push_back(has_value ? -12 + 0.137F * static_cast<float>(at % 600) : nothing);
            states.push_back(has_value ? 3 : static_cast<std::uint8_t>(at % 3));
        }
    }
};

Map map_of(const grid::GridSpec& spec, const Content& content) {
    return {.spec = spec,
            .parameter = {.discipline = 0, .category = 16, .number = 5, .surface = 10},
            .time = UtcTime{std::chrono::seconds{1'600'000'000}},
            .since = {},
            .values = content.values,
            .states = content.states,
            .notes = {{"gridding", "column-linear; 4/3 earth"}, {"gridding_error", "0.4\ndBZ"}}};
}

void expect_places(const Read& read, const grid::GridSpec& spec, double within_deg) {
    const grid::GridProjection projection(spec);
    ASSERT_EQ(read.values.size(), spec.column_count());
    for (std::size_t at = 0; at < read.values.size(); ++at) {
        const auto width = static_cast<std::size_t>(spec.nx);
        const grid::GeoPoint place =
            projection.to_geo({static_cast<double>(at % width), static_cast<double>(at / width)});
        ASSERT_NEAR(read.latitudes_deg[at], place.latitude_deg, within_deg) << at;
        ASSERT_NEAR(std::remainder(read.longitudes_deg[at] - place.longitude_deg, 360), 0,
                    within_deg)
            << at;
    }
}

void expect_content(const std::vector<Handle>& messages, const Content& content) {
    const Read values = read(messages[0]), states = read(messages[1]);
    ASSERT_EQ(values.values.size(), content.values.size());
    for (std::size_t at = 0; at < content.values.size(); ++at) {
        ASSERT_EQ(std::isnan(values.values[at]), std::isnan(content.values[at])) << at;
        if (!std::isnan(content.values[at])) {
            ASSERT_NEAR(values.values[at], content.values[at], 82.0 / 65'000) << at;
        }
        ASSERT_EQ(states.values[at], content.states[at]) << at;
    }
}

TEST(GribMap, EcCodesReadsValuesStatesAndPlacesOfAGridInDegrees) {
    const grid::GridSpec spec = degrees_spec();
    const Content content(spec);
    const auto bytes = map_bytes(map_of(spec, content));
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto messages = messages_in(*bytes);
    ASSERT_EQ(messages.size(), 2U);
    expect_content(messages, content);
    for (const Handle& message : messages) {
        expect_places(read(message), spec, 1e-6);
        EXPECT_EQ(number_of(message, "discipline"), 0);
        EXPECT_EQ(number_of(message, "parameterCategory"), 16);
        EXPECT_EQ(number_of(message, "typeOfFirstFixedSurface"), 10);
        EXPECT_EQ(number_of(message, "shapeOfTheEarth"), 5);
        EXPECT_EQ(number_of(message, "centre"), 255);
        EXPECT_EQ(number_of(message, "dataDate"), 20200913);
        EXPECT_EQ(number_of(message, "hour") * 3600 + number_of(message, "minute") * 60 +
                      number_of(message, "second"),
                  12 * 3600 + 26 * 60 + 40);
    }
    EXPECT_EQ(number_of(messages[0], "parameterNumber"), 5);
    EXPECT_EQ(number_of(messages[1], "parameterNumber"), 192);
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    EXPECT_THAT(text, HasSubstr("gridding: column-linear; 4/3 earth\ngridding_error: 0.4 dBZ\n"));
}

TEST(GribMap, EcCodesReadsThePlacesOfALambertGridInBothHemispheres) {
    for (const auto& parallels :
         {std::array{30.0, 40.0}, std::array{35.0, 35.0}, std::array{-40.0, -30.0}}) {
        const grid::GridSpec spec = lambert_spec(parallels);
        const Content content(spec);
        const auto bytes = map_bytes(map_of(spec, content));
        ASSERT_TRUE(bytes) << bytes.error().message;
        const auto messages = messages_in(*bytes);
        expect_content(messages, content);
        expect_places(read(messages[0]), spec, 2e-6);
    }
}

TEST(GribMap, HasTheHeightOfALevelAndTheSpanOfASum) {
    const grid::GridSpec spec = degrees_spec();
    const Content content(spec);
    Map map = map_of(spec, content);
    map.parameter.surface = 102;
    map.parameter.height_m = 2500;
    map.since = map.time - std::chrono::minutes{90};
    const auto bytes = map_bytes(map);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto messages = messages_in(*bytes);
    EXPECT_EQ(number_of(messages[0], "scaledValueOfFirstFixedSurface"), 2500);
    EXPECT_EQ(number_of(messages[0], "productDefinitionTemplateNumber"), 8);
    EXPECT_EQ(number_of(messages[0], "lengthOfTimeRange"), 5400);
    EXPECT_EQ(number_of(messages[0], "minuteOfEndOfOverallTimeInterval"), 26);
    EXPECT_EQ(number_of(messages[0], "hour"), 10);
    EXPECT_EQ(number_of(messages[0], "minute"), 56);
}

TEST(GribMap, HoldsMapsWithOneValueOrNone) {
    const grid::GridSpec spec = degrees_spec();
    for (const float value : {nothing, 45.5F}) {
        Content content(spec);
        content.values.assign(content.values.size(), nothing);
        content.values[17] = value;
        content.states.assign(content.states.size(), 1);
        const auto bytes = map_bytes(map_of(spec, content));
        ASSERT_TRUE(bytes) << bytes.error().message;
        expect_content(messages_in(*bytes), content);
    }
}

// 2026-11-30: the PNG packing of ecCodes ended the program if a map did not compress.
TEST(GribMap, HoldsNoise) {
    const grid::GridSpec spec = degrees_spec();
    Content content(spec);
    std::uint32_t random = 1;
    for (std::size_t at = 0; at < content.values.size(); ++at) {
        random = random * 1664525 + 1013904223;
        content.values[at] = 80.0F * static_cast<float>(random >> 8) / (1 << 24);
        content.states[at] = static_cast<std::uint8_t>(random >> 29) % 6;
    }
    const auto bytes = map_bytes(map_of(spec, content));
    ASSERT_TRUE(bytes) << bytes.error().message;
    expect_content(messages_in(*bytes), content);
}

TEST(GribMap, RefusesWhatItCannotPlace) {
    grid::GridSpec spec = degrees_spec();
    const Content content(spec);
    Map map = map_of(spec, content);
    map.states = map.states.first(5);
    EXPECT_EQ(map_bytes(map).error().code, ErrorCode::bad_argument);
    grid::GridSpec plane = grid::default_spec(35, -97);
    const Content on_plane(plane);
    const auto bytes = map_bytes(map_of(plane, on_plane));
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::unsupported);
    EXPECT_THAT(bytes.error().message, HasSubstr("--projection latitude_longitude"));
}

}  // namespace
}  // namespace stormcellar::grib
