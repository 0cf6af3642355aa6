// Tests the API over grids, without a server.
#include <cstring>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/view/fitted_camera.h"
#include "stormcellar/cache/grid_file.h"
#include "tests/web/served_grids.h"
#include "web/data/grids/packed_grid.h"

namespace stormcellar::web {
namespace {

nlohmann::json json_of(const Answer& answer) {
    EXPECT_EQ(answer.status, 200u) << body_of(answer);
    return nlohmann::json::parse(body_of(answer));
}

class Api : public ::testing::Test {
  protected:
    // Adds testing::ambiguous_grid(). Returns its path.
    std::string add_ambiguous_grid() {
        const grid::Grid grid = testing::ambiguous_grid();
        const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
        EXPECT_TRUE(served_.store().commit("KBGM", cache::describe(grid), bricks.view()));
        return "/api/v1/grids/KBGM/VELD/2005-08-22T02:44:14.123Z";
    }
    ServedGrids served_;
};

TEST_F(Api, ListsDomainsAndGrids) {
    const auto domains = json_of(served_.get("/api/v1/domains"))["domains"];
    ASSERT_EQ(domains.size(), 1u);
    EXPECT_EQ(domains[0]["domain"], "KBGM");
    EXPECT_EQ(domains[0]["moments"][0]["grids"], 3);
    EXPECT_EQ(domains[0]["moments"][0]["newest"], "2024-11-22T12:05:00Z");
    const auto of = [&](const char* query) {
        std::vector<std::string> times;
        const auto answer = json_of(served_.get(std::string("/api/v1/grids") + query));
        for (const auto& grid : answer["grids"])
            times.push_back(grid["time"]);
        return times;
    };
    using Times = std::vector<std::string>;
    EXPECT_EQ(of(""),
              (Times{"2005-08-22T02:44:14.123Z", "2024-11-22T12:00:00Z", "2024-11-22T12:05:00Z"}));
    EXPECT_EQ(of("?limit=1"), (Times{"2024-11-22T12:05:00Z"})) << "the limit keeps the newest grid";
    EXPECT_EQ(of("?from=2024-11-22T12:00&to=2024-11-22T12:04"), (Times{"2024-11-22T12:00:00Z"}));
    EXPECT_EQ(of("?moment=VEL"), Times{});
    EXPECT_EQ(of("?domain=KOKX"), Times{});
}

// 2026-11-28: while a grid was computed for one client, all other clients got 503.
TEST_F(Api, WhatIsComputedWaitsForItsTurnAndWhatIsKeptDoesNot) {
    const Request netcdf = request_for(std::string(ServedGrids::noon_path) + "/netcdf", {});
    EXPECT_FALSE(served_.door().answer_soon(netcdf));
    EXPECT_EQ(served_.door().answer(netcdf).status, 200u);
    const auto kept = served_.door().answer_soon(netcdf);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->status, 200u);
    const Request halved =
        request_for(std::string(ServedGrids::noon_path) + "/packed?half=1&by=mean", {});
    EXPECT_FALSE(served_.door().answer_soon(halved));
    EXPECT_TRUE(served_.door().answer_soon(request_for("/api/v1/domains", {})));
}

TEST_F(Api, DescribesAGridWithAllOfItsProvenance) {
    const auto grid = json_of(served_.get(ServedGrids::small_path));
    const std::string all = grid.dump();
    for (const char* word :
         {"position 714 m", "a note", "KBGM: standby, alarm 452", "frame: WGS84 table",
          "column-linear", "4/3 earth", "KBGM20050822_024414"})
        EXPECT_NE(all.find(word), std::string::npos) << word;
    EXPECT_EQ(grid["nx"], 40);
    EXPECT_EQ(grid["levels_m"].size(), 18u);
}

TEST_F(Api, RefusesWhatMakesNoSense) {
    const std::string grid = ServedGrids::small_path;
    for (const std::string& target : {std::string{"/api/v1/grids?limit=0"},
                                      std::string{"/api/v1/grids?limit=99999999999999999999"},
                                      std::string{"/api/v1/grids?limit=x"},
                                      std::string{"/api/v1/grids?from=soon"},
                                      std::string{"/api/v1/grids?moment=XYZ"},
                                      std::string{"/api/v1/grids?colour=red"},
                                      grid + "/probe",
                                      grid + "/probe?at=nan,0",
                                      grid + "/probe?at=91,0",
                                      grid + "/probe?at=1e999,0",
                                      grid + "/probe?at=42",
                                      grid + "/profile?from=42,-76",
                                      grid + "/packed?part=x",
                                      grid + "/packed?bricks=5-4",
                                      grid + "/packed?bricks=0-99999999999",
                                      grid + "/packed?half=1",
                                      grid + "/packed?half=99&by=mean",
                                      grid + "/packed?part=table&bricks=0-1",
                                      grid + "/packed?most=0",
                                      grid + "/packed?most=9&bricks=0-1",
                                      grid + "/packed?codes=x",
                                      grid + "/packed?codes=values&part=table",
                                      grid + "/packed?window=0-1",
                                      grid + "/packed?window=1-0,0-0",
                                      grid + "/packed?window=0-3,0-0",
                                      grid + "/packed?window=0-0,0-2",
                                      grid + "/packed?window=0-0,0-0&part=table"}) {
        const Answer answer = served_.get(target);
        EXPECT_EQ(answer.status, 400u) << target;
        EXPECT_FALSE(nlohmann::json::parse(body_of(answer))["error"].get<std::string>().empty());
    }
}

TEST_F(Api, KnowsWhatIsNotThere) {
    for (const char* target :
         {"/api/v1/nothing", "/api/v1/grids/KOKX/REF/latest", "/api/v1/grids/KBGM/VEL/latest",
          "/api/v1/grids/KBGM/REF/2024-11-22T12:00:01Z", "/api/v1/grids/..KBGM/REF/latest",
          "/api/v1/grids/KBGM/REF/latest/nothing"}) {
        EXPECT_EQ(served_.get(target).status, 404u) << target;
    }
}

TEST_F(Api, AnEvictedGridIsGone) {
    EXPECT_EQ(served_.get(ServedGrids::noon_path).status, 200u);
    const auto entries =
        served_.store().list("KBGM", level2::Moment::ref, testing::noon, testing::noon);
    ASSERT_EQ(entries->size(), 1u);
    ASSERT_TRUE(served_.store().remove(entries->front()));
    served_.grids().refresh();
    EXPECT_EQ(served_.get(ServedGrids::noon_path).status, 410u);
    EXPECT_EQ(served_.get(std::string(ServedGrids::noon_path) + "/packed").status, 410u);
}

TEST_F(Api, AGridThatIsMadeAgainHasAnotherTag) {
    const std::string packed = std::string(ServedGrids::noon_path) + "/packed";
    const Answer before = served_.get(packed);
    const std::string etag = header_of(before, "ETag");
    EXPECT_EQ(served_.get(packed, {{"If-None-Match", etag}}).status, 304u);
    const std::string id = json_of(served_.get(ServedGrids::noon_path))["id"];
    EXPECT_EQ(served_.get(packed + "?id=" + id).status, 200u);
    ASSERT_TRUE(testing::commit_sized(served_.store(), "KBGM", testing::noon, 6, 1));
    served_.grids().refresh();
    const Answer after = served_.get(packed, {{"If-None-Match", etag}});
    EXPECT_EQ(after.status, 200u);
    EXPECT_NE(header_of(after, "ETag"), etag);
    EXPECT_EQ(served_.get(packed + "?id=" + id).status, 410u) << "the bytes of the old id are gone";
}

TEST_F(Api, ProbesGiveTheGridsOwnCells) {
    const auto probe =
        json_of(served_.get(std::string(ServedGrids::small_path) + "/probe?at=42.2,-75.98"));
    const int x = probe["column"]["x"], y = probe["column"]["y"];
    const grid::Grid& grid = served_.small();
    ASSERT_EQ(probe["levels"].size(), grid.spec.levels_m.size());
    int levels = 0;
    for (const auto& level : probe["levels"]) {
        const std::size_t at = grid.spec.index(x, y, levels);
        EXPECT_EQ(level["height_m"], grid.spec.levels_m.at(static_cast<std::size_t>(levels)));
        if (grid.status[at] == grid::CellStatus::value) {
            EXPECT_EQ(level["state"], "value");
            EXPECT_NEAR(level["value"], grid.values[at], 0.25);
        } else {
            EXPECT_TRUE(level["value"].is_null());
            EXPECT_NE(level["state"], "value");
        }
        ++levels;
    }
}

// The answer has the numbers of fit_view() for a frame of this size.
TEST_F(Api, AViewIsTheOneThatAFrameHas) {
    const std::string path = ServedGrids::noon_path;
    const auto read = json_of(served_.get(path + "/view?width=900&height=600"));
    const auto file = cache::GridFile::open(
        served_.store().list("KBGM", level2::Moment::ref, std::nullopt, std::nullopt)->at(1).path);
    ASSERT_TRUE(file);
    const render::EchoOutline outline(file->view(), level2::Moment::ref);
    const render::FittedView fitted = render::fit_view(outline, {}, 900, 600);
    EXPECT_EQ(read["time"], "2024-11-22T12:00:00Z");
    EXPECT_EQ(read["camera"]["azimuth_deg"], fitted.camera.azimuth_deg);
    EXPECT_EQ(read["camera"]["tilt_deg"], fitted.camera.tilt_deg);
    ASSERT_TRUE(fitted.camera.eye);
    EXPECT_EQ(read["camera"]["place_m"][0], fitted.camera.eye->x_m);
    EXPECT_EQ(read["focus_m"][1], fitted.focus.y_m);
    EXPECT_EQ(read["distance_m"], fitted.distance_m);
    EXPECT_EQ(read["exaggeration"], fitted.vertical_exaggeration);
    EXPECT_EQ(read["has_echo"], true);
    EXPECT_NE(read["camera"], json_of(served_.get(path + "/view?width=300&height=900"))["camera"]);
    EXPECT_EQ(served_.get(path + "/view?width=0").status, 400u);
}

TEST_F(Api, AmbiguousCellsKeepTheirStateInAnswers) {
    const std::string path = add_ambiguous_grid();
    const auto probe = json_of(served_.get(path + "/probe?at=42.2,-75.83"));
    EXPECT_GE(probe["column"]["x"], 32);
    for (const auto& level : probe["levels"])
        EXPECT_TRUE(level["state"] == "ambiguous" && level["value"].is_null()) << level;
    const std::string line = "/profile?from=42.2,-76.2&to=42.2,-75.8&count=40";
    const auto profile = json_of(served_.get(path + line));
    int ambiguous = 0;
    for (const auto& point : profile["points"]) {
        if (!point["inside"].get<bool>()) continue;
        for (std::size_t i = 0; i < point["states"].size(); ++i) {
            const auto& name = profile["state_names"].at(point["states"][i].get<std::size_t>());
            ASSERT_EQ(name == "value", !point["values"][i].is_null());
            ambiguous += name == "ambiguous" ? 1 : 0;
        }
    }
    EXPECT_GT(ambiguous, 18);
    EXPECT_EQ(
        json_of(served_.get(std::string(ServedGrids::small_path) + line))["state_names"].size(),
        4u);
}

TEST_F(Api, TheOwnFileComesWithRanges) {
    const std::string file = std::string(ServedGrids::noon_path) + "/file";
    const std::string whole = body_of(served_.get(file));
    const Answer part = served_.get(file, {{"Range", "bytes=0-7"}});
    EXPECT_EQ(part.status, 206u);
    EXPECT_EQ(body_of(part), whole.substr(0, 8));
}

TEST_F(Api, DescribesItself) {
    const auto index = json_of(served_.get("/api/v1"));
    const auto document = json_of(served_.get("/api/v1/openapi.json"));
    EXPECT_TRUE(document["openapi"].get<std::string>().starts_with("3.1"));
    EXPECT_GE(document["paths"].size(), 12u);
    EXPECT_TRUE(document["paths"].contains("/api/v1/grids/{domain}/{moment}/{time}/packed"));
    EXPECT_FALSE(index.empty());
}

// Reads the packed form by docs/web/packed-grid.md, with no code of the writer.
class Unpacked {
  public:
    explicit Unpacked(std::string bytes) : bytes_(std::move(bytes)) {
        EXPECT_EQ(bytes_.substr(0, 4), "\x89SCP");
        EXPECT_EQ(number<std::uint64_t>(16), bytes_.size());
    }
    template <class Number>
    [[nodiscard]] Number number(std::uint64_t offset) const {
        Number read{};
        std::memcpy(&read, bytes_.data() + offset, sizeof read);
        return read;
    }
    [[nodiscard]] std::uint32_t u32(std::uint64_t offset) const {
        return number<std::uint32_t>(offset);
    }
    // Returns the code of a cell with a value, else none. Sets `state` to the cell's state.
    [[nodiscard]] std::optional<std::uint16_t> code(int x, int y, int z, int& state) const {
        const std::uint32_t bricks_y = u32(128), bricks_z = u32(132);
        const auto brick = static_cast<std::uint32_t>(x / 16) * bricks_y * bricks_z +
                           static_cast<std::uint32_t>(y / 16) * bricks_z +
                           static_cast<std::uint32_t>(z / 16);
        const std::uint64_t row = number<std::uint64_t>(224) + std::uint64_t{12} * brick;
        const auto kind = number<std::uint8_t>(row);
        const std::uint64_t block = u32(row + 8);
        const auto cell = static_cast<std::uint64_t>((x % 16) * 256 + (y % 16) * 16 + z % 16);
        if (kind == 0) {
            state = number<std::uint8_t>(row + 1);
            return std::nullopt;
        }
        if (kind == 1) {
            const auto byte =
                number<std::uint8_t>(number<std::uint64_t>(232) + 1024 * block + cell / 4);
            state = byte >> (2 * (cell % 4)) & 3;
            return std::nullopt;
        }
        const std::uint64_t size = u32(108);
        const std::uint64_t at = number<std::uint64_t>(240) + (4096 * block + cell) * size;
        const std::uint16_t found =
            size == 1 ? number<std::uint8_t>(at) : number<std::uint16_t>(at);
        if (found >= 3) return found;
        state = found;
        return std::nullopt;
    }

  private:
    std::string bytes_;
};

TEST_F(Api, AGridThatIsLargerThanAskedForComesAsItsTable) {
    const std::string path = std::string(ServedGrids::small_path) + "/packed";
    const std::string whole = body_of(served_.get(path));
    EXPECT_EQ(body_of(served_.get(path + fmt::format("?most={}", whole.size() + 100))), whole);
    EXPECT_EQ(body_of(served_.get(path + "?most=1000")),
              body_of(served_.get(path + "?part=table")));
}

// Puts the codes of values back into their cells, and compares these with the usual form.
TEST_F(Api, CodesOfValuesAloneAreThoseOfAllCells) {
    const std::string path = std::string(ServedGrids::small_path) + "/packed";
    const Unpacked whole(body_of(served_.get(path)));
    const Unpacked alone(body_of(served_.get(path + "?codes=values")));
    EXPECT_EQ(alone.u32(172) & 4U, 4U);
    std::uint64_t block = 0, value = 0, checked = 0;
    std::uint8_t before = 0;
    for (std::uint64_t brick = 0; brick < whole.u32(204); ++brick) {
        const std::uint64_t row = whole.number<std::uint64_t>(224) + 12 * brick;
        const auto kind = whole.number<std::uint8_t>(row);
        if (kind == 0) continue;
        const std::uint64_t states = alone.number<std::uint64_t>(232) + 1024 * block++;
        if (kind == 1) continue;
        const std::uint64_t codes =
            whole.number<std::uint64_t>(240) + std::uint64_t{4096} * whole.u32(row + 8);
        for (std::uint64_t cell = 0; cell < 4096; ++cell) {
            unsigned code = alone.number<std::uint8_t>(states + cell / 4) >> (2 * (cell % 4)) & 3;
            if (code == 3) {
                before += alone.number<std::uint8_t>(alone.number<std::uint64_t>(240) + value++);
                code = before;
            }
            ASSERT_EQ(code, whole.number<std::uint8_t>(codes + cell));
            ++checked;
        }
    }
    EXPECT_EQ(alone.u32(188), block);
    EXPECT_EQ(alone.u32(196), value);
    EXPECT_GT(checked, 0U);
    EXPECT_GT(value, 0U);
}

// Compares the packed form of a grid with its cells. In a derived moment, code 3 is ambiguous.
void expect_packed(const Unpacked& packed, const grid::Grid& grid) {
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
    const grid::BrickView view = bricks.view();
    const bool is_derived = level2::facts_of(grid.moment).is_derived;
    EXPECT_EQ(packed.u32(36), 40u);
    EXPECT_EQ(packed.u32(40), 24u);
    EXPECT_EQ(packed.u32(44), 18u);
    std::size_t values = 0, ambiguous = 0;
    for (int x = 0; x < 40; ++x) {
        for (int y = 0; y < 24; ++y) {
            for (int z = 0; z < 18; ++z) {
                int state = -1;
                const auto code = packed.code(x, y, z, state);
                const grid::CellStatus status = view.status(x, y, z);
                const bool is_ambiguous = is_derived && code == 3;
                ASSERT_EQ(is_ambiguous, status == grid::CellStatus::ambiguous);
                ambiguous += is_ambiguous ? 1 : 0;
                if (is_ambiguous) continue;
                ASSERT_EQ(code.has_value(), status == grid::CellStatus::value);
                if (!code) {
                    ASSERT_EQ(state, static_cast<int>(status));
                }
                if (!code) continue;
                ++values;
                const float value =
                    packed.number<float>(112) +
                    packed.number<float>(116) * static_cast<float>(*code - grid::first_value_code);
                ASSERT_EQ(value, view.value(x, y, z));
            }
        }
    }
    EXPECT_GT(values, 100u);
    EXPECT_EQ(ambiguous > 100, is_derived);
}

TEST_F(Api, ThePackedFormHoldsEachCell) {
    expect_packed(Unpacked(body_of(served_.get(std::string(ServedGrids::small_path) + "/packed"))),
                  served_.small());
    expect_packed(Unpacked(body_of(served_.get(add_ambiguous_grid() + "/packed"))),
                  testing::ambiguous_grid());
}

// Compares a window that begins at the given cell with the whole grid. Returns the number of its
// values.
int compare_window(const Unpacked& whole, const Unpacked& cut, int first_x, int first_y) {
    EXPECT_EQ(cut.u32(160), 0u) << "a window is packed as a whole grid";
    EXPECT_EQ(cut.u32(164), whole.u32(164));
    // Returns the center's distance from the first column, in columns.
    const auto center = [](const Unpacked& grid, std::uint64_t offset, unsigned cells) {
        return 0.5 * (cells - 1) - grid.number<double>(offset);
    };
    EXPECT_EQ(center(cut, 88, cut.u32(36)), center(whole, 88, whole.u32(36)) - first_x);
    EXPECT_EQ(center(cut, 96, cut.u32(40)), center(whole, 96, whole.u32(40)) - first_y);
    int values = 0;
    for (int x = 0; x < static_cast<int>(cut.u32(36)); ++x) {
        for (int y = 0; y < static_cast<int>(cut.u32(40)); ++y) {
            for (int z = 0; z < static_cast<int>(cut.u32(44)); ++z) {
                int state = -1, state_of_whole = -1;
                const auto code = cut.code(x, y, z, state);
                EXPECT_EQ(code, whole.code(first_x + x, first_y + y, z, state_of_whole));
                EXPECT_EQ(state, state_of_whole);
                values += code.has_value() ? 1 : 0;
            }
        }
    }
    return values;
}

TEST_F(Api, AWindowHoldsTheCellsOfTheGridAtTheirPlaces) {
    const std::string path = std::string(ServedGrids::small_path) + "/packed";
    for (const std::string query : {"?", "?half=1&by=maximum&"}) {
        const Unpacked whole(body_of(served_.get(path + query)));
        const auto columns_x = static_cast<int>(whole.u32(124));
        const auto columns_y = static_cast<int>(whole.u32(128));
        int values = 0;
        for (int x = 0; x < columns_x; ++x) {
            for (int y = 0; y < columns_y; ++y) {
                const Unpacked cut(body_of(
                    served_.get(path + query + fmt::format("window={0}-{0},{1}-{1}", x, y))));
                values += compare_window(whole, cut, 16 * x, 16 * y);
            }
        }
        const std::string all = fmt::format("window=0-{},0-{}", columns_x - 1, columns_y - 1);
        const Unpacked same(body_of(served_.get(path + query + all)));
        EXPECT_EQ(compare_window(whole, same, 0, 0), values);
        EXPECT_GT(values, 10);
    }
}

TEST_F(Api, PackedAnswersAreCompressedAsTheClientTakesThem) {
    const std::string packed = std::string(ServedGrids::small_path) + "/packed";
    EXPECT_EQ(header_of(served_.get(packed), "Content-Encoding"), "");
    const Answer gzip = served_.get(packed, {{"Accept-Encoding", "gzip, deflate"}});
    EXPECT_EQ(header_of(gzip, "Content-Encoding"), "gzip");
    EXPECT_EQ(header_of(gzip, "Vary"), "Accept-Encoding");
    EXPECT_EQ(body_of(gzip).substr(0, 2), "\x1f\x8b");
    const Answer zstd = served_.get(packed, {{"Accept-Encoding", "gzip, zstd"}});
    EXPECT_EQ(header_of(zstd, "Content-Encoding"), "zstd");
    EXPECT_EQ(body_of(zstd).substr(0, 4), "\x28\xb5\x2f\xfd");
}

TEST_F(Api, JsonIsCompressedAsTheClientTakesIt) {
    const std::string path = ServedGrids::small_path;
    const Answer plain = served_.get(path);
    const Answer gzip = served_.get(path, {{"Accept-Encoding", "gzip"}});
    EXPECT_EQ(header_of(gzip, "Content-Encoding"), "gzip");
    EXPECT_LT(body_of(gzip).size(), body_of(plain).size());
    EXPECT_NE(header_of(gzip, "ETag"), header_of(plain, "ETag"));
    EXPECT_EQ(served_.get(path, {{"If-None-Match", header_of(plain, "ETag")}}).status, 304u);
}

// 2026-11-28: a reverse proxy could not keep any data of a grid, though it kept tiles of the same
// time.
TEST_F(Api, AGridOfANamedTimeMayBeKept) {
    for (const char* what : {"/packed", "/netcdf", "/file"}) {
        const Answer named = served_.get(std::string(ServedGrids::noon_path) + what);
        EXPECT_EQ(header_of(named, "Cache-Control"), "max-age=300") << what;
        EXPECT_NE(header_of(named, "ETag"), "") << what;
        const Answer latest = served_.get(std::string("/api/v1/grids/KBGM/REF/latest") + what);
        EXPECT_EQ(header_of(latest, "Cache-Control"), "no-cache") << what;
    }
}

TEST_F(Api, AGridThatMayChangeMustBeAskedForEachTime) {
    grid::Grid growing = served_.small();
    for (const bool is_frame : {false, true}) {
        growing.provenance.partial = !is_frame;
        growing.provenance.provisional = is_frame;
        ASSERT_TRUE(served_.store().commit(
            "KBGM", cache::describe(growing),
            grid::BrickGrid::from(growing, ServedGrids::quantization()).view()));
        served_.grids().refresh();
        for (const char* what : {"/packed", "/netcdf", "/file"}) {
            const Answer named = served_.get(std::string(ServedGrids::small_path) + what);
            EXPECT_EQ(header_of(named, "Cache-Control"), "no-cache") << what << is_frame;
        }
    }
}

// 2026-11-28: a box across the antimeridian was refused, so maps ended there.
TEST_F(Api, AMapGoesOnAcrossTheAntimeridian) {
    const std::string rest = "&south=50&north=70&detail=2";
    const auto map = [&](const std::string& sides) {
        return json_of(served_.get("/api/v1/map?" + sides + rest));
    };
    const auto both = map("west=170&east=-160");
    EXPECT_EQ(both, map("west=170&east=200"));
    EXPECT_EQ(both, map("west=-190&east=-160"));
    const auto longitudes = [](const nlohmann::json& answer) {
        std::pair<double, double> ends{1e9, -1e9};
        for (const auto& line : answer.at("lines")) {
            for (const auto& point : line.at("points")) {
                ends.first = std::min(ends.first, point[0].get<double>());
                ends.second = std::max(ends.second, point[0].get<double>());
            }
        }
        return ends;
    };
    EXPECT_LT(longitudes(both).first, 178);
    EXPECT_GT(longitudes(both).second, 190) << "the longitudes of Alaska go on beyond 180";
    const auto west = map("west=170&east=180"), east = map("west=-180&east=-160");
    EXPECT_EQ(both.at("lines").size(), west.at("lines").size() + east.at("lines").size());
    EXPECT_LE(longitudes(east).first, -178);
    const auto atoll = json_of(served_.get("/api/v1/map?west=170&east=-155&south=18&north=24"));
    EXPECT_FALSE(atoll.at("cities").empty()) << "Honolulu";
    EXPECT_GT(atoll.at("cities")[0].at("place")[0].get<double>(), 180);
    EXPECT_EQ(served_.get("/api/v1/map?west=-180&east=180" + rest).status, 200u);
    EXPECT_EQ(served_.get("/api/v1/map?west=10&east=10" + rest).status, 400u);
    EXPECT_EQ(served_.get("/api/v1/map?west=-180&east=181" + rest).status, 400u);
}

// 2026-11-28: linters of OpenAPI complained that each operation lacked these fields.
TEST_F(Api, TheDocumentHasWhatLintersAskFor) {
    const auto document = json_of(served_.get("/api/v1/openapi.json"));
    EXPECT_EQ(document.at("security"), nlohmann::json::array());
    EXPECT_EQ(document.at("info").at("license").at("identifier"), "BSD-3-Clause");
    for (const auto& [path, operations] : document.at("paths").items())
        EXPECT_TRUE(operations.at("get").at("responses").contains("4XX")) << path;
}

TEST_F(Api, TablesAreWholeAndSmallOnTheWire) {
    const Answer plain = served_.get("/api/v1/tables");
    const auto json = json_of(plain);
    EXPECT_EQ(json["usual"]["REF"], "smooth-reflectivity");
    std::set<std::string> names;
    for (const auto& table : json["tables"]) {
        names.insert(table["name"]);
        EXPECT_FALSE(table["stops"].empty() || table["extinction"].empty()) << table["name"];
    }
    for (const auto& [moment, name] : json["usual"].items())
        EXPECT_TRUE(names.contains(name)) << moment;
    const Answer zstd = served_.get("/api/v1/tables", {{"Accept-Encoding", "zstd"}});
    EXPECT_EQ(header_of(zstd, "Content-Encoding"), "zstd");
    EXPECT_NE(header_of(zstd, "ETag"), header_of(plain, "ETag"));
    EXPECT_LT(body_of(zstd).size() * 5, body_of(plain).size());
    const std::string tag = header_of(plain, "ETag");
    EXPECT_EQ(served_.get("/api/v1/tables", {{"If-None-Match", tag}}).status, 304u);
}

}  // namespace
}  // namespace stormcellar::web
