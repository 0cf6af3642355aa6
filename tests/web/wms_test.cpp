// Tests the Web Map Service with a real volume. Compares pictures with the grid's cells, pixel by
// pixel in each coordinate system, reads pictures with GDAL's driver, and tests refusals.
#include "web/doors/wms/wms.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/program.h"
#include "tests/web/asked.h"
#include "tests/web/pictured_storm.h"
#include "tests/web/served_grids.h"
#include "tests/web/setup_below.h"
#include "web/service/web_service.h"

namespace stormcellar::web {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double meters_of_degree = render::mercator_edge_m / 180;

class Wms : public MapDoorTest<WmsDoor> {
  protected:
    Answer get(const std::string& query, Fields headers = {}) {
        return asked(*door_, "/wms?" + query, std::move(headers));
    }
    Answer map(const std::string& rest) {
        return get("SERVICE=WMS&VERSION=1.3.0&REQUEST=GetMap&FORMAT=image/png&STYLES=&" + rest);
    }
    static render::Image image_of(const Answer& answer) {
        EXPECT_EQ(answer.status, 200u) << body_of(answer);
        return decoded_png(body_of(answer));
    }
};

constexpr const char* some_map =
    "LAYERS=KTLX:composite.REF&CRS=CRS:84&BBOX=-99,34,-96,37&WIDTH=150&HEIGHT=150";

// Compares pixels with the cells at their places. The server interpolates places on a mesh, so a
// pixel close to a cell's edge may show the neighboring cell.
template <class PlaceOf>
void expect_cells(const render::Image& image, const OpenGrid& grid, const PlaceOf& place_of) {
    const auto style = map_style({render::Product::composite, grid.moment}, {}, {});
    ASSERT_TRUE(style);
    int wrong = 0, shown = 0;
    for (int y = 0; y < image.height; y += 2) {
        for (int x = 0; x < image.width; x += 2) {
            const render::Rgba8 color = composite_color_at(
                grid, style->scene,
                place_of((x + 0.5) / image.width, (image.height - y - 0.5) / image.height));
            if (image.at(x, y) != color) ++wrong;
            if (color[3] == 255) ++shown;
        }
    }
    EXPECT_GT(shown, 500);
    EXPECT_LE(wrong, image.width * image.height / 4 / 100);
}

TEST_F(Wms, EachPixelShowsTheCellAtItsPlaceInEachSystem) {
    const auto grid = storm_->grid(level2::Moment::ref);
    const auto in_degrees = [](double east, double north) {
        return grid::GeoPoint{34 + 3 * north, -99 + 3 * east};
    };
    const std::string clear = "LAYERS=KTLX:composite.REF&TRANSPARENT=TRUE&WIDTH=300&HEIGHT=300";
    expect_cells(image_of(map(clear + "&CRS=EPSG:4326&BBOX=34,-99,37,-96")), *grid, in_degrees);
    expect_cells(image_of(map(clear + "&CRS=CRS:84&BBOX=-99,34,-96,37")), *grid, in_degrees);
    expect_cells(
        image_of(get("VERSION=1.1.1&REQUEST=GetMap&SRS=EPSG:4326&BBOX=-99,34,-96,37&" + clear)),
        *grid, in_degrees);
    const double south = render::mercator_y_m(34);
    const double north = render::mercator_y_m(37);
    const std::string box =
        fmt::format("&CRS=EPSG:3857&BBOX={:.4f},{:.4f},{:.4f},{:.4f}", -99 * meters_of_degree,
                    south, -96 * meters_of_degree, north);
    expect_cells(image_of(map(clear + box)), *grid, [&](double east, double up) {
        const double y = south + up * (north - south);
        const double latitude =
            std::atan(std::sinh(y / render::mercator_radius_m)) * 180 / std::numbers::pi;
        return grid::GeoPoint{latitude, -99 + 3 * east};
    });
}

TEST_F(Wms, NamesOfParametersMayHaveAnyCase) {
    const Answer upper = map(some_map);
    const Answer lower =
        get("service=WMS&version=1.3.0&request=GetMap&layers=KTLX:composite.REF&crs=CRS:84&"
            "bbox=-99,34,-96,37&width=150&height=150&format=image/png&DPI=96&tiled=true");
    EXPECT_EQ(lower.status, 200u) << body_of(lower);
    EXPECT_EQ(body_of(lower), body_of(upper));
}

TEST_F(Wms, GroundIsWhiteUnlessAskedForOtherwise) {
    const render::Image white = image_of(map(some_map));
    const render::Image blue = image_of(map(std::string(some_map) + "&BGCOLOR=0x0000ff"));
    const render::Image clear = image_of(map(std::string(some_map) + "&TRANSPARENT=TRUE"));
    int grounds = 0;
    for (int y = 0; y < clear.height; ++y) {
        for (int x = 0; x < clear.width; ++x) {
            ASSERT_EQ(white.at(x, y)[3], 255);
            if (clear.at(x, y)[3] != 0) continue;
            ++grounds;
            ASSERT_EQ(white.at(x, y), (render::Rgba8{255, 255, 255, 255}));
            ASSERT_EQ(blue.at(x, y), (render::Rgba8{0, 0, 255, 255}));
        }
    }
    EXPECT_GT(grounds, 1000);
}

TEST_F(Wms, LayersLieOneOverAnother) {
    const std::string rest = "&CRS=CRS:84&BBOX=-99,34,-96,37&WIDTH=150&HEIGHT=150&TRANSPARENT=TRUE";
    const render::Image below = image_of(map("LAYERS=KTLX:composite.VEL" + rest));
    const render::Image above = image_of(map("LAYERS=KTLX:composite.REF" + rest));
    const render::Image both = image_of(map("LAYERS=KTLX:composite.VEL,KTLX:composite.REF" + rest));
    int solid = 0, below_alone = 0;
    for (int y = 0; y < both.height; ++y) {
        for (int x = 0; x < both.width; ++x) {
            if (above.at(x, y)[3] == 255) {
                ++solid;
                ASSERT_EQ(both.at(x, y), above.at(x, y));
            } else if (above.at(x, y)[3] == 0 && below.at(x, y)[3] == 255) {
                ++below_alone;
                ASSERT_EQ(both.at(x, y), below.at(x, y));
            }
        }
    }
    EXPECT_GT(solid, 500);
    EXPECT_GT(below_alone, 20);
}

TEST_F(Wms, TimeIsTheNearestWithinAnHourAndIsTold) {
    const std::string exact = std::string(some_map) + "&TIME=" + PicturedStorm::time;
    const Answer named = map(exact);
    EXPECT_EQ(named.status, 200u) << body_of(named);
    EXPECT_EQ(header_of(named, "Warning"), "");
    EXPECT_EQ(header_of(named, "Cache-Control"), "max-age=300");
    const Answer newest = map(some_map);
    EXPECT_EQ(header_of(newest, "Warning"),
              "99 stormcellar \"Default value used: time=1999-05-03T23:56:21Z\"");
    EXPECT_EQ(header_of(newest, "Cache-Control"), "no-cache");
    const Answer near = map(std::string(some_map) + "&TIME=1999-05-04T00:50Z");
    EXPECT_EQ(header_of(near, "Warning"),
              "99 stormcellar \"Nearest value used: time=1999-05-03T23:56:21Z\"");
    EXPECT_EQ(body_of(near), body_of(named));
    EXPECT_EQ(body_of(map(std::string(some_map) + "&TIME=current")), body_of(named));
    const Answer far = map(std::string(some_map) + "&TIME=1999-05-04T01:10Z");
    EXPECT_EQ(far.status, 404u);
    EXPECT_THAT(body_of(far), HasSubstr("code=\"InvalidDimensionValue\""));
}

TEST_F(Wms, PicturesAreKeptAndHaveTags) {
    const std::string query =
        "VERSION=1.3.0&REQUEST=GetMap&STYLES=&FORMAT=image/png&" + std::string(some_map);
    EXPECT_FALSE(door_->answer_at_once(request_for("/wms?" + query))) << "nothing is kept yet";
    const std::string etag = header_of(get(query), "ETag");
    const auto kept = door_->answer_at_once(request_for("/wms?" + query));
    ASSERT_TRUE(kept);
    EXPECT_EQ(header_of(*kept, "ETag"), etag);
    EXPECT_EQ(get(query, {{"If-None-Match", etag}}).status, 304u);
}

TEST_F(Wms, StylesAreColorTablesAndOptionsApply) {
    const std::string rest =
        "LAYERS=KTLX:composite.REF&CRS=CRS:84&BBOX=-99,34,-96,37&WIDTH=150&"
        "HEIGHT=150&VERSION=1.3.0&REQUEST=GetMap&FORMAT=image/png&STYLES=";
    const std::string usual = body_of(get(rest));
    EXPECT_EQ(body_of(get(rest + "default")), usual);
    EXPECT_NE(body_of(get(rest + "nws")), usual);
    EXPECT_EQ(body_of(get(rest + "nws")), body_of(get(rest + "&colors=nws")));
    EXPECT_NE(body_of(get(rest + "&smooth=cubic")), usual);
    EXPECT_EQ(body_of(get(rest + "&height-km=5")), usual)
        << "height-km has no effect on a composite";
    const Answer unknown = get(rest + "pink");
    EXPECT_EQ(unknown.status, 400u);
    EXPECT_THAT(body_of(unknown), HasSubstr("code=\"StyleNotDefined\""));
}

TEST_F(Wms, FeatureInfoIsTheCellUnderThePixel) {
    const auto grid = storm_->grid(level2::Moment::ref);
    const std::string query = "VERSION=1.3.0&REQUEST=GetFeatureInfo&STYLES=&" +
                              std::string(some_map) +
                              "&QUERY_LAYERS=KTLX:composite.REF,KTLX:echotop&INFO_FORMAT=";
    const auto style = map_style({}, {}, {});
    int values = 0;
    for (int row = 3; row < 150; row += 14) {
        for (int column = 3; column < 150; column += 14) {
            const auto json = nlohmann::json::parse(
                body_of(get(query + fmt::format("application/json&I={}&J={}", column, row))));
            ASSERT_EQ(json["features"].size(), 2u);
            const auto& found = json["features"][0];
            const grid::GeoPoint place{37 - 3 * (row + 0.5) / 150, -99 + 3 * (column + 0.5) / 150};
            ASSERT_NEAR(found["geometry"]["coordinates"][1], place.latitude_deg, 1e-9);
            const render::Rgba8 color = composite_color_at(*grid, style->scene, place);
            const auto& properties = found["properties"];
            if (properties["status"] == "value") {
                ++values;
                ASSERT_EQ(render::color_of(render::colors_of(style->scene), properties["value"])
                              .value_or(render::Rgba8{0, 0, 0, 0}),
                          color);
            } else {
                ASSERT_EQ(color[3], properties["status"] == "not seen" ? 72 : 0);
            }
        }
    }
    EXPECT_GT(values, 20);
    EXPECT_THAT(body_of(get(query + "text/plain&I=3&J=3")),
                HasSubstr("KTLX:composite.REF (1999-05-03T23:56:21Z): "));
    EXPECT_THAT(body_of(get(query + "text/plain&I=150&J=3")), HasSubstr("InvalidPoint"));
}

TEST(WmsOfDealiasedVelocity, ShowsAndNamesAmbiguousCells) {
    ServedGrids served;
    const grid::Grid grid = testing::ambiguous_grid();
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
    ASSERT_TRUE(served.store().commit("KBGM", cache::describe(grid), bricks.view()));
    WmsDoor door(std::make_shared<MapPictures>(MapPicturesOptions{.grids = served.shared_grids()}));
    const auto get = [&](const std::string& query) {
        return body_of(asked(door,
                             "/wms?SERVICE=WMS&VERSION=1.3.0&STYLES=&CRS=CRS:84&BBOX=-75.86,"
                             "42.12,-75.8,42.18&WIDTH=60&HEIGHT=60&LAYERS=KBGM:composite.VELD"
                             "&FORMAT=image/png&TRANSPARENT=TRUE&" +
                                 query));
    };
    const render::Image image = decoded_png(get("REQUEST=GetMap"));
    ASSERT_EQ(image.width, 60);
    const auto style = map_style({render::Product::composite, grid.moment}, {}, {});
    render::Rgba8 half_transparent = render::colors_of(style->scene).range_folded;
    half_transparent[3] /= 2;
    EXPECT_EQ(image.at(30, 30), half_transparent);
    const auto json = nlohmann::json::parse(
        get("REQUEST=GetFeatureInfo&QUERY_LAYERS=KBGM:composite.VELD&INFO_FORMAT=application/json"
            "&I=30&J=30"));
    EXPECT_EQ(json["features"][0]["properties"]["status"], "ambiguous") << json;
}

TEST_F(Wms, LegendShowsTheColors) {
    const std::string query = "REQUEST=GetLegendGraphic&VERSION=1.3.0&FORMAT=image/png&LAYER=";
    const render::Image usual = image_of(get(query + "KTLX:composite.REF"));
    EXPECT_GT(usual.width, 80);
    EXPECT_GT(usual.height, 240);
    EXPECT_NE(body_of(get(query + "KTLX:composite.REF&STYLE=nws")),
              body_of(get(query + "KTLX:composite.REF")));
}

// JPEG has no transparency, so the background is opaque even with TRANSPARENT=TRUE.
TEST_F(Wms, JpegIsGivenWhereItIsAskedFor) {
    const std::string query =
        "VERSION=1.3.0&REQUEST=GetMap&LAYERS=KTLX:composite.REF&CRS=CRS:84&BBOX=-99,34,-96,37"
        "&WIDTH=64&HEIGHT=64&FORMAT=";
    const Answer jpeg = get(query + "image/jpeg");
    ASSERT_EQ(jpeg.status, 200u);
    EXPECT_EQ(header_of(jpeg, "Content-Type"), "image/jpeg");
    EXPECT_TRUE(body_of(jpeg).starts_with("\xFF\xD8\xFF"));
    EXPECT_EQ(body_of(get(query + "image/jpeg&TRANSPARENT=TRUE")), body_of(jpeg));
    EXPECT_NE(body_of(get(query + "image/jpeg&BGCOLOR=0x000000")), body_of(jpeg));
    const Answer png = get(query + "image/png");
    EXPECT_EQ(header_of(png, "Content-Type"), "image/png");
    EXPECT_NE(header_of(png, "ETag"), header_of(jpeg, "ETag"));
}

TEST_F(Wms, CapabilitiesNameLayersTimesAndBoxes) {
    const Answer answer = get("SERVICE=WMS&REQUEST=GetCapabilities");
    EXPECT_EQ(answer.status, 200u);
    EXPECT_EQ(header_of(answer, "Content-Type"), "text/xml; charset=utf-8");
    const std::string text = body_of(answer);
    EXPECT_THAT(text, HasSubstr("<WMS_Capabilities version=\"1.3.0\""));
    for (const char* name : {"composite.REF", "composite.VEL", "cappi.REF", "vil", "echotop"})
        EXPECT_THAT(text, HasSubstr(fmt::format("<Name>KTLX:{}</Name>", name)));
    EXPECT_THAT(text, HasSubstr("<Dimension name=\"time\" units=\"ISO8601\" "
                                "default=\"1999-05-03T23:56:21Z\" nearestValue=\"1\" current=\"1\">"
                                "1999-05-03T23:56:21Z</Dimension>"));
    EXPECT_THAT(text, HasSubstr("xlink:href=\"http://localhost:8090/wms?\""));
    EXPECT_THAT(text, HasSubstr("<BoundingBox CRS=\"EPSG:4326\" minx=\"33."));
    EXPECT_THAT(text, HasSubstr("<Name>nws</Name>"));
}

// 2026-11-28: a volume with a date in the future was the default time, but GetMap did not draw it.
TEST(WmsTimes, ATimeOfTheFutureIsNotTheDefault) {
    ServedGrids served;
    const UtcTime future = now_utc() + std::chrono::days{180};
    ASSERT_TRUE(testing::commit_sized(served.store(), "KBGM", future));
    served.grids().refresh();
    WmsDoor door(std::make_shared<MapPictures>(MapPicturesOptions{.grids = served.shared_grids()}));
    for (const char* const version : {"1.3.0", "1.1.1"}) {
        const std::string text = body_of(asked(
            door, fmt::format("/wms?SERVICE=WMS&VERSION={}&REQUEST=GetCapabilities", version)));
        EXPECT_THAT(text, HasSubstr("default=\"2024-11-22T12:05:00Z\"")) << version;
        EXPECT_THAT(text, HasSubstr(format_utc(future).substr(0, 10))) << version;
    }
}

// 2026-11-28: QGIS saw no times, because it does not inherit them from the layer above.
TEST_F(Wms, EachNamedLayerHasItsTimes) {
    const std::string text = body_of(get("SERVICE=WMS&REQUEST=GetCapabilities"));
    std::size_t layers = 0;
    for (std::size_t at = text.find("<Name>KTLX:"); at != std::string::npos;
         at = text.find("<Name>KTLX:", at + 1)) {
        ++layers;
        const std::string layer = text.substr(at, text.find("</Layer>", at) - at);
        EXPECT_THAT(layer, HasSubstr("<Dimension name=\"time\"")) << layer.substr(0, 40);
        EXPECT_LT(layer.find("<Dimension"), layer.find("<Style>")) << "the schema has this order";
    }
    EXPECT_GT(layers, 5u);
}

// 2026-11-28: OWSLib asks for 1.1.1 unless told otherwise, and failed at the document of 1.3.0.
TEST_F(Wms, OlderClientsGetADocumentOfTheirOwn) {
    const Answer answer = get("SERVICE=WMS&VERSION=1.1.1&REQUEST=GetCapabilities");
    EXPECT_EQ(header_of(answer, "Content-Type"), "application/vnd.ogc.wms_xml");
    const std::string text = body_of(answer);
    for (const char* part :
         {"<WMT_MS_Capabilities version=\"1.1.1\">", "<Name>OGC:WMS</Name>",
          "<SRS>EPSG:900913</SRS>", "<LatLonBoundingBox minx=\"-", "<BoundingBox SRS=\"EPSG:3857\"",
          "<Dimension name=\"time\" units=\"ISO8601\"/>",
          "<Extent name=\"time\" default=\"1999-05-03T23:56:21Z\" nearestValue=\"1\">"
          "1999-05-03T23:56:21Z</Extent>"})
        EXPECT_THAT(text, HasSubstr(part));
    for (const char* part : {"CRS", "EX_Geographic", "LayerLimit", "opengis.net/wms\""})
        EXPECT_THAT(text, Not(HasSubstr(part)));
    EXPECT_THAT(body_of(get("VERSION=1.0.0&REQUEST=capabilities")), HasSubstr("WMT_MS_Capab"));
    const Answer fault = get("VERSION=1.1.1&REQUEST=GetMap");
    EXPECT_EQ(header_of(fault, "Content-Type"), "application/vnd.ogc.se_xml");
    EXPECT_THAT(body_of(fault), HasSubstr("<ServiceExceptionReport version=\"1.1.1\">"));
}

TEST_F(Wms, TheOlderNameOfWebMercatorIsKnown) {
    const std::string rest =
        "VERSION=1.1.1&REQUEST=GetMap&LAYERS=KTLX:vil&STYLES=&FORMAT=image/png&WIDTH=20&HEIGHT=20&"
        "BBOX=-11000000,4000000,-10700000,4300000&SRS=";
    const Answer older = get(rest + "EPSG:900913");
    EXPECT_EQ(older.status, 200u) << body_of(older);
    EXPECT_EQ(body_of(older), body_of(get(rest + "EPSG:3857")));
}

// 2026-11-28: capabilities of 150 kB were sent uncompressed; gzip makes 5 kB of them.
TEST_F(Wms, CapabilitiesAreCompressedForWhoTakesThat) {
    const Answer plain = get("REQUEST=GetCapabilities");
    const Answer gzip = get("REQUEST=GetCapabilities", {{"Accept-Encoding", "gzip"}});
    EXPECT_EQ(header_of(gzip, "Content-Encoding"), "gzip");
    EXPECT_EQ(header_of(gzip, "Vary"), "Accept-Encoding");
    EXPECT_LT(body_of(gzip).size() * 8, body_of(plain).size());
    EXPECT_NE(header_of(gzip, "ETag"), header_of(plain, "ETag"));
    const Answer unchanged =
        get("REQUEST=GetCapabilities",
            {{"Accept-Encoding", "gzip"}, {"If-None-Match", header_of(gzip, "ETag")}});
    EXPECT_EQ(unchanged.status, 304u);
}

TEST_F(Wms, ADomainHasCapabilitiesOfItsOwn) {
    const Answer own = asked(*door_, "/wms/KTLX?REQUEST=GetCapabilities");
    EXPECT_THAT(body_of(own), HasSubstr("<Name>KTLX:vil</Name>"));
    EXPECT_THAT(body_of(own), HasSubstr("xlink:href=\"http://localhost:8090/wms/KTLX?\""));
    EXPECT_EQ(asked(*door_, "/wms/KXXX?REQUEST=GetCapabilities").status, 404u);
}

TEST_F(Wms, RefusesWhatMakesNoSense) {
    const std::string box = "&BBOX=-99,34,-96,37&WIDTH=10&HEIGHT=10";
    const std::string asked = "VERSION=1.3.0&REQUEST=GetMap&FORMAT=image/png&STYLES=&";
    const std::vector<std::tuple<std::string, unsigned, std::string>> refusals = {
        {"", 400, "OperationNotSupported"},
        {"REQUEST=GetFlowers", 400, "OperationNotSupported"},
        {"REQUEST=GetCapabilities&SERVICE=WFS", 400, ""},
        {asked + "CRS=CRS:84" + box, 400, "LayerNotDefined"},
        {asked + "LAYERS=KTLX&CRS=CRS:84" + box, 404, "LayerNotDefined"},
        {asked + "LAYERS=KTLX:volume&CRS=CRS:84" + box, 404, "LayerNotDefined"},
        {asked + "LAYERS=KXXX:composite.REF&CRS=CRS:84" + box, 404, "LayerNotDefined"},
        {asked + "LAYERS=KTLX:composite.ZDR&CRS=CRS:84" + box, 404, "LayerNotDefined"},
        {asked + "LAYERS=KTLX:vil&CRS=EPSG:2154" + box, 400, "InvalidCRS"},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&WIDTH=10&HEIGHT=10", 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&BBOX=-96,34,-99,37&WIDTH=10&HEIGHT=10", 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&BBOX=-99,34,nan,37&WIDTH=10&HEIGHT=10", 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&BBOX=-1e9,34,1e9,37&WIDTH=10&HEIGHT=10", 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&BBOX=-99,34,-96,37&WIDTH=0&HEIGHT=10", 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&BBOX=-99,34,-96,37&WIDTH=10&HEIGHT=4097", 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&TRANSPARENT=maybe" + box, 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&BGCOLOR=red" + box, 400, ""},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&TIME=soon" + box, 400, "InvalidDimensionValue"},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&TIME=1999-05-03/1999-05-04" + box, 400,
         "InvalidDimensionValue"},
        {asked + "LAYERS=KTLX:vil&CRS=CRS:84&FORMAT=image/tiff" + box, 200, ""},
        {"VERSION=1.3.0&REQUEST=GetMap&FORMAT=image/tiff&LAYERS=KTLX:vil&CRS=CRS:84" + box, 400,
         "InvalidFormat"},
        {"VERSION=2.0&REQUEST=GetMap&LAYERS=KTLX:vil&CRS=CRS:84" + box, 400, ""},
        {"VERSION=1.3.0&REQUEST=GetMap&STYLES=a,b&LAYERS=KTLX:vil&CRS=CRS:84" + box, 400,
         "StyleNotDefined"},
    };
    for (const auto& [query, status, code] : refusals) {
        const Answer answer = get(query);
        EXPECT_EQ(answer.status, status) << query;
        if (status == 200) continue;
        EXPECT_THAT(body_of(answer), HasSubstr("<ServiceExceptionReport")) << query;
        if (!code.empty()) {
            EXPECT_THAT(body_of(answer), HasSubstr("code=\"" + code + "\"")) << query;
        } else {
            EXPECT_THAT(body_of(answer), Not(HasSubstr("code="))) << query;
        }
    }
}

// Tests the whole server with GDAL's own driver.
class WmsOfGdal : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (IsSkipped()) return;
        if (!std::filesystem::exists("/usr/bin/gdalinfo")) {
            GTEST_SKIP() << "GDAL's programs are not installed (scripts/install-packages test)";
        }
        WebSetup setup = setup_below(directory_.path());
        setup.cache = storm_->cache();
        setup.catalog = storm_->catalog();
        auto opened = WebService::open(std::move(setup));
        ASSERT_TRUE(opened) << opened.error().message;
        service_ = std::move(*opened);
        address_ = service_->addresses().at(0) + "wms";
    }

    testing::TemporaryDirectory directory_;
    std::unique_ptr<WebService> service_;
    std::string address_;
};

TEST_F(WmsOfGdal, ListsTheLayersAndReadsTheirPixels) {
    const auto listed = testing::run_program(
        "/usr/bin/gdalinfo", {"WMS:" + address_ + "?SERVICE=WMS&REQUEST=GetCapabilities"});
    EXPECT_EQ(listed.status, 0) << listed.err;
    EXPECT_THAT(listed.out, HasSubstr("LAYERS=KTLX%3Acomposite.REF"));
    // 2026-11-27: a name that GDAL itself lists asks for JPEG, which was refused.
    const std::size_t name = listed.out.find("_NAME=WMS:") + 6;
    const auto by_name = testing::run_program(
        "/usr/bin/gdal_translate",
        {"-q", "-of", "PNG", "-outsize", "64", "0",
         listed.out.substr(name, listed.out.find('\n', name) - name), directory_ / "by-name.png"});
    EXPECT_EQ(by_name.status, 0) << by_name.err;

    const std::string description = directory_ / "wms.xml";
    std::ofstream(description)
        << "<GDAL_WMS><Service name=\"WMS\"><Version>1.3.0</Version><ServerUrl>" << address_
        << "?TIME=" << PicturedStorm::time
        << "&amp;</ServerUrl><CRS>EPSG:4326</CRS><Layers>KTLX:composite.REF</Layers>"
           "<ImageFormat>image/png</ImageFormat><Transparent>TRUE</Transparent>"
           "<BBoxOrder>yxYX</BBoxOrder></Service><DataWindow><UpperLeftX>-99</UpperLeftX>"
           "<UpperLeftY>37</UpperLeftY><LowerRightX>-96</LowerRightX><LowerRightY>34</LowerRightY>"
           "<SizeX>300</SizeX><SizeY>300</SizeY></DataWindow><Projection>EPSG:4326</Projection>"
           "<BandsCount>4</BandsCount><BlockSizeX>128</BlockSizeX><BlockSizeY>128</BlockSizeY>"
           "</GDAL_WMS>\n";
    const std::string picture = directory_ / "picture.png";
    const auto made =
        testing::run_program("/usr/bin/gdal_translate", {"-q", "-of", "PNG", description, picture});
    ASSERT_EQ(made.status, 0) << made.err;
    std::ifstream file(picture, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const render::Image image = decoded_png(bytes);
    ASSERT_EQ(image.width, 300);
    ASSERT_EQ(image.height, 300);
    expect_cells(image, *storm_->grid(level2::Moment::ref), [](double east, double north) {
        return grid::GeoPoint{34 + 3 * north, -99 + 3 * east};
    });
}

}  // namespace
}  // namespace stormcellar::web
