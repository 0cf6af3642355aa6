// Tests that files of GeoJSON and placefiles are read as their specifications say, and that damaged
// files are refused with the place of the damage.
#include "render/overlay/shape_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

UtcTime utc(std::string_view text) {
    return *parse_utc(text, {});
}

// The properties of a warning as the National Weather Service sends it.
constexpr const char* warning_json = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature",
   "properties": {"event": "Tornado Warning", "onset": "2016-06-01T10:02:00-05:00",
                  "ends": null, "expires": "2016-06-01T10:45:00-05:00"},
   "geometry": {"type": "Polygon", "coordinates":
     [[[-102, 33], [-101, 33], [-101, 34], [-102, 33]]]}},
  {"type": "Feature",
   "properties": {"name": "Levelland", "marker-color": "#0f8", "stroke-width": 3},
   "geometry": {"type": "Point", "coordinates": [-102.4, 33.6, 1000]}},
  {"type": "Feature", "properties": {}, "geometry": null}]})";

TEST(GeoJson, AWarningHasItsTimesAndTheColorOfItsEvent) {
    const auto read = shapes_of_geojson(warning_json);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->shapes.size(), 2U);
    EXPECT_EQ(read->unknown, 1U) << "a feature without a geometry";
    const OverlayShape& area = read->shapes[0];
    ASSERT_EQ(area.points.size(), 4U);
    EXPECT_EQ(area.points[1].latitude_deg, 33);
    EXPECT_EQ(area.points[1].longitude_deg, -101);
    EXPECT_EQ(area.color, (Rgba8{255, 0, 0, 255}));
    EXPECT_EQ(area.from, utc("2016-06-01T15:02:00Z"));
    EXPECT_EQ(area.until, utc("2016-06-01T15:45:00Z"));
    EXPECT_FALSE(area.is_in_force(utc("2016-06-01T15:01:59Z")));
    EXPECT_TRUE(area.is_in_force(utc("2016-06-01T15:02:00Z")));
    EXPECT_FALSE(area.is_in_force(utc("2016-06-01T15:45:00Z")));
}

TEST(GeoJson, APointHasItsNameAndStyle) {
    const auto read = shapes_of_geojson(warning_json);
    ASSERT_TRUE(read);
    const OverlayShape& town = read->shapes.at(1);
    EXPECT_EQ(town.points.size(), 1U);
    EXPECT_EQ(town.label, "Levelland");
    EXPECT_EQ(town.color, (Rgba8{0, 255, 136, 255}));
    EXPECT_EQ(town.width, 3);
    EXPECT_TRUE(town.is_in_force({})) << "without times a town is always in force";
}

TEST(GeoJson, EveryGeometryIsRead) {
    const auto shapes_in = [](const char* geometry) {
        const auto read = shapes_of_geojson(geometry);
        EXPECT_TRUE(read) << read.error().message;
        return read ? read->shapes.size() : 0;
    };
    EXPECT_EQ(shapes_in(R"({"type": "LineString", "coordinates": [[1, 2], [3, 4]]})"), 1U);
    EXPECT_EQ(shapes_in(R"({"type": "MultiPoint", "coordinates": [[1, 2], [3, 4]]})"), 2U);
    EXPECT_EQ(shapes_in(R"({"type": "MultiLineString", "coordinates":
        [[[1, 2], [3, 4]], [[5, 6], [7, 8]]]})"),
              2U);
    EXPECT_EQ(shapes_in(R"({"type": "MultiPolygon", "coordinates":
        [[[[1, 2], [3, 4], [5, 6], [1, 2]]], [[[1, 2], [3, 4], [5, 6], [1, 2]]]]})"),
              2U);
    EXPECT_EQ(shapes_in(R"({"type": "GeometryCollection", "geometries":
        [{"type": "Point", "coordinates": [1, 2]},
         {"type": "LineString", "coordinates": [[1, 2], [3, 4]]}]})"),
              2U);
    EXPECT_EQ(shapes_in(R"({"type": "Point", "coordinates": []})"), 0U);
}

// 2026-11-30: a point within a million lists ended the program.
TEST(GeoJson, AGeometryHasAsManyListsAsItsKind) {
    const auto nested = [](const std::string& type, std::size_t lists) {
        return shapes_of_geojson("{\"type\": \"" + type + "\", \"coordinates\": " +
                                 std::string(lists, '[') + "1, 2" + std::string(lists, ']') + "}");
    };
    EXPECT_EQ(nested("Point", 1)->shapes.size(), 1U);
    EXPECT_EQ(nested("MultiPoint", 2)->shapes.size(), 1U);
    for (const char* type : {"Point", "MultiPoint", "LineString", "Polygon", "MultiPolygon"})
        for (const std::size_t lists : {std::size_t{5}, std::size_t{1'000'000}})
            EXPECT_FALSE(nested(type, lists)) << type << lists;
}

// 2026-11-30: each of many points had a copy of a title of a megabyte.
TEST(GeoJson, LabelsAreShortAndLegible) {
    const std::string text = R"({"type": "Feature", "properties": {"title": ")" +
                             std::string(1'000'000, 'x') +
                             R"("}, "geometry": {"type": "MultiPoint", "coordinates": [[1, 2]]}})";
    EXPECT_EQ(shapes_of_geojson(text)->shapes.at(0).label, std::string(80, 'x'));
    const auto latin = shapes_of_placefile(
        "Place: 35, -98, Caf\xe9 Nu\xc3\xb1"
        "ez\n");
    ASSERT_TRUE(latin);
    EXPECT_EQ(latin->shapes.at(0).label,
              "Caf\\xe9 Nu\xc3\xb1"
              "ez")
        << "a byte is no UTF-8";
}

TEST(GeoJson, AnEmptyTextIsNone) {
    const auto read = shapes_of_geojson(R"({"type": "Feature",
        "properties": {"title": "", "name": "a", "onset": "", "issue": "2016-06-01T15:00:00Z"},
        "geometry": {"type": "Point", "coordinates": [1, 2]}})");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->shapes.at(0).label, "a");
    EXPECT_EQ(read->shapes.at(0).from, utc("2016-06-01T15:00:00Z"));
}

TEST(GeoJson, APropertyWithTheCommonNameOfATimeMayBeAnything) {
    const auto road = shapes_of_geojson(R"({"type": "Feature", "properties": {"begin": "Main St"},
        "geometry": {"type": "Point", "coordinates": [1, 2]}})");
    ASSERT_TRUE(road) << road.error().message;
    EXPECT_FALSE(road->shapes.at(0).from);
}

TEST(GeoJson, DamageIsNamedWithItsFeature) {
    const auto reason = [](const std::string& text) {
        const auto read = shapes_of_geojson(text);
        return read ? std::string{} : read.error().message;
    };
    EXPECT_THAT(reason("{"), HasSubstr("no valid JSON"));
    EXPECT_THAT(reason(R"({"type": "Topology"})"), HasSubstr("'Topology' is no geometry"));
    EXPECT_THAT(reason(R"({"type": "FeatureCollection"})"), HasSubstr("no features"));
    EXPECT_THAT(reason(R"({"type": "Point", "coordinates": [-97, 135]})"),
                HasSubstr("135, -97 is no place"));
    EXPECT_THAT(reason(R"({"type": "Point", "coordinates": ["a", 1]})"), HasSubstr("two numbers"));
    EXPECT_THAT(reason(R"({"type": "Feature", "properties": {"expires": "soon"}})"),
                HasSubstr("'soon' is no time"));
    EXPECT_THAT(reason(R"({"type": "Feature", "properties": {"expires": "-1h"}})"),
                HasSubstr("'-1h' is no time"));
    EXPECT_THAT(reason(R"({"type": "Feature", "properties": {"stroke": "#12345"}})"),
                HasSubstr("'#12345' is no color"));
    EXPECT_THAT(reason(R"({"type": "FeatureCollection", "features":
        [{"type": "Point", "coordinates": [1, 2]}, 3]})"),
                HasSubstr("feature 1"));
    EXPECT_THAT(reason(R"({"type": "GeometryCollection", "geometries":
        [{"type": "GeometryCollection", "geometries": []}]})"),
                HasSubstr("in another one"));
}

constexpr const char* placefile_text = R"(; a comment
Title: Spotters
RefreshSeconds: 60
Color: 255 128 0
TimeRange: 2016-06-01T15:00:00Z 2016-06-01T16:00:00Z
Line: 4, 0, "a road, closed"
33.5, -102.0
33.6, -101.9
End:
Polygon:
33, -102
33, -101
34, -101
End:
Text: 33.7, -101.8, 1, "Lubbock, TX"
Object: 34.0, -101.5
Icon: 0, 0, 45, 1, 1, "hover"
Text: 10, 0, 1, "spotter"
Line: 1, 0
0, 0
5, 5
End:
)";

TEST(Placefile, IsReadAsItsSpecificationHasIt) {
    const auto read = shapes_of_placefile(placefile_text);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->shapes.size(), 5U);
    EXPECT_EQ(read->unknown, 1U) << "a line in an object";
    const OverlayShape& road = read->shapes[0];
    EXPECT_EQ(road.points.size(), 2U);
    EXPECT_EQ(road.width, 4);
    EXPECT_EQ(road.color, (Rgba8{255, 128, 0, 255}));
    EXPECT_EQ(road.from, utc("2016-06-01T15:00:00Z"));
    EXPECT_EQ(road.until, utc("2016-06-01T16:00:00Z"));
    const OverlayShape& area = read->shapes[1];
    ASSERT_EQ(area.points.size(), 4U) << "closed";
    EXPECT_EQ(area.points[3].latitude_deg, area.points[0].latitude_deg);
    EXPECT_EQ(read->shapes[2].label, "Lubbock, TX");
    EXPECT_EQ(read->shapes[3].label, "");
    EXPECT_EQ(read->shapes[3].points[0].latitude_deg, 34)
        << "an icon is at the place of its object";
    EXPECT_EQ(read->shapes[4].label, "spotter");
}

// Places of lines in an object are pixels. The text after the line is at the place of the object.
TEST(Placefile, ABlockInAnObjectEndsByItself) {
    const auto read = shapes_of_placefile(
        "Object: 35, -97\nLine: 2, 0\n0, 0\n10, 10\nEnd:\nText: 120, 0, 1, \"a\"\nEnd:\n"
        "Text: 36, -98, 1, \"b\"\n");
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->shapes.size(), 2U);
    EXPECT_EQ(read->shapes[0].points[0].latitude_deg, 35);
    EXPECT_EQ(read->shapes[1].points[0].latitude_deg, 36);
}

TEST(Placefile, APolygonMayHaveContoursAndComments) {
    const auto read = shapes_of_placefile(
        "Polygon:\n35, -98 ; first\n35, -97\n36, -97\n35, -98\n33, -98\n33, -97\n34, -97\nEnd:\n");
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->shapes.size(), 2U);
    EXPECT_EQ(read->shapes[0].points.size(), 4U);
    EXPECT_EQ(read->shapes[1].points.size(), 4U) << "the last contour is closed, too";
}

TEST(Placefile, DamageIsNamedWithItsLine) {
    const auto reason = [](const std::string& text) {
        const auto read = shapes_of_placefile(text);
        return read ? std::string{} : read.error().message;
    };
    EXPECT_THAT(reason(""), HasSubstr("neither GeoJSON nor placefile"));
    EXPECT_THAT(reason("Title: a\nhello\n"), HasSubstr("line 2: it is no statement"));
    EXPECT_THAT(reason("Line: 1\n33, x\nEnd:\n"), HasSubstr("line 2: '33' does not begin"));
    EXPECT_THAT(reason("Color: 1 2\n"), HasSubstr("line 1: '1 2' is no color"));
    EXPECT_THAT(reason("Color: nan nan nan\n"), HasSubstr("is no color"));
    EXPECT_THAT(reason("Text:" + std::string(20'000, ',')), HasSubstr("line 1 is too long"));
    EXPECT_THAT(reason("TimeRange: now then\n"), HasSubstr("'now' is no time"));
    EXPECT_THAT(reason("Text: 95, 0, 1, \"x\"\n"), HasSubstr("95, 0 is no place"));
}

TEST(ShapeFile, IsToldApartByItsFirstLetterAndNamedInErrors) {
    const testing::TemporaryDirectory directory;
    const auto read = [&](const char* name, std::string_view text) {
        std::ofstream(directory / name) << text;
        return read_shape_file(directory / name);
    };
    const auto json = read("a.txt", std::string("\xEF\xBB\xBF\n") + warning_json);
    ASSERT_TRUE(json) << json.error().message;
    EXPECT_EQ(json->shapes.size(), 2U);
    const auto places = read("b.json", placefile_text);
    ASSERT_TRUE(places);
    EXPECT_EQ(places->shapes.size(), 5U);
    const auto none = read_shape_file(directory / "none");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::not_found);
    const auto damaged = read("c.json", "{]");
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().code, ErrorCode::corrupt);
    EXPECT_THAT(damaged.error().message, HasSubstr("c.json"));
}

}  // namespace
}  // namespace stormcellar::render
