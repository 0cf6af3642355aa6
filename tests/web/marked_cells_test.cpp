// Tests pictures of the data server that mark storm cells.
#include "web/data/storms/marked_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/retrieve/storm_cells.h"
#include "tests/web/library_picture.h"
#include "tests/web/served_storms.h"
#include "web/doors/pictures/frames.h"
#include "web/doors/pictures/tiles.h"

namespace stormcellar::web {
namespace {

class MarkedStorm : public ::testing::Test {
  protected:
    MarkedStorm() { served_.add_half_hour("KTLX"); }
    std::string picture(const std::string& more) {
        const Answer answer =
            asked(door_, "/frames/KTLX.png?product=composite&width=400&height=300" + more);
        EXPECT_EQ(answer.status, 200u) << body_of(answer);
        return body_of(answer);
    }
    unsigned status(const std::string& target) { return asked(door_, target).status; }

    ServedStorms served_;
    FramesDoor door_{served_.grids(), std::make_shared<FramePictures>(FramePicturesOptions{}),
                     nullptr, nullptr, served_.scans()};
};

TEST_F(MarkedStorm, HasTheCellsThatTheLibraryMarks) {
    const UtcTime time = testing::noon + std::chrono::minutes{25};
    const auto grid = *served_.grids()->find("KTLX", level2::Moment::ref, time);
    std::vector<retrieve::CellScan> scans;
    std::shared_ptr<const OpenGrid> before;
    for (int minutes = 0; minutes <= 25; minutes += 5) {
        const UtcTime one = testing::noon + std::chrono::minutes{minutes};
        const auto of = *served_.grids()->find("KTLX", level2::Moment::ref, one);
        retrieve::CellFields fields;
        fields.reflectivity = of->file.view();
        scans.push_back(*retrieve::find_cells(fields, one, "KTLX"));
        const bool is_guessed =
            !before ||
            retrieve::guess_motions(scans.back(), before->file.view(), of->file.view(), 300);
        ASSERT_TRUE(is_guessed);
        before = of;
    }
    render::CellOverlay overlay;
    overlay.scan = retrieve::track_cells(scans)->back();
    overlay.volumes = scans.size();
    ASSERT_FALSE(overlay.scan.cells.empty());

    render::SceneOptions options = small_picture("composite");
    options.overlay = "cells";
    const std::string domain = "KTLX";
    const grid::BrickView view = grid->file.view();
    const render::StillSource still{domain,  view,  grid->file.description(),
                                    options, false, {.cells = &overlay}};
    const std::string marked = picture("&overlay=cells");
    EXPECT_TRUE(marked == library_picture(still, "a.png"));
    EXPECT_NE(picture(""), marked);
    EXPECT_NE(picture("&overlay=cells&freezing-levels=3000,6000"), marked);
    served_.add("KTLX", 10, -30);  // a grid of the track is made again
    EXPECT_NE(picture("&overlay=cells"), marked);
}

TEST_F(MarkedStorm, OtherOverlaysAndDataAreRefused) {
    for (const char* wrong :
         {"png?overlay=/etc/passwd", "png?overlay=cells,warnings.geojson",
          "png?overlay=", "nc?product=composite&overlay=cells", "png?panels=REF,VEL&overlay=cells",
          "png?product=composite&freezing-levels=3000,6000"})
        EXPECT_EQ(status(std::string("/frames/KTLX.") + wrong), 400u) << wrong;
    TilesDoor tiles(std::make_shared<MapPictures>(MapPicturesOptions{.grids = served_.grids()}));
    EXPECT_EQ(asked(tiles, "/tiles/KTLX/composite.REF/latest/7/30/50.png?overlay=cells").status,
              400u);
    // Without reflectivity near the time of the picture there are no cells.
    grid::Grid wind = storm_grid(testing::noon, 0);
    wind.moment = level2::Moment::sw;
    served_.add("KFDR", wind);
    EXPECT_EQ(status("/frames/KFDR.png?product=composite&moment=SW"), 200u);
    EXPECT_EQ(status("/frames/KFDR.png?product=composite&moment=SW&overlay=cells"), 404u);
}

}  // namespace
}  // namespace stormcellar::web
