// Two simulated radars see one storm. Compares the hail of their mosaic with the hail of each
// radar.
#include "cli/picture/hail_mosaic.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/products/hail_field.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

constexpr retrieve::FreezingLevels storm_levels{};

class HailOfAMosaic : public ::testing::Test {
  protected:
    // Simulates a volume of a radar at a longitude, and returns its file.
    [[nodiscard]] std::string volume_of(const char* station, double longitude_deg) const {
        const std::string scene = directory_ / "scene.toml";
        {
            std::ofstream text(scene);
            text << fmt::format(
                "[radar]\nstation = \"{}\"\nlatitude_deg = 35\nlongitude_deg = {}\n"
                "altitude_m = 400\n[volumes]\ncount = 1\nstart = \"2024-06-01T22:00:00Z\"\n"
                "[weather]\nlatitude_deg = 35\nlongitude_deg = -97\n",
                station, longitude_deg);
            for (const double elevation_deg : {0.5, 1.5, 2.5, 3.5, 5.0, 7.0, 9.5, 13.0})
                text << fmt::format("[[cut]]\nelevation_deg = {}\nazimuth_rate_deg_s = 30\n",
                                    elevation_deg);
            text << "[[storm]]\nposition_km = [0, 20]\nradii_km = [14, 10]\ncore_km = 6\n"
                    "top_km = 14\npeak_dbz = 66\n";
        }
        const auto made = run({"synth", scene, "-o", directory_ / "volumes"});
        EXPECT_EQ(made.status, 0) << made.err;
        return directory_ / (std::string("volumes/") + station + "20240601_220000_V06");
    }
    [[nodiscard]] static GridOptions options_of(std::vector<std::string> files) {
        GridOptions options;
        options.files = std::move(files);
        options.center = "35,-97";
        options.extent_km = "100,100";
        options.threads = 2;
        return options;
    }
    [[nodiscard]] static render::FlatField mesh_of(const PictureGrid& grid) {
        const grid::BrickView view = grid.view();
        return render::hail_field(view, &retrieve::Hail::mesh_mm, storm_levels, 400,
                                  render::summarize_columns(view, 1), 1)
            .value();
    }

    testing::TemporaryDirectory directory_;
};

TEST_F(HailOfAMosaic, IsTheLargestHailOfItsRadars) {
    const std::string west = volume_of("XSYN", -97.3), east = volume_of("YSYN", -96.4);
    const auto both = hail_grid_of_files(options_of({west, east}), storm_levels);
    ASSERT_TRUE(both) << both.error().message;
    const auto of_west = hail_grid_of_files(options_of({west}), storm_levels);
    const auto of_east = hail_grid_of_files(options_of({east}), storm_levels);
    ASSERT_TRUE(of_west && of_east);
    const auto mesh = mesh_of(*both), mesh_west = mesh_of(*of_west), mesh_east = mesh_of(*of_east);
    ASSERT_EQ(mesh.values.size(), mesh_west.values.size());
    int from_west = 0, from_east = 0;
    for (std::size_t i = 0; i < mesh.values.size(); ++i) {
        ASSERT_EQ(mesh.values[i], std::max(mesh_west.values[i], mesh_east.values[i])) << i;
        from_west += mesh_west.values[i] > mesh_east.values[i] ? 1 : 0;
        from_east += mesh_east.values[i] > mesh_west.values[i] ? 1 : 0;
    }
    EXPECT_GT(from_west, 50);
    EXPECT_GT(from_east, 50);
    EXPECT_THAT(both->description().provenance.notes,
                ::testing::Contains("hail of several radars, merged by maximum"));
    EXPECT_EQ(both->name(), "XSYN+YSYN");

    const auto merged = PictureGrid::make(options_of({west, east}));
    ASSERT_TRUE(merged);
    EXPECT_NE(mesh_of(*merged).values, mesh.values) << "the mean of reflectivity has less hail";
}

// 2026-11-30: panels merged the reflectivity before they made the hail.
TEST_F(HailOfAMosaic, IsTheSameInPanels) {
    const std::string west = volume_of("XSYN", -97.3), east = volume_of("YSYN", -96.4);
    const std::string single = directory_ / "single.png", panel = directory_ / "panel.png";
    const Words place = {"--center", "35,-97", "--extent-km", "100,100", "--product", "mesh"};
    const auto drawn = [&](const std::string& to, const Words& more) {
        const auto result = run(with({"frame", west, east, "-o", to}, place, more));
        EXPECT_EQ(result.status, 0) << result.err;
        return read_file(to).value();
    };
    const Words size = {"--width", "400", "--height", "400"};
    const auto panels = drawn(panel, with(size, {"--panels", "REF"}));
    const auto text = [](const std::vector<std::byte>& bytes) {
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    EXPECT_THAT(text(panels), ::testing::HasSubstr("hail of several radars, merged by maximum"));
    const auto refused = run(with({"frame", west, east, "-o", single}, place, {"--panels", "VEL"}));
    EXPECT_EQ(refused.status, 2);
    const auto tracks = run(
        {"frame", west, east, "-o", single, "--product", "rotation-tracks", "--panels", "AZSH"});
    EXPECT_EQ(tracks.status, 2);
    EXPECT_THAT(tracks.err, ::testing::HasSubstr("rotation-tracks is for one picture"));
}

TEST_F(HailOfAMosaic, NeedsPossibleHeights) {
    const std::string west = volume_of("XSYN", -97.3), east = volume_of("YSYN", -96.4);
    const auto refused = hail_grid_of_files(options_of({west, east}), {5000, 2000});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::cli
