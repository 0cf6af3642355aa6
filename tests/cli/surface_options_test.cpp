#include "cli/grid/surface_options.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

using level2::Moment;
using ::testing::HasSubstr;

const grid_export::GridFormat& surface_format() {
    return *grid_export::grid_format_of("a.glb");
}

std::vector<double> surface_values(const std::string& typed, Moment moment) {
    const auto parsed = parse_surfaces({.values = typed, .exaggeration = {}}, surface_format(),
                                       std::vector{moment});
    EXPECT_TRUE(parsed) << parsed.error().message;
    std::vector<double> values;
    for (const grid_export::GridSurface& surface : parsed->surfaces)
        values.push_back(surface.value);
    return values;
}

TEST(SurfaceOptions, HaveTheOutermostSurfaceFirst) {
    EXPECT_EQ(surface_values("", Moment::ref), (std::vector<double>{30, 45, 60}));
    EXPECT_EQ(surface_values("50,-5,35,50", Moment::ref), (std::vector<double>{-5, 35, 50}));
    EXPECT_EQ(surface_values("40,-40,20", Moment::vel), (std::vector<double>{20, -40, 40}));
}

TEST(SurfaceOptions, HaveTheColorsOfTheMoment) {
    const auto parsed = parse_surfaces({.values = "52", .exaggeration = 4}, surface_format(),
                                       std::vector{Moment::ref});
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->surfaces[0].color, (std::array<std::uint8_t, 3>{0xFD, 0, 0}));
    EXPECT_EQ(parsed->height_scale, 4);
}

TEST(SurfaceOptions, NameWhatIsWrong) {
    const auto why = [](const SurfaceOptions& options, const char* file,
                        const std::vector<Moment>& moments) {
        const auto parsed = parse_surfaces(options, *grid_export::grid_format_of(file), moments);
        if (parsed) return std::string{};
        EXPECT_EQ(parsed.error().code, ErrorCode::bad_argument);
        return parsed.error().message;
    };
    const std::vector<Moment> ref = {Moment::ref};
    EXPECT_THAT(why({"30,x", {}}, "a.glb", ref), HasSubstr("--surfaces takes 1 to 16 numbers"));
    EXPECT_THAT(why({"30", {}}, "a.nc", ref), HasSubstr("--surfaces is for files with surfaces"));
    EXPECT_THAT(why({"", 2}, "a.zarr", ref), HasSubstr("--exaggeration is for files"));
    EXPECT_THAT(why({"", {}}, "a.glb", {Moment::vel}), HasSubstr("values of VEL"));
    EXPECT_THAT(why({"", {}}, "a.glb", {Moment::ref, Moment::vel}), HasSubstr("one --moment"));
    EXPECT_EQ(why({"", {}}, "a.nc", {Moment::ref, Moment::vel}), "");
    EXPECT_THAT(why({"1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17", {}}, "a.glb", ref),
                HasSubstr("1 to 16"));
}

}  // namespace
}  // namespace stormcellar::cli
