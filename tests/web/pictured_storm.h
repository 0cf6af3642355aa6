// tests/web/pictured_storm.h -- a real volume in a catalog and a cache (Oklahoma, 3 May 1999).
// Computes the colors that its pictures should have, without the code that draws.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/door_test.h"
#include "web/data/grids/grids.h"
#include "web/data/pictures/map_pictures.h"

namespace stormcellar::web {

// Returns the pixels of a PNG, read by libpng's own reader; an empty image if the bytes are not a
// PNG.
[[nodiscard]] render::Image decoded_png(const std::string& bytes);

// The domain KTLX with grids of REF and VEL, 2 km apart; the catalog names the file.
class PicturedStorm {
  public:
    // The name of the file, how long ago it was written, and its moments in the cache.
    explicit PicturedStorm(const std::string& name = "KTLX19990503_235621.gz",
                           std::chrono::hours age = {},
                           std::vector<level2::Moment> moments = {level2::Moment::ref,
                                                                  level2::Moment::vel});

    [[nodiscard]] const std::shared_ptr<Grids>& grids() const { return grids_; }
    [[nodiscard]] std::shared_ptr<const OpenGrid> grid(level2::Moment moment) const;
    [[nodiscard]] std::filesystem::path catalog() const { return directory_ / "catalog"; }
    [[nodiscard]] std::filesystem::path cache() const { return directory_ / "cache"; }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

    static constexpr const char* time = "1999-05-03T23:56:21Z";

  private:
    testing::TemporaryDirectory directory_;
    std::filesystem::path file_;
    std::shared_ptr<Grids> grids_;
};

// A test on the storm; skipped if there are no real volumes. All tests share one storm, because
// making it takes longer than most tests. No test may change its files.
class PictureTest : public ::testing::Test {
  protected:
    void SetUp() override;
    std::shared_ptr<const PicturedStorm> storm_;
};

// A test of a door (the handler of a path) that serves maps of the storm.
template <class AnyDoor>
class MapDoorTest : public DoorTest<AnyDoor, PictureTest> {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (::testing::Test::IsSkipped()) return;
        this->door_ = std::make_unique<AnyDoor>(
            std::make_shared<MapPictures>(MapPicturesOptions{.grids = storm_->grids()}));
    }
    using PictureTest::storm_;
};

// Returns the color of the column maximum at a place, from the cells of the column one by one.
[[nodiscard]] render::Rgba8 composite_color_at(const OpenGrid& grid, const render::Scene& scene,
                                               grid::GeoPoint place);

}  // namespace stormcellar::web
