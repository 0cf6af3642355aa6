#include "export/grid_gltf.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "export/surface_mesh.h"
#include "stormcellar/grid/projection.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::surfaces {
namespace {

using grid::CellStatus;
using ::testing::HasSubstr;

constexpr double center_dbz = 60, dbz_per_m = 0.005, center_up_m = 6500;

// A ball of echo: 60 dBZ at (1.5 km east, 2 km north, 6.5 km up), 5 dB less for each kilometer, and
// no echo below 20 dBZ. Levels are not regular.
grid::Grid ball() {
    grid::Grid grid;
    grid.spec = grid::default_spec(35, -97);
    grid.spec.nx = 40;
    grid.spec.ny = 44;
    grid.spec.levels_m.clear();
    for (int level = 0; level < 20; ++level)
        grid.spec.levels_m.push_back(-1000 + 600 * level + 10 * level * level);
    grid.time = grid.start_time = grid.end_time = UtcTime{std::chrono::seconds{1'600'000'000}};
    grid.sites = {{"KTLX", 35, -97, 389}};
    grid.provenance.method = "column-linear";
    grid.provenance.predicted_error = "0.4 dBZ";
    grid.provenance.stations = {"KTLX"};
    grid.values.resize(grid.spec.cell_count());
    grid.status.assign(grid.spec.cell_count(), CellStatus::no_echo);
    for (int iy = 0; iy < grid.spec.ny; ++iy) {
        for (int ix = 0; ix < grid.spec.nx; ++ix) {
            for (int iz = 0; iz < grid.spec.nz(); ++iz) {
                const double up_m = grid.spec.levels_m[static_cast<std::size_t>(iz)] - center_up_m;
                const double away_m =
                    std::hypot(grid.spec.x_m(ix) - 1500, grid.spec.y_m(iy) - 2000, up_m);
                const double dbz = center_dbz - dbz_per_m * away_m;
                if (dbz < 20) continue;
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                grid.values[cell] = static_cast<float>(dbz);
                grid.status[cell] = CellStatus::value;
            }
        }
    }
    return grid;
}

double distance_of(const Vector& point) {
    return std::hypot(point[0] - 1500.0, point[1] - center_up_m, point[2] + 2000.0);
}

// Counts the edges that are not used equally often in both directions. A closed surface has no such
// edge.
std::size_t open_edges(const SurfaceMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (std::size_t at = 0; at < mesh.corners.size(); at += 3) {
        for (std::size_t i = 0; i < 3; ++i)
            ++uses[{mesh.corners[at + i], mesh.corners[at + (i + 1) % 3]}];
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        if (back == uses.end() || back->second != count) ++open;
    }
    return open;
}

TEST(SurfaceMesh, OfABallIsAClosedSphereOfTheRightRadiusThatFacesOutward) {
    const grid::Grid grid = ball();
    for (const double dbz : {30.0, 45.0, 52.5}) {
        const SurfaceMesh mesh = surface_of(grid, dbz, 1);
        const double radius_m = (center_dbz - dbz) / dbz_per_m;
        ASSERT_GT(mesh.corners.size(), 200U);
        ASSERT_EQ(mesh.normals.size(), mesh.points.size());
        EXPECT_EQ(open_edges(mesh), 0U) << dbz;
        std::set<std::uint32_t> used(mesh.corners.begin(), mesh.corners.end());
        EXPECT_EQ(used.size(), mesh.points.size());
        for (std::size_t at = 0; at < mesh.points.size(); ++at) {
            const Vector& point = mesh.points[at];
            ASSERT_NEAR(distance_of(point), radius_m, 300) << dbz;
            const Vector& normal = mesh.normals[at];
            const double outward = normal[0] * (point[0] - 1500) +
                                   normal[1] * (point[1] - center_up_m) +
                                   normal[2] * (point[2] + 2000);
            ASSERT_GT(outward, 0.8 * radius_m);
            ASSERT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-5);
        }
        // The divergence theorem gives the volume, whose sign says which way triangles face. A ball
        // three cells wide loses much of its volume, because its top is between cells.
        double volume = 0;
        for (std::size_t at = 0; at < mesh.corners.size(); at += 3) {
            const Vector& a = mesh.points[mesh.corners[at]];
            const Vector& b = mesh.points[mesh.corners[at + 1]];
            const Vector& c = mesh.points[mesh.corners[at + 2]];
            volume += (a[0] * (1.0 * b[1] * c[2] - 1.0 * b[2] * c[1]) -
                       a[1] * (1.0 * b[0] * c[2] - 1.0 * b[2] * c[0]) +
                       a[2] * (1.0 * b[0] * c[1] - 1.0 * b[1] * c[0])) /
                      6;
        }
        const double expected = 4.0 / 3 * 3.14159265 * radius_m * radius_m * radius_m;
        EXPECT_NEAR(volume, expected, (dbz > 50 ? 0.4 : 0.12) * expected) << dbz;
    }
}

// Each point is between cells on both sides of the value.
TEST(SurfaceMesh, EachPointIsInABoxThatTheSurfaceCrosses) {
    grid::Grid grid = ball();
    // Roughen the ball, and cut holes into it.
    for (std::size_t cell = 0; cell < grid.values.size(); ++cell) {
        if (grid.status[cell] != CellStatus::value) continue;
        grid.values[cell] += static_cast<float>((cell * 7919) % 13) - 6;
        if (cell % 11 == 0) grid.status[cell] = CellStatus::no_echo;
    }
    const grid::GridSpec& spec = grid.spec;
    const SurfaceMesh mesh = surface_of(grid, 40, 1);
    ASSERT_GT(mesh.points.size(), 500U);
    for (const Vector& point : mesh.points) {
        const double fx = point[0] / spec.cell_width_m() + spec.center_x();
        const double fy = -point[2] / spec.cell_height_m() + spec.center_y();
        const auto above = std::ranges::upper_bound(spec.levels_m, double{point[1]});
        const int iz =
            std::clamp(static_cast<int>(above - spec.levels_m.begin()) - 1, 0, spec.nz() - 2);
        const int ix = std::clamp(static_cast<int>(fx), 0, spec.nx - 2);
        const int iy = std::clamp(static_cast<int>(fy), 0, spec.ny - 2);
        bool is_above = false, is_below = false;
        for (int corner = 0; corner < 8; ++corner) {
            const std::size_t cell =
                spec.index(ix + (corner & 1), iy + ((corner >> 1) & 1), iz + (corner >> 2));
            const bool inside = grid.status[cell] == CellStatus::value && grid.values[cell] >= 40;
            is_above = is_above || inside;
            is_below = is_below || !inside;
        }
        ASSERT_TRUE(is_above && is_below) << point[0] << " " << point[1] << " " << point[2];
    }
}

// The storm's base is in the blind region: the surface must be open there, not flat.
TEST(SurfaceMesh, IsOpenWhereNothingWasSeen) {
    grid::Grid grid = ball();
    for (std::size_t column = 0; column < grid.spec.column_count(); ++column) {
        for (int level = 0; level < 8; ++level) {
            const std::size_t cell =
                column * grid.spec.levels_m.size() + static_cast<std::size_t>(level);
            grid.status[cell] = level < 4 ? CellStatus::not_seen : CellStatus::range_folded;
            grid.values[cell] = 0;
        }
    }
    const SurfaceMesh mesh = surface_of(grid, 30, 1);
    EXPECT_GT(open_edges(mesh), 10U);
    for (const Vector& point : mesh.points) {
        ASSERT_GT(point[1], grid.spec.levels_m[8]);
        ASSERT_NEAR(distance_of(point), 6000, 300);
    }
}

TEST(SurfaceMesh, OfANegativeVelocityEnclosesFasterWind) {
    grid::Grid grid = ball();
    grid.moment = level2::Moment::vel;
    for (float& value : grid.values)
        value = -value;
    const SurfaceMesh mesh = surface_of(grid, -45, 1);
    ASSERT_GT(mesh.points.size(), 100U);
    for (const Vector& point : mesh.points)
        ASSERT_NEAR(distance_of(point), 3000, 300);
    EXPECT_TRUE(surface_of(grid, 45, 1).points.empty());
    EXPECT_FALSE(encloses_below(level2::Moment::ref, -10));
}

TEST(SurfaceMesh, OfAGridWithoutEchoIsEmpty) {
    grid::Grid grid = ball();
    grid.status.assign(grid.status.size(), CellStatus::no_echo);
    EXPECT_TRUE(surface_of(grid, 30, 1).corners.empty());
    grid.spec.levels_m = {1000};
    grid.values.assign(grid.spec.cell_count(), 50);
    grid.status.assign(grid.spec.cell_count(), CellStatus::value);
    EXPECT_TRUE(surface_of(grid, 30, 1).corners.empty()) << "one level has no surface";
}

std::uint32_t word_at(const std::vector<std::byte>& bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, 4);
    return word;
}

struct Glb {
    nlohmann::json json;
    std::vector<std::byte> data;
};

// Reads the container by the specification.
Glb parsed(const std::vector<std::byte>& bytes) {
    Glb glb;
    EXPECT_EQ(word_at(bytes, 0), 0x46546C67U);
    EXPECT_EQ(word_at(bytes, 4), 2U);
    EXPECT_EQ(word_at(bytes, 8), bytes.size());
    const std::size_t text = word_at(bytes, 12);
    EXPECT_EQ(word_at(bytes, 16), 0x4E4F534AU);
    EXPECT_EQ(text % 4, 0U);
    const char* begin = reinterpret_cast<const char*>(bytes.data()) + 20;
    glb.json = nlohmann::json::parse(begin, begin + text);
    EXPECT_EQ(word_at(bytes, 20 + text + 4), 0x004E4942U);
    glb.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(28 + text), bytes.end());
    EXPECT_EQ(word_at(bytes, 20 + text), glb.data.size());
    EXPECT_EQ(glb.json["buffers"][0]["byteLength"], glb.data.size());
    return glb;
}

const grid_export::GridFormatOptions three_surfaces{
    .surfaces = {{30, {0, 255, 0}}, {45, {255, 188, 0}}, {60.5, {255, 0, 255}}}, .height_scale = 2};

TEST(GridGltf, HoldsTheSurfacesWithTheirColorsAndBounds) {
    const grid::Grid grid = ball();
    const auto bytes = gltf_bytes({&grid, 1}, three_surfaces);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const Glb glb = parsed(*bytes);
    ASSERT_EQ(glb.json["nodes"].size(), 2U) << "no cell has 60.5 dBZ";
    EXPECT_EQ(glb.json["nodes"][1]["name"], "REF 45 dBZ");
    const auto& color = glb.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"];
    EXPECT_EQ(color[0], 1);
    EXPECT_NEAR(color[1].get<double>(), 0.5028865, 1e-6);
    EXPECT_NEAR(color[3].get<double>(), 2.0 / 3, 1e-12);
    for (std::size_t node = 0; node < 2; ++node) {
        const auto& primitive = glb.json["meshes"][node]["primitives"][0];
        const SurfaceMesh mesh = surface_of(grid, node == 0 ? 30 : 45, 2);
        const auto& accessor =
            glb.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
        ASSERT_EQ(accessor["count"], mesh.points.size());
        const auto& view = glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        ASSERT_EQ(std::memcmp(glb.data.data() + view["byteOffset"].get<std::size_t>(),
                              mesh.points.data(), mesh.points.size() * 12),
                  0);
        // Heights are doubled: 6.5 km up is 13 km.
        EXPECT_NEAR(accessor["max"][1].get<double>(), 13'000 + (node == 0 ? 12'000 : 6'000), 600);
        EXPECT_NEAR(accessor["min"][2].get<double>(), -2000 - (node == 0 ? 6'000 : 3'000), 300);
        EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<std::size_t>()]["count"],
                  mesh.corners.size());
    }
    const auto& extras = glb.json["scenes"][0]["extras"];
    EXPECT_EQ(extras["predicted_error"], "0.4 dBZ");
    EXPECT_EQ(extras["method"], "column-linear");
    EXPECT_EQ(extras["origin_latitude_deg"], 35);
    EXPECT_EQ(extras["time"], "2020-09-13T12:26:40Z");
}

TEST(GridGltf, RefusesWhatItCannotHold) {
    const testing::TemporaryDirectory directory;
    const std::vector<grid::Grid> one = {ball()};
    std::vector<grid::Grid> two = {ball(), ball()};
    two[1].moment = level2::Moment::rho;
    const auto refuses = [](const std::vector<grid::Grid>& grids,
                            const grid_export::GridFormatOptions& options, const char* why) {
        const auto bytes = gltf_bytes(grids, options);
        ASSERT_FALSE(bytes) << why;
        EXPECT_EQ(bytes.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(bytes.error().message, HasSubstr(why));
    };
    refuses(two, three_surfaces, "one moment");
    refuses(one, {}, "1 to 16 surfaces");
    refuses(one, {.surfaces = {{70}, {75.5}}}, "no surface at 70, 75.5 dBZ");
    refuses(one, {.surfaces = {{30}}, .height_scale = 0}, "more than 0");
    const auto path = directory.path() / "a.glb";
    EXPECT_FALSE(write_gltf(real_file_system(), path, one, {}));
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_TRUE(write_gltf(real_file_system(), path, one, three_surfaces));
}

}  // namespace
}  // namespace stormcellar::surfaces
