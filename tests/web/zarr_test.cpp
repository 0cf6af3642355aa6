// Tests grids over time as Zarr arrays: their documents, their chunks, and the numbers of times.
// scripts/check-zarr reads them with xarray and zarr.
#include "web/doors/zarr/zarr.h"

#include <cmath>
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>
#include <libdeflate.h>

#include "render/options/scene_options.h"
#include "render/still/map_attributes.h"
#include "render/still/map_raster.h"
#include "tests/web/served_grids.h"
#include "web/data/pictures/map_product.h"
#include "web/data/zarr/zarr_cells.h"

namespace stormcellar::web {
namespace {

template <class Number>
std::vector<Number> numbers_in(const Answer& answer) {
    const std::string packed = body_of(answer);
    std::vector<Number> numbers(std::size_t{4} << 20);
    std::size_t bytes = 0;
    libdeflate_decompressor* reader = libdeflate_alloc_decompressor();
    const auto result =
        libdeflate_gzip_decompress(reader, packed.data(), packed.size(), numbers.data(),
                                   numbers.size() * sizeof(Number), &bytes);
    libdeflate_free_decompressor(reader);
    EXPECT_EQ(result, LIBDEFLATE_SUCCESS);
    numbers.resize(bytes / sizeof(Number));
    return numbers;
}

nlohmann::json zarr_json(const Answer& answer) {
    EXPECT_EQ(answer.status, 200u);
    return nlohmann::json::parse(body_of(answer));
}

class ZarrTest : public ::testing::Test {
  protected:
    Answer get(std::string_view target) { return asked(door_, target); }
    Answer get3(std::string_view target) { return asked(door3_, target); }
    // Returns the index of a cell in its chunk, from the cell's position there.
    [[nodiscard]] std::size_t at(int ix, int iy, int iz) const {
        return (static_cast<std::size_t>(iz) * chunk_side + static_cast<std::size_t>(iy)) *
                   chunk_side +
               static_cast<std::size_t>(ix);
    }

    ServedGrids served_;
    testing::TemporaryDirectory state_;
    ZarrSources sources_{
        served_.shared_grids(), std::make_shared<KeptAnswers>(std::uint64_t{16} << 20),
        std::make_shared<TimeNumbers>(state_.path()),
        std::make_shared<MapPictures>(MapPicturesOptions{.grids = served_.shared_grids()})};
    ZarrDoor door_{sources_, ZarrVersion::two};
    ZarrDoor door3_{sources_, ZarrVersion::three};
};

TEST_F(ZarrTest, TheDocumentsOfVersionTwoAgreeWithEachOther) {
    const auto all = zarr_json(get("/zarr/KBGM/REF/.zmetadata"))["metadata"];
    EXPECT_EQ(all.at(".zgroup"), zarr_json(get("/zarr/KBGM/REF/.zgroup")));
    EXPECT_EQ(all.at(".zattrs"), zarr_json(get("/zarr/KBGM/REF/.zattrs")));
    for (const std::string name :
         {"REF", "status", "time", "z", "y", "x", "lat", "lon", "azimuthal_equidistant"}) {
        for (const std::string document : {"/.zarray", "/.zattrs"}) {
            EXPECT_EQ(all.at(name + document), zarr_json(get("/zarr/KBGM/REF/" + name + document)));
        }
    }
    EXPECT_EQ(all.at("time/.zarray").at("shape"), nlohmann::json::array({3}));
    EXPECT_EQ(all.at("z/.zarray").at("shape").at(0), all.at("REF/.zarray").at("shape").at(1));
}

// 2026-11-28: GDAL and QGIS saw no projection, which they take from this attribute.
// scripts/check-zarr asks GDAL.
TEST_F(ZarrTest, FieldsNameTheirProjectionForGdal) {
    const auto all = zarr_json(get("/zarr/KBGM/REF/.zmetadata"))["metadata"];
    for (const char* field : {"REF", "status"}) {
        const std::string wkt = all.at(std::string(field) + "/.zattrs").at("_CRS").at("wkt");
        EXPECT_TRUE(wkt.starts_with("PROJCS[\"Azimuthal_Equidistant\",GEOGCS[\"WGS 84\"")) << wkt;
    }
    EXPECT_FALSE(all.at("z/.zattrs").contains("_CRS"));
    const auto three = zarr_json(get3("/zarr3/KBGM/REF/REF/zarr.json"));
    EXPECT_FALSE(three.at("attributes").contains("_CRS"))
        << "xarray cannot write this attribute to netCDF";
}

// 2026-11-28: a reverse proxy could keep no chunk.
TEST_F(ZarrTest, ChunksOfAGridMayBeKeptAndThoseOfTheAxisOfTimesMayNot) {
    for (const char* chunk : {"REF/2.0.0.0", "status/2.0.0.0"}) {
        const Answer first = get(std::string("/zarr/KBGM/REF/") + chunk);
        EXPECT_EQ(header_of(first, "Cache-Control"), "max-age=300") << chunk;
        EXPECT_NE(header_of(first, "ETag"), "");
        EXPECT_EQ(header_of(get(std::string("/zarr/KBGM/REF/") + chunk), "Cache-Control"),
                  "max-age=300");
    }
    EXPECT_EQ(header_of(get("/zarr/KBGM/REF/time/0"), "Cache-Control"), "no-cache");
}

TEST_F(ZarrTest, StatesHaveAFlagForWhatIsUnavailable) {
    const auto all = zarr_json(get("/zarr/KBGM/REF/.zmetadata"))["metadata"];
    EXPECT_EQ(all.at("status/.zarray").at("fill_value"), 4);
    EXPECT_EQ(all.at("status/.zattrs").at("flag_meanings"),
              "not_seen no_echo range_folded value unavailable");
    EXPECT_EQ(all.at("status/.zattrs").at("flag_values"), nlohmann::json::array({0, 1, 2, 3, 4}));
}

// Ambiguous is 5, so that 4 keeps its meaning. A reader sees no value in ambiguous cells.
TEST_F(ZarrTest, StatesOfADerivedMomentHaveAFlagForAmbiguous) {
    const grid::Grid grid = testing::ambiguous_grid();
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
    ASSERT_TRUE(served_.store().commit("KBGM", cache::describe(grid), bricks.view()));
    const auto all = zarr_json(get("/zarr/KBGM/VELD/.zmetadata"))["metadata"];
    EXPECT_EQ(all.at("status/.zarray").at("fill_value"), 4);
    EXPECT_EQ(all.at("status/.zattrs").at("flag_values"),
              nlohmann::json::array({0, 1, 2, 3, 5, 4}));
    EXPECT_EQ(all.at("status/.zattrs").at("flag_meanings"),
              "not_seen no_echo range_folded value ambiguous unavailable");
    const auto states = numbers_in<std::int8_t>(get("/zarr/KBGM/VELD/status/0.0.0.0"));
    const auto values = numbers_in<float>(get("/zarr/KBGM/VELD/VELD/0.0.0.0"));
    ASSERT_EQ(states.size(), values.size());
    EXPECT_GT(std::ranges::count(states, 5), 1000);
    for (std::size_t i = 0; i < states.size(); ++i)
        ASSERT_EQ(std::isnan(values[i]), states[i] != 3) << i;
}

TEST_F(ZarrTest, VersionThreeSaysTheSame) {
    const auto group = zarr_json(get3("/zarr3/KBGM/REF/zarr.json"));
    const auto& arrays = group.at("consolidated_metadata").at("metadata");
    const auto all = zarr_json(get("/zarr/KBGM/REF/.zmetadata"))["metadata"];
    EXPECT_EQ(arrays.size() * 2 + 2, all.size());
    for (const auto& [name, array] : arrays.items()) {
        EXPECT_EQ(array, zarr_json(get3("/zarr3/KBGM/REF/" + name + "/zarr.json")));
        EXPECT_EQ(array.at("shape"), all.at(name + "/.zarray").at("shape"));
        EXPECT_EQ(array.at("chunk_grid").at("configuration").at("chunk_shape"),
                  all.at(name + "/.zarray").at("chunks"));
        EXPECT_EQ(array.at("dimension_names"), all.at(name + "/.zattrs").at("_ARRAY_DIMENSIONS"));
    }
    EXPECT_EQ(body_of(get("/zarr/KBGM/REF/REF/0.0.0.0")),
              body_of(get3("/zarr3/KBGM/REF/REF/c/0/0/0/0")));
}

// A group has the cells of the newest grid. The oldest grid of this cache has other cells.
TEST_F(ZarrTest, ChunksHoldTheCellsOfTheGrid) {
    const auto newest = *sources_.grids->newest("KBGM", level2::Moment::ref);
    const auto grid = *sources_.grids->find("KBGM", level2::Moment::ref, newest);
    const grid::Grid dense = grid::to_dense(grid->file.view());
    const auto values = numbers_in<float>(get("/zarr/KBGM/REF/REF/2.0.0.0"));
    const auto states = numbers_in<std::int8_t>(get("/zarr/KBGM/REF/status/2.0.0.0"));
    const auto levels = static_cast<std::size_t>(chunk_levels(dense.spec));
    ASSERT_EQ(values.size(), levels * chunk_side * chunk_side);
    ASSERT_EQ(states.size(), values.size());
    std::size_t with_value = 0;
    for (int iz = 0; iz < dense.spec.nz(); ++iz) {
        for (int iy = 0; iy < std::min(chunk_side, dense.spec.ny); ++iy) {
            for (int ix = 0; ix < std::min(chunk_side, dense.spec.nx); ++ix) {
                const std::size_t cell = dense.spec.index(ix, iy, iz);
                const auto status = dense.status[cell];
                ASSERT_EQ(states[at(ix, iy, iz)], static_cast<std::int8_t>(status));
                if (status == grid::CellStatus::value) {
                    ++with_value;
                    ASSERT_EQ(values[at(ix, iy, iz)], dense.values[cell]);
                } else {
                    ASSERT_TRUE(std::isnan(values[at(ix, iy, iz)]));
                }
            }
        }
    }
    EXPECT_GT(with_value, 0u);
}

// Reads the whole array of a product, chunk by chunk, and compares it with the field.
TEST_F(ZarrTest, AProductIsAGroupWhoseColumnsAreThoseOfItsMap) {
    const auto newest = *sources_.grids->newest("KBGM", level2::Moment::ref);
    const auto grid = *sources_.grids->find("KBGM", level2::Moment::ref, newest);
    const grid::BrickView view = grid->file.view();
    const auto facts = render::frame_facts_of("KBGM", grid->file.description(), "UTC");
    for (const char* name : {"mesh", "echotop", "composite.REF"}) {
        const auto layer = *map_product_named(name);
        const auto style = *map_style(layer, {}, {});
        const auto field = *render::still_field({view, facts, style.scene}, 1);
        const std::string group = std::string("/zarr/KBGM/") + name;
        const std::string array = render::map_variable(layer.product);
        const auto all = zarr_json(get(group + "/.zmetadata"))["metadata"];
        EXPECT_EQ(all.at(array + "/.zarray").at("shape"),
                  nlohmann::json::array({3, field.height, field.width}));
        EXPECT_EQ(all.at(array + "/.zattrs").at("_ARRAY_DIMENSIONS"),
                  nlohmann::json::array({"time", "y", "x"}));
        EXPECT_FALSE(all.contains("z/.zarray"));
        EXPECT_EQ(all.at("status/.zarray").at("fill_value"), 6);
        for (int cy = 0; cy < chunks_along(field.height); ++cy) {
            for (int cx = 0; cx < chunks_along(field.width); ++cx) {
                const std::string chunk = fmt::format("/2.{}.{}", cy, cx);
                const auto values = numbers_in<float>(get(group + "/" + array + chunk));
                const auto states = numbers_in<std::int8_t>(get(group + "/status" + chunk));
                ASSERT_EQ(values.size(), std::size_t{chunk_side} * chunk_side);
                ASSERT_EQ(states.size(), values.size());
                for (std::size_t i = 0; i < values.size(); ++i) {
                    const int ix = cx * chunk_side + static_cast<int>(i) % chunk_side;
                    const int iy = cy * chunk_side + static_cast<int>(i) / chunk_side;
                    if (ix >= field.width || iy >= field.height) {
                        ASSERT_EQ(states[i], map_status_unavailable);
                        ASSERT_TRUE(std::isnan(values[i]));
                        continue;
                    }
                    const std::size_t column = field.index(ix, iy);
                    ASSERT_EQ(states[i], static_cast<int>(render::state_of(field, column)));
                    if (field.status[column] == grid::CellStatus::value)
                        ASSERT_EQ(values[i], field.values[column]);
                    else
                        ASSERT_TRUE(std::isnan(values[i]));
                }
            }
        }
    }
}

TEST_F(ZarrTest, AProductSaysWhatItAssumesInBothVersions) {
    const auto two = zarr_json(get("/zarr/KBGM/posh/.zmetadata"))["metadata"];
    const auto three = zarr_json(get3("/zarr3/KBGM/posh/posh/zarr.json"));
    const auto& attributes = three.at("attributes");
    EXPECT_EQ(attributes.at("assumed_height_of_0_C_m"), 4200);
    EXPECT_EQ(attributes.at("units"), "%");
    EXPECT_EQ(two.at("posh/.zattrs").at("assumed_height_of_0_C_m"), 4200);
    EXPECT_EQ(two.at("status/.zattrs").at("flag_meanings"),
              "not_seen no_echo range_folded value value_or_more unavailable");
    EXPECT_EQ(body_of(get("/zarr/KBGM/posh/posh/2.0.0")),
              body_of(get3("/zarr3/KBGM/posh/posh/c/2/0/0")));
    const auto index = zarr_json(get("/zarr"));
    const auto named = [&](const char* name) {
        return std::ranges::any_of(index.at("products"),
                                   [&](const auto& one) { return one.at("product") == name; });
    };
    EXPECT_TRUE(named("posh"));
    EXPECT_FALSE(named("rain-total")) << "a rain total is made of several grids";
    EXPECT_FALSE(named("rotation")) << "the domain has no grids of AZSH";
}

TEST_F(ZarrTest, ProductsThatAGroupCannotHaveAreNotFound) {
    for (const char* target :
         {"/zarr/KBGM/rain-total/.zmetadata", "/zarr/KBGM/volume/.zmetadata",
          "/zarr/KBGM/vil.VEL/.zmetadata", "/zarr/KBGM/rotation/.zmetadata",
          "/zarr/KBGM/mesh/mesh/2.9.0", "/zarr/KBGM/mesh/mesh/2.0.0.0",
          "/zarr/KBGM/mesh/mesh/3.0.0", "/zarr/KBGM/mesh/z/0", "/zarr/KFDR/mesh/.zmetadata"})
        EXPECT_EQ(get(target).status, 404u) << target;
    EXPECT_EQ(get("/zarr/KBGM/mesh/mesh/0.0.0").status, 404u) << "the oldest grid has other cells";
}

// Compares every chunk of a grid with cells of all states, including the cells beyond its edges.
void expect_cells_in_every_chunk(const grid::Grid& grid) {
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
    const grid::Grid dense = grid::to_dense(bricks.view());
    const grid::GridSpec& spec = grid.spec;
    const int levels = chunk_levels(spec);
    std::vector<std::size_t> seen(grid::states_of(grid.moment).size() + 1);
    for (int cy = 0; cy < chunks_along(spec.ny); ++cy) {
        for (int cx = 0; cx < chunks_along(spec.nx); ++cx) {
            const std::string states = status_chunk(bricks.view(), {0, cy, cx});
            const std::string values = value_chunk(bricks.view(), {0, cy, cx});
            ASSERT_EQ(values.size(), states.size() * sizeof(float));
            for (int i = 0; i < static_cast<int>(states.size()); ++i) {
                const int ix = cx * chunk_side + i % chunk_side;
                const int iy = cy * chunk_side + i / chunk_side % chunk_side;
                const int iz = i / chunk_side / chunk_side;
                ASSERT_LT(iz, levels);
                const auto state = static_cast<std::size_t>(states[static_cast<std::size_t>(i)]);
                float value = 0;
                std::memcpy(&value, values.data() + static_cast<std::size_t>(i) * sizeof value,
                            sizeof value);
                ++seen.at(state);
                if (ix >= spec.nx || iy >= spec.ny) {
                    ASSERT_EQ(state, static_cast<std::size_t>(status_unavailable));
                    ASSERT_TRUE(std::isnan(value));
                    continue;
                }
                const std::size_t cell = spec.index(ix, iy, iz);
                ASSERT_EQ(state, static_cast<std::size_t>(dense.status[cell]));
                ASSERT_EQ(std::isnan(value), dense.status[cell] != grid::CellStatus::value);
                if (!std::isnan(value)) {
                    ASSERT_EQ(value, dense.values[cell]);
                }
            }
        }
    }
    for (const std::size_t cells : seen)
        EXPECT_GT(cells, 0u) << "the grid must have cells of every state, and an edge";
}

TEST_F(ZarrTest, ChunksOfEveryPlaceHoldTheirCells) {
    expect_cells_in_every_chunk(served_.small());
    expect_cells_in_every_chunk(testing::ambiguous_grid());
}

TEST_F(ZarrTest, ATimeKeepsItsNumberWhenItsGridIsEvictedAndAfterARestart) {
    const auto before = numbers_in<double>(get("/zarr/KBGM/REF/time/0"));
    const auto first = sources_.grids->times("KBGM", level2::Moment::ref);
    ASSERT_EQ(first.size(), 3u);
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(before[i], std::chrono::duration<double>(first[i].time_since_epoch()).count());
    }
    EXPECT_TRUE(std::isnan(before[3]));
    ASSERT_EQ(get("/zarr/KBGM/REF/status/1.0.0.0").status, 200u);
    const auto entries = *served_.store().list("KBGM", level2::Moment::ref, first[1], first[1]);
    ASSERT_EQ(entries.size(), 1u);
    ASSERT_TRUE(served_.store().remove(entries.front()));
    sources_.grids->refresh();
    // A grid that comes late has the next number.
    ASSERT_TRUE(
        testing::commit_sized(served_.store(), "KBGM", first[1] - std::chrono::minutes{60}));
    sources_.grids->refresh();

    sources_.numbers = std::make_shared<TimeNumbers>(state_.path());
    ZarrDoor again(sources_, ZarrVersion::two);
    const auto after = numbers_in<double>(asked(again, "/zarr/KBGM/REF/time/0"));
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(after[i], before[i]);
    EXPECT_EQ(after[3], before[1] - 3600);
    EXPECT_EQ(asked(again, "/zarr/KBGM/REF/status/1.0.0.0").status, 404u);
    EXPECT_EQ(asked(again, "/zarr/KBGM/REF/status/2.0.0.0").status, 200u);
    EXPECT_EQ(asked(again, "/zarr/KBGM/REF/status/3.0.0.0").status, 200u);
}

// 2026-11-28: after a change of the configuration, kept chunks of the old cells appeared in the
// array of the new cells, at twice their distance.
TEST_F(ZarrTest, KeptChunksOfOtherCellsThanTheNewestAreUnavailable) {
    const char* const chunk = "/zarr/KBGM/REF/status/1.0.0.0";
    ASSERT_EQ(get(chunk).status, 200u);
    ASSERT_TRUE(door_.answer_at_once(request_for(chunk)));
    grid::Grid other = served_.small();
    other.time = testing::noon + std::chrono::minutes{10};
    (void)served_.store().commit("KBGM", cache::describe(other),
                                 grid::BrickGrid::from(other, ServedGrids::quantization()).view());
    sources_.grids->refresh();
    EXPECT_EQ(get(chunk).status, 404u);
    EXPECT_FALSE(door_.answer_at_once(request_for(chunk)));
}

TEST_F(ZarrTest, DamagedNumbersAreAnErrorAndNotNewNumbers) {
    (void)get("/zarr/KBGM/REF/time/0");
    const auto path = state_ / "KBGM/REF.times";
    ASSERT_TRUE(std::filesystem::exists(path));
    {
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(20);
        file.put('x');
    }
    sources_.numbers = std::make_shared<TimeNumbers>(state_.path());
    ZarrDoor again(sources_, ZarrVersion::two);
    const Answer answer = asked(again, "/zarr/KBGM/REF/time/0");
    EXPECT_EQ(answer.status, 500u);
    EXPECT_EQ(body_of(answer).find(state_.path().native()), std::string::npos)
        << "the client does not learn paths of the server";
    EXPECT_NE(answer.trouble.find(path.native()), std::string::npos) << "the log has the path";
}

// The server must not give numbers that it would not know after the next start.
TEST_F(ZarrTest, NumbersThatCannotBeKeptAreNotGiven) {
    std::ofstream(state_ / "file") << "not a directory";
    sources_.numbers = std::make_shared<TimeNumbers>(state_ / "file");
    ZarrDoor door(sources_, ZarrVersion::two);
    const Answer answer = asked(door, "/zarr/KBGM/REF/time/0");
    EXPECT_EQ(answer.status, 503u);
    EXPECT_EQ(body_of(answer).find(state_.path().native()), std::string::npos);
    EXPECT_TRUE(sources_.numbers->problem());
    EXPECT_FALSE(sources_.numbers->time_of("KBGM", "REF", 0));
}

// 2026-11-28: if the disk was full or read-only, requests for times that already had numbers
// failed, too.
TEST_F(ZarrTest, NumbersThatWereGivenAreAnsweredWhileNewOnesCannotBeKept) {
    TimeNumbers numbers(state_.path());
    const std::vector<UtcTime> two = {UtcTime{std::chrono::seconds{1}},
                                      UtcTime{std::chrono::seconds{2}}};
    std::vector<UtcTime> three = two;
    three.push_back(UtcTime{std::chrono::seconds{3}});
    ASSERT_TRUE(numbers.update("KBGM", "REF", two));
    std::filesystem::remove_all(state_ / "KBGM");
    std::ofstream(state_ / "KBGM") << "not a directory";
    auto times = numbers.update("KBGM", "REF", three);
    ASSERT_TRUE(times);
    EXPECT_EQ(**times, two);
    EXPECT_TRUE(numbers.problem());
    std::filesystem::remove(state_ / "KBGM");
    times = numbers.update("KBGM", "REF", three);
    ASSERT_TRUE(times);
    EXPECT_EQ(**times, three);
    EXPECT_FALSE(numbers.problem());
}

TEST_F(ZarrTest, KeysThatAreNoneAreRefused) {
    for (const char* key :
         {"", "/", "REF", "REF/0.0.0", "REF/0.0.0.0.0", "REF/00.0.0.0", "REF/-1.0.0.0",
          "REF/0.0.0.a", "REF/3.0.0.0", "REF/99999999999999999999.0.0.0", "time/1",
          "azimuthal_equidistant/1", "VEL/.zarray", "REF/zarr.json", "zarr.json", "REF/c/0/0/0/0",
          "lat/0.99", "a/b/c"}) {
        EXPECT_EQ(get(std::string("/zarr/KBGM/REF/") + key).status, 404u) << key;
    }
    EXPECT_EQ(get("/zarr/KBGM/XYZ/.zgroup").status, 404u);
    EXPECT_EQ(get("/zarr/KBGM/VEL/.zgroup").status, 404u);
    EXPECT_EQ(get("/zarr/NONE/REF/.zgroup").status, 404u);
    EXPECT_FALSE(std::filesystem::exists(state_ / "NONE"));
    EXPECT_EQ(numbers_in<std::int32_t>(get("/zarr/KBGM/REF/azimuthal_equidistant/0")).size(), 1u);
}

}  // namespace
}  // namespace stormcellar::web
