// Tests that frames of a real volume have the bytes that the library draws, in each format and with
// panels. Tests refusals, too.
#include "web/doors/pictures/frames.h"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/options/sweep_source.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/decode.h"
#include "tests/web/asked.h"
#include "tests/web/library_picture.h"
#include "tests/web/pictured_storm.h"

namespace stormcellar::web {
namespace {

std::unique_ptr<FramesDoor> door_to(const PicturedStorm& storm, std::filesystem::path catalog) {
    return std::make_unique<FramesDoor>(
        storm.grids(), std::make_shared<FramePictures>(FramePicturesOptions{}),
        std::make_shared<SweepPictures>(std::make_shared<ServedCatalog>(std::move(catalog)),
                                        FramePicturesOptions{}),
        std::make_shared<RainTotals>(RainTotalsOptions{.grids = storm.grids()}),
        std::make_shared<StormScans>(storm.grids()));
}

class Frames : public DoorTest<FramesDoor, PictureTest> {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (IsSkipped()) return;
        door_ = door_to(*storm_, storm_->catalog());
    }
};

// Returns options of a small picture of velocities.
render::SceneOptions velocity_options(const std::string& product) {
    render::SceneOptions options = small_picture(product);
    options.moment = "VEL";
    return options;
}

// Draws a picture of KTLX with the library.
std::string drawn(const grid::BrickView& view, const cache::GridDescription& description,
                  const render::SceneOptions& options) {
    const std::string domain = "KTLX";
    return library_picture({domain, view, description, options, false}, "a.png");
}

constexpr const char* small_map = "/frames/KTLX.png?product=composite&width=480&height=360";

TEST_F(Frames, AreWhatTheLibraryDraws) {
    const Answer answer =
        get(std::string("/frames/KTLX.png?product=cappi&moment=VEL&height-km=2&width=400&height="
                        "300&theme=light&time=") +
            PicturedStorm::time);
    ASSERT_EQ(answer.status, 200u) << body_of(answer);
    EXPECT_EQ(header_of(answer, "Content-Type"), "image/png");
    EXPECT_EQ(header_of(answer, "Cache-Control"), "max-age=300");
    render::SceneOptions options = velocity_options("cappi");
    options.theme = "light";
    options.scene.cappi_height_m = 2000;
    const auto grid = storm_->grid(level2::Moment::vel);
    EXPECT_TRUE(body_of(answer) == drawn(grid->file.view(), grid->file.description(), options));
}

TEST_F(Frames, VolumesAndSectionsAreDrawn) {
    const render::Image volume = decoded_png(
        body_of(get("/frames/KTLX.png?width=480&height=360&slices=32&azimuth=200&tilt=60")));
    EXPECT_EQ(volume.width, 480);
    const render::Image other = decoded_png(
        body_of(get("/frames/KTLX.png?width=480&height=360&slices=32&azimuth=20&tilt=60")));
    EXPECT_NE(volume.rgba, other.rgba) << "the camera is at another place";
    const Answer section =
        get("/frames/KTLX.png?product=section&section=35.3,-98.2,35.4,-97.0&width=400&height=300");
    ASSERT_EQ(section.status, 200u) << body_of(section);
    EXPECT_EQ(decoded_png(body_of(section)).height, 300);
}

TEST_F(Frames, HaveTheFormatOfTheirEnding) {
    const std::string query = "?product=composite&width=480&height=360";
    const Answer jpeg = get("/frames/KTLX.jpg" + query);
    EXPECT_EQ(header_of(jpeg, "Content-Type"), "image/jpeg");
    EXPECT_TRUE(body_of(jpeg).starts_with("\xFF\xD8"));
    const Answer webp = get("/frames/KTLX.webp" + query);
    EXPECT_EQ(header_of(webp, "Content-Type"), "image/webp");
    EXPECT_EQ(body_of(webp).substr(8, 4), "WEBP");
    const Answer tiff = get("/frames/KTLX.tif?product=composite&geotiff=states");
    EXPECT_EQ(header_of(tiff, "Content-Type"), "image/tiff");
    EXPECT_TRUE(body_of(tiff).starts_with("II*"));
    const Answer kmz = get("/frames/KTLX.kmz?product=composite");
    EXPECT_EQ(header_of(kmz, "Content-Type"), "application/vnd.google-earth.kmz");
    EXPECT_TRUE(body_of(kmz).starts_with("PK"));
}

TEST_F(Frames, PanelsShowSeveralMoments) {
    const Answer panels =
        get("/frames/KTLX.png?product=composite&panels=REF,VEL&width=640&height=320");
    ASSERT_EQ(panels.status, 200u) << body_of(panels);
    const render::Image image = decoded_png(body_of(panels));
    EXPECT_EQ(image.width, 640);
    const render::Image turned = decoded_png(
        body_of(get("/frames/KTLX.png?product=composite&panels=VEL,REF&width=640&height=320")));
    EXPECT_NE(image.rgba, turned.rgba);
}

TEST_F(Frames, TheNewestGridAtOrBeforeTheTimeIsDrawn) {
    const std::string exact = header_of(get(small_map), "ETag");
    ASSERT_FALSE(exact.empty());
    const Answer later = get(std::string(small_map) + "&time=1999-05-04T03:00");
    EXPECT_EQ(header_of(later, "ETag"), exact);
    EXPECT_EQ(header_of(later, "Cache-Control"), "no-cache")
        << "a grid nearer to the time may still come";
    EXPECT_EQ(get(std::string(small_map) + "&time=1999-05-03T23:00").status, 404u);
}

TEST_F(Frames, AreKeptAndHaveTags) {
    EXPECT_FALSE(door_->answer_at_once(request_for(small_map)));
    const std::string etag = header_of(get(small_map), "ETag");
    ASSERT_TRUE(door_->answer_at_once(request_for(small_map))) << "the picture is kept now";
    EXPECT_EQ(get(small_map, {{"If-None-Match", etag}}).status, 304u);
    EXPECT_NE(header_of(get(std::string(small_map) + "&theme=light"), "ETag"), etag);
}

// Reads the storm's file, decodes all of its cuts, and draws one sweep with the library.
std::string drawn_sweep(const PicturedStorm& storm, const render::SceneOptions& options,
                        level2::Moment moment, double elevation_deg) {
    level2::DecodeOptions all;
    all.selection.moments = {moment};
    auto decoded = level2::decode_file(storm.file(), all);
    EXPECT_TRUE(decoded);
    const grid::SourceWish wish{.moments = {moment}};
    const std::string file = storm.file().filename().string();
    auto source = grid::take_source(std::move(*decoded), file, wish);
    EXPECT_TRUE(source);
    const auto shared = std::make_shared<const grid::SourceVolume>(std::move(*source));
    auto sweep = grid::SweepLookup::find({shared, &shared->volume}, shared->site, moment, 0.475,
                                         {.elevation_deg = elevation_deg});
    EXPECT_TRUE(sweep);
    EXPECT_NEAR(sweep->facts().fixed_angle_deg, elevation_deg, 0.1);
    const auto description = render::describe_sweep(*sweep, render::plane_of_sweep(*sweep), *shared,
                                                    "KTLX19990503_235621");
    grid::BrickView view;
    view.spec = &description.spec;
    view.sweep = &*sweep;
    return drawn(view, description, options);
}

TEST_F(Frames, OfSweepsAreWhatTheLibraryDraws) {
    const Answer answer =
        get("/frames/KTLX.png?product=ppi&moment=VEL&elevation=1.5&width=400"
            "&height=300");
    ASSERT_EQ(answer.status, 200u) << body_of(answer);
    render::SceneOptions options = velocity_options("ppi");
    options.scene.elevation_deg = 1.5;
    EXPECT_TRUE(body_of(answer) == drawn_sweep(*storm_, options, level2::Moment::vel, 1.5));
}

TEST_F(Frames, OfSweepsAreKeptAndHavePanelsAndFormats) {
    const std::string query = "?product=ppi&width=400&height=300";
    const Answer first = get("/frames/KTLX.png" + query);
    ASSERT_EQ(first.status, 200u) << body_of(first);
    const std::string etag = header_of(first, "ETag");
    EXPECT_EQ(get("/frames/KTLX.png" + query, {{"If-None-Match", etag}}).status, 304u);
    EXPECT_EQ(body_of(get("/frames/KTLX.png" + query)), body_of(first));
    EXPECT_NE(body_of(get("/frames/KTLX.png" + query + "&elevation=2.4")), body_of(first));
    const Answer panels = get("/frames/KTLX.png?product=ppi&panels=REF,VEL&width=640&height=320");
    ASSERT_EQ(panels.status, 200u) << body_of(panels);
    EXPECT_EQ(decoded_png(body_of(panels)).width, 640);
    EXPECT_TRUE(body_of(get("/frames/KTLX.tif?product=ppi")).starts_with("II*"));
    EXPECT_EQ(get("/frames/KTLX.png?product=ppi&time=1999-05-03T20:00").status, 404u);
    const Answer too_high = get("/frames/KTLX.png?product=ppi&elevation=45");
    EXPECT_EQ(too_high.status, 404u) << body_of(too_high);
    EXPECT_NE(body_of(too_high).find("19.5"), std::string::npos)
        << "the answer lists the angles of the volume";
}

// Kept grids have only the echo that the service left in them, so `quality` applies only to sweeps.
TEST_F(Frames, OfSweepsLackEchoThatIsProbablyNoWeatherOnRequest) {
    const auto colored = [&](const std::string& quality) {
        const Answer answer = get("/frames/KTLX.tif?product=ppi&geotiff=states" + quality);
        EXPECT_EQ(answer.status, 200u) << body_of(answer);
        return body_of(answer);
    };
    EXPECT_EQ(colored("&quality=0"), colored(""));
    EXPECT_NE(colored("&quality=0.5"), colored(""));
    EXPECT_NE(colored("&quality=0.5"), colored("&quality=1"));
    const Answer of_grid = get(std::string(small_map) + "&quality=0.5");
    EXPECT_EQ(of_grid.status, 400u);
    EXPECT_NE(body_of(of_grid).find("what the service left of it"), std::string::npos);
    EXPECT_EQ(get("/frames/KTLX.png?product=ppi&quality=2").status, 400u);
}

TEST_F(Frames, OfSweepsNeedTheRawFile) {
    const std::string ppi = "/frames/KTLX.png?product=ppi&width=400&height=300";
    const auto without = door_to(*storm_, {});
    const Answer uncataloged = asked(*without, ppi);
    EXPECT_EQ(uncataloged.status, 404u);
    EXPECT_NE(body_of(uncataloged).find("raw volume"), std::string::npos);
    const PicturedStorm own;
    const auto door = door_to(own, own.catalog());
    std::filesystem::remove(own.file());
    const Answer gone = asked(*door, ppi);
    EXPECT_EQ(gone.status, 404u);
    EXPECT_EQ(body_of(gone).find(own.file().parent_path().native()), std::string::npos)
        << "the answer names no directory: " << body_of(gone);
    auto catalog = catalog::CatalogWriter::open(own.catalog());
    ASSERT_TRUE(catalog && catalog->mark_gone(own.file()));
    EXPECT_EQ(asked(*door, ppi).status, 410u);
    EXPECT_EQ(asked(*door, small_map).status, 200u) << "a picture of grids needs no raw file";
}

TEST_F(Frames, TheIndexNamesEveryParameterThatIsTaken) {
    const auto index = nlohmann::json::parse(body_of(get("/frames")));
    EXPECT_EQ(index["domains"][0]["picture"], "http://localhost:8090/frames/KTLX.png");
    std::set<std::string> names;
    for (const auto& parameter : index["parameters"])
        names.insert(parameter["name"]);
    for (const char* name : {"product", "tilt", "camera-km", "section", "no-labels", "theme"})
        EXPECT_TRUE(names.contains(name)) << name;
    EXPECT_FALSE(names.contains("threads"));
    EXPECT_FALSE(names.contains("orbit"));
}

TEST_F(Frames, RefusesWhatMakesNoSense) {
    for (const char* query :
         {"product=pie", "moment=XYZ", "moment=REF&moment=VEL", "threads=4", "width=1",
          "width=99999", "width=7680&height=4320", "tilt=steep", "time=soon",
          "time=latest&time=latest", "time-zone=../../etc/passwd", "colors=/etc/passwd.pal",
          "product=section", "panels=REF,REF", "panels=REF&moment=VEL", "geotiff=values",
          "product=composite&tilt=50", "slices=99999999"})
        EXPECT_EQ(get(std::string("/frames/KTLX.png?") + query).status, 400u) << query;
    EXPECT_EQ(get("/frames/KTLX.tif").status, 400u) << "a picture in perspective is not a map";
    EXPECT_EQ(get("/frames/KTLX.kmz?product=composite&panels=REF,VEL").status, 400u);
    for (const char* target :
         {"/frames/KTLX", "/frames/KTLX.gif", "/frames/KXXX.png", "/frames/.png",
          "/frames/KTLX.png/", "/frames/KTLX/a.png",
          "/frames/KTLX.png?product=composite&moment=ZDR", "/frames/KTLX.png?time=1990-01-01"})
        EXPECT_EQ(get(target).status, 404u) << target;
}

}  // namespace
}  // namespace stormcellar::web
