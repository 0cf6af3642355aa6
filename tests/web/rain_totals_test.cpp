// Tests rain totals of the data server on steady rain, whose total is known: as tiles, by WMS, as
// pictures and data, and as Zarr arrays.
#include "web/data/storms/rain_totals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <nlohmann/json.hpp>

#include "render/products/rain_of_domain.h"
#include "render/still/map_attributes.h"
#include "stormcellar/retrieve/rain_rate.h"
#include "tests/cli/uniform_grid.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"
#include "tests/web/asked.h"
#include "tests/web/library_picture.h"
#include "web/doors/pictures/frames.h"
#include "web/doors/pictures/tiles.h"
#include "web/doors/wms/wms.h"
#include "web/doors/zarr/zarr.h"

namespace stormcellar::web {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr float rain_dbz = 40;
constexpr UtcTime rain_start{std::chrono::sys_days{std::chrono::year{2005} / 8 / 22}};
constexpr UtcTime rain_end = rain_start + std::chrono::minutes{90};

// A cache that has grids of REF of steady rain, every ten minutes for an hour and a half.
class ServedRain : public ::testing::Test {
  protected:
    void SetUp() override {
        for (int minute = 0; minute <= 90; minute += 10)
            commit(minute, rain_dbz);
        grids_ = *Grids::open({.cache = directory_ / "cache"});
        rain_ = totals({});
    }
    void commit(int minute, float dbz) {
        grid::Grid grid = testing::uniform_grid("20050822_000000", dbz);
        grid.spec.levels_m = {1000, 2000};
        grid.values.assign(grid.spec.cell_count(), dbz);
        grid.status.assign(grid.spec.cell_count(), grid::CellStatus::value);
        grid.time = grid.start_time = grid.end_time = rain_start + std::chrono::minutes(minute);
        (void)testing::commit_grid(writer_, grid);
    }
    [[nodiscard]] std::shared_ptr<RainTotals> totals(RainTotalsOptions options) const {
        options.grids = grids_;
        if (options.patience == RainTotalsOptions{}.patience)
            options.patience = std::chrono::minutes{1};
        return std::make_shared<RainTotals>(std::move(options));
    }
    [[nodiscard]] std::shared_ptr<MapPictures> maps() const {
        return std::make_shared<MapPictures>(MapPicturesOptions{.grids = grids_, .rain = rain_});
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter writer_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::shared_ptr<Grids> grids_;
    std::shared_ptr<RainTotals> rain_;
    const double mm_per_h_ = retrieve::rain_by_reflectivity_mm_per_h(static_cast<double>(rain_dbz));
};

TEST_F(ServedRain, IsTheTotalThatTheLibraryMakesAndIsKept) {
    EXPECT_EQ(rain_->find_if_kept("KBGM", 1, rain_end), nullptr);
    const auto total = rain_->find("KBGM", 1, rain_end);
    ASSERT_TRUE(total) << total.error().message;
    const auto made = render::rain_total_of_domain(
        writer_, {.domain = "KBGM", .span = render::span_ending(rain_end, 1)});
    ASSERT_TRUE(made);
    const grid::Grid known = grid::to_dense(made->bricks()->view());
    const grid::Grid served = grid::to_dense((*total)->file.view());
    EXPECT_EQ(served.values, known.values);
    EXPECT_EQ(served.status, known.status);
    EXPECT_NEAR(served.values.front(), mm_per_h_, 0.02);
    EXPECT_EQ((*total)->file.description().provenance.notes, made->description().provenance.notes);
    EXPECT_EQ((*total)->moment, level2::Moment::rate);
    EXPECT_EQ((*total)->time, rain_end);
    EXPECT_EQ(rain_->find_if_kept("KBGM", 1, rain_end), *total);
    EXPECT_EQ(*rain_->find("KBGM", 1, rain_end), *total);
    EXPECT_EQ(rain_->made(), 1u);
}

TEST_F(ServedRain, CountsTheHoursThatWereNotSeen) {
    const auto total = rain_->find("KBGM", 3, rain_end);
    ASSERT_TRUE(total);
    EXPECT_THAT((*total)->file.description().provenance.notes,
                Contains(HasSubstr("180 minutes, 90 of them without volumes")));
    EXPECT_EQ(grid::to_dense((*total)->file.view()).status.front(), grid::CellStatus::ambiguous);
}

TEST_F(ServedRain, TakesNoLaterGridsAndIsMadeAgainIfAGridOfItsTimeChanges) {
    const UtcTime earlier = rain_start + std::chrono::minutes{70};
    const auto first = rain_->find("KBGM", 1, earlier);
    ASSERT_TRUE(first);
    commit(100, 50);
    ASSERT_TRUE(testing::eventually(
        [&] { return grids_->newest("KBGM", level2::Moment::ref) > rain_end; }));
    EXPECT_EQ(*rain_->find("KBGM", 1, earlier), *first) << "a later grid changes nothing";
    EXPECT_EQ(rain_->made(), 1u);
    const std::uint64_t changes = grids_->changes();
    commit(40, 50);
    ASSERT_TRUE(testing::eventually([&] { return grids_->changes() > changes; }));
    const auto again = rain_->find("KBGM", 1, earlier);
    ASSERT_TRUE(again);
    EXPECT_NE((*again)->id, (*first)->id);
    EXPECT_EQ(rain_->made(), 2u);
}

TEST_F(ServedRain, DoesNotHoldUpRequests) {
    const auto hasty = totals({.patience = std::chrono::milliseconds{0}});
    const auto not_yet = hasty->find("KBGM", 1, rain_end);
    EXPECT_TRUE(not_yet || not_yet.error().code == ErrorCode::busy);
    EXPECT_TRUE(testing::eventually([&] { return hasty->find("KBGM", 1, rain_end).has_value(); }));
    EXPECT_EQ(hasty->made(), 1u);
}

TEST_F(ServedRain, RefusesWhatIsTooLargeOrMissing) {
    const auto few = totals({.most_grids = 3})->find("KBGM", 1, rain_end);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(few.error().message, HasSubstr("too large for this server"));
    EXPECT_FALSE(totals({.most_columns = 1000})->find("KBGM", 1, rain_end));
    EXPECT_EQ(rain_->find("KBGM", 1, rain_end + std::chrono::hours{1}).error().code,
              ErrorCode::not_found);
    EXPECT_EQ(rain_->find("KFDR", 1, rain_end).error().code, ErrorCode::not_found);
    const auto alone = rain_->find("KBGM", 1, rain_start);
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error().message, "a rain total needs at least two volumes");
}

TEST_F(ServedRain, IsALayerOfTilesAndOfTheMapService) {
    TilesDoor tiles(maps());
    const std::string index = body_of(asked(tiles, "/tiles"));
    for (const char* layer : {"\"rain-total.1h\"", "\"rain-total.3h\"", "\"rain-total.24h\""})
        EXPECT_THAT(index, HasSubstr(layer));
    const Answer tile = asked(tiles, "/tiles/KBGM/rain-total.1h/latest/7/36/47.png");
    EXPECT_EQ(tile.status, 200u) << body_of(tile);
    EXPECT_EQ(asked(tiles, "/tiles/KBGM/rain-total.2h/2005-08-22T01:30:00Z/tilejson.json").status,
              200u);
    for (const char* wrong : {"rain-total", "rain-total.0h", "rain-total.25h", "rain-total.h",
                              "rain-total.01h", "rain-total.RATE"}) {
        const Answer refused =
            asked(tiles, std::string("/tiles/KBGM/") + wrong + "/latest/7/36/47.png");
        EXPECT_EQ(refused.status, 404u) << wrong;
    }

    WmsDoor wms(maps());
    EXPECT_THAT(body_of(asked(wms, "/wms?SERVICE=WMS&REQUEST=GetCapabilities")),
                HasSubstr("Rain total at the lowest height seen, 3 hours"));
    const std::string about =
        "/wms?SERVICE=WMS&VERSION=1.3.0&REQUEST=GetFeatureInfo&LAYERS=KBGM:rain-total.1h&CRS=CRS:84"
        "&BBOX=-76.1,42.1,-75.9,42.3&WIDTH=10&HEIGHT=10&QUERY_LAYERS=KBGM:rain-total.1h&I=5&J=5"
        "&INFO_FORMAT=application/json";
    const Answer info = asked(wms, about);
    ASSERT_EQ(info.status, 200u) << body_of(info);
    const auto value = nlohmann::json::parse(body_of(info))["features"][0]["properties"];
    EXPECT_NEAR(value["value"].get<double>(), mm_per_h_, 0.02);
    EXPECT_EQ(value["unit"], "mm");
    EXPECT_EQ(asked(wms, "/wms?REQUEST=GetLegendGraphic&FORMAT=image/png&LAYER=KBGM:rain-total.3h")
                  .status,
              200u);
    EXPECT_EQ(rain_->made(), 2u) << "of one and of two hours; the legend needs none";
}

TEST_F(ServedRain, IsAPictureAndDataAsTheLibraryDrawsThem) {
    FramesDoor door(grids_, std::make_shared<FramePictures>(FramePicturesOptions{}), nullptr, rain_,
                    nullptr);
    const auto made = *render::rain_total_of_domain(
        writer_, {.domain = "KBGM", .span = render::span_ending(rain_end, 1)});
    const auto bricks = *made.bricks();
    const grid::BrickView view = bricks.view();
    const auto description = made.description();
    const std::string domain = "KBGM";
    for (const char* ending : {"png", "nc", "tif"}) {
        const Answer answer = asked(
            door, std::string("/frames/KBGM.") + ending +
                      "?product=rain-total&hours=1&width=400&height=300&time=2005-08-22T01:35:00Z");
        ASSERT_EQ(answer.status, 200u) << body_of(answer);
        render::SceneOptions options = small_picture("rain-total");
        options.moment = "RATE";
        const render::StillSource still{domain, view, description, options, false};
        EXPECT_TRUE(body_of(answer) == library_picture(still, std::string("a.") + ending))
            << ending;
    }
    for (const char* wrong :
         {"product=rain-total", "product=rain-total&hours=0", "product=rain-total&hours=25",
          "product=rain-total&hours=1.5", "product=composite&hours=1",
          "product=rain-total&hours=1&panels=RATE"})
        EXPECT_EQ(asked(door, std::string("/frames/KBGM.png?") + wrong).status, 400u) << wrong;
}

TEST_F(ServedRain, IsAZarrGroup) {
    const testing::TemporaryDirectory state;
    ZarrDoor door({grids_, std::make_shared<KeptAnswers>(std::uint64_t{16} << 20),
                   std::make_shared<TimeNumbers>(state.path()), maps()},
                  ZarrVersion::two);
    EXPECT_THAT(body_of(asked(door, "/zarr")), HasSubstr("/zarr/KBGM/rain-total.3h"));
    const Answer documents = asked(door, "/zarr/KBGM/rain-total.1h/.zmetadata");
    ASSERT_EQ(documents.status, 200u) << body_of(documents);
    EXPECT_EQ(rain_->made(), 0u) << "the documents need no total";
    const auto all = nlohmann::json::parse(body_of(documents))["metadata"];
    const std::string array = render::map_variable(render::Product::rain_total);
    EXPECT_EQ(all.at(array + "/.zarray").at("shape"), nlohmann::json::array({10, 40, 40}));
    EXPECT_EQ(all.at(array + "/.zattrs").at("units"), "mm");
    const Answer chunk = asked(door, "/zarr/KBGM/rain-total.1h/" + array + "/9.0.0");
    ASSERT_EQ(chunk.status, 200u) << body_of(chunk);
    const std::string packed = body_of(chunk);
    std::vector<float> values(128 * 128);
    std::size_t bytes = 0;
    libdeflate_decompressor* reader = libdeflate_alloc_decompressor();
    EXPECT_EQ(libdeflate_gzip_decompress(reader, packed.data(), packed.size(), values.data(),
                                         values.size() * sizeof(float), &bytes),
              LIBDEFLATE_SUCCESS);
    libdeflate_free_decompressor(reader);
    EXPECT_EQ(bytes, values.size() * sizeof(float));
    EXPECT_NEAR(values.front(), mm_per_h_, 0.02);
    EXPECT_EQ(body_of(asked(door, "/zarr/KBGM/rain-total.1h/" + array + "/9.0.0")), packed);
    EXPECT_EQ(rain_->made(), 1u);
}

}  // namespace
}  // namespace stormcellar::web
