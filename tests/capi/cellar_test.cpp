// Reads catalogs and caches by the C interface, and compares the results with those of the C++
// library.
#include <climits>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/brick_grid.h"
#include "tests/cache/made_grids.h"
#include "tests/capi/opened.h"
#include "tests/catalog/catalog_fixture.h"
#include "tests/testing/program.h"

namespace stormcellar::testing {
namespace {

template <class Object, void (*free_object)(Object*)>
struct Free {
    void operator()(Object* object) const { free_object(object); }
};
template <class Object, void (*free_object)(Object*)>
using Owned = std::unique_ptr<Object, Free<Object, free_object>>;
using OwnedCatalog = Owned<stormcellar_catalog, stormcellar_catalog_free>;
using OwnedFiles = Owned<stormcellar_file_list, stormcellar_file_list_free>;
using OwnedCache = Owned<stormcellar_cache, stormcellar_cache_free>;
using OwnedGrids = Owned<stormcellar_grid_list, stormcellar_grid_list_free>;

std::int64_t in_ms(UtcTime time) {
    return time.time_since_epoch().count();
}

class CCatalog : public catalog::CatalogTest {
  protected:
    void SetUp() override {
        catalog::VolumeFacts first, second;
        first.start_time = noon;
        first.end_time = noon + std::chrono::minutes{5};
        first.vcp = 212;
        first.sweep_count = 19;
        first.radial_count = 12240;
        first.complete = true;
        second.start_time = noon + std::chrono::minutes{5};
        ASSERT_TRUE(catalog_.register_file(catalog::file("/drop/KTLX_one", {first, second})));
        ASSERT_TRUE(catalog_.register_file(catalog::file("/drop/KFWS_one", {first}, "KFWS")));
        stormcellar_catalog* made = nullptr;
        ASSERT_EQ(stormcellar_catalog_open((directory_ / "catalog").c_str(), &made, nullptr),
                  STORMCELLAR_OK);
        reader_.reset(made);
        query_.size = sizeof query_;
    }
    // Returns the paths, stations and starts of all volumes that the query selects.
    std::vector<std::string> listed() {
        stormcellar_file_list* list = nullptr;
        std::size_t count = 0;
        EXPECT_EQ(stormcellar_catalog_list(reader_.get(), &query_, &list, &count, &error_),
                  STORMCELLAR_OK)
            << error_.message;
        list_.reset(list);
        std::vector<std::string> all;
        for (std::size_t i = 0; i < count; ++i) {
            auto facts = empty_facts<stormcellar_file_facts>();
            EXPECT_EQ(stormcellar_file_list_describe(list, i, &facts, nullptr), STORMCELLAR_OK);
            all.push_back(fmt::format("{} {} {}", facts.station, facts.path,
                                      (facts.start_ms - in_ms(noon)) / 60000));
        }
        return all;
    }
    OwnedCatalog reader_;
    OwnedFiles list_;
    stormcellar_query query_{};
    stormcellar_error error_{};
};

TEST_F(CCatalog, StationAndTimesSelectVolumes) {
    using Lines = std::vector<std::string>;
    const Lines all{"KFWS /drop/KFWS_one 0", "KTLX /drop/KTLX_one 0", "KTLX /drop/KTLX_one 5"};
    EXPECT_EQ(listed(), all);
    query_.name = "KTLX";
    query_.from_ms = in_ms(noon) + 1;
    EXPECT_EQ(listed(), Lines{"KTLX /drop/KTLX_one 5"});
    query_.from_ms = 0;
    query_.to_ms = in_ms(noon);
    EXPECT_EQ(listed(), Lines{"KTLX /drop/KTLX_one 0"});
    for (const std::int64_t extreme : {INT64_MIN, INT64_MAX}) {
        query_.from_ms = query_.to_ms = extreme;
        EXPECT_EQ(listed(), Lines{});
    }
}

TEST_F(CCatalog, FactsAreThoseOfTheVolume) {
    query_.name = "KFWS";
    ASSERT_EQ(listed().size(), 1U);
    auto facts = empty_facts<stormcellar_file_facts>();
    ASSERT_EQ(stormcellar_file_list_describe(list_.get(), 0, &facts, nullptr), STORMCELLAR_OK);
    EXPECT_STREQ(facts.state, "complete");
    EXPECT_STREQ(facts.reason, "");
    EXPECT_EQ(facts.start_ms, in_ms(noon));
    EXPECT_EQ(facts.end_ms, in_ms(noon) + 300'000);
    EXPECT_EQ(facts.bytes, 1000U);
    EXPECT_EQ(facts.volume, 1);
    EXPECT_EQ(facts.vcp, 212);
    EXPECT_EQ(facts.sweeps, 19);
    EXPECT_EQ(facts.radials, 12240);
    EXPECT_EQ(facts.complete, 1);
    EXPECT_EQ(stormcellar_file_list_describe(list_.get(), 1, &facts, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
}

TEST_F(CCatalog, WhatDoesNotExistIsAnError) {
    stormcellar_catalog* catalog = nullptr;
    EXPECT_EQ(stormcellar_catalog_open((directory_ / "nothing").c_str(), &catalog, nullptr),
              STORMCELLAR_NOT_FOUND);
    EXPECT_EQ(catalog, nullptr);
    EXPECT_EQ(stormcellar_catalog_open(nullptr, &catalog, nullptr), STORMCELLAR_BAD_ARGUMENT);
    stormcellar_file_list* list = nullptr;
    std::size_t count = 0;
    query_.name = "KOUN";
    EXPECT_EQ(stormcellar_catalog_list(reader_.get(), &query_, &list, &count, nullptr),
              STORMCELLAR_NOT_FOUND);
    query_.moment = "REF";
    EXPECT_EQ(stormcellar_catalog_list(reader_.get(), &query_, &list, &count, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_catalog_list(nullptr, nullptr, &list, &count, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(list, nullptr);
    EXPECT_EQ(stormcellar_file_list_describe(nullptr, 0, nullptr, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
}

class CCache : public ::testing::Test {
  protected:
    void SetUp() override {
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
        ASSERT_TRUE(store);
        for (const int minute : {0, 5, 10})
            commit(*store, "north", small_grid(), minute);
        commit(*store, "KTLX", ambiguous_grid(), 0);
        stormcellar_cache* made = nullptr;
        ASSERT_EQ(stormcellar_cache_open((directory_ / "cache").c_str(), &made, nullptr),
                  STORMCELLAR_OK);
        cache_.reset(made);
        query_.size = sizeof query_;
    }
    static void commit(cache::StoreWriter& store, const std::string& domain, grid::Grid grid,
                       int minute) {
        grid.time = noon + std::chrono::minutes{minute};
        const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
        ASSERT_TRUE(store.commit(domain, cache::describe(grid), bricks.view()));
    }
    // Returns domain, moment and time of all grids that the query selects.
    std::vector<std::string> listed() {
        stormcellar_grid_list* list = nullptr;
        std::size_t count = 0;
        EXPECT_EQ(stormcellar_cache_list(cache_.get(), &query_, &list, &count, &error_),
                  STORMCELLAR_OK)
            << error_.message;
        list_.reset(list);
        std::vector<std::string> all;
        for (std::size_t i = 0; i < count; ++i) {
            const auto facts = facts_at(i);
            all.push_back(fmt::format("{} {} {}", facts.domain, facts.moment,
                                      (facts.time_ms - in_ms(noon)) / 60000));
        }
        return all;
    }
    [[nodiscard]] stormcellar_grid_file_facts facts_at(std::size_t index) const {
        auto facts = empty_facts<stormcellar_grid_file_facts>();
        EXPECT_EQ(stormcellar_grid_list_describe(list_.get(), index, &facts, nullptr),
                  STORMCELLAR_OK);
        return facts;
    }
    stormcellar_code read(const std::string& path) {
        stormcellar_grid* made = nullptr;
        const auto code = stormcellar_grid_read(path.c_str(), &made, &error_);
        grid_.reset(made);
        return code;
    }
    TemporaryDirectory directory_;
    OwnedCache cache_;
    OwnedGrids list_;
    OwnedGrid grid_;
    stormcellar_query query_{};
    stormcellar_error error_{};
};

TEST_F(CCache, DomainMomentAndTimesSelectGrids) {
    using Lines = std::vector<std::string>;
    EXPECT_EQ(listed(), (Lines{"KTLX VELD 0", "north REF 0", "north REF 5", "north REF 10"}));
    query_.name = "north";
    query_.moment = "VEL REF";
    query_.from_ms = in_ms(noon) + 1;
    EXPECT_EQ(listed(), (Lines{"north REF 5", "north REF 10"}));
    query_.to_ms = in_ms(noon) + 300'000;
    EXPECT_EQ(listed(), Lines{"north REF 5"});
    EXPECT_GT(facts_at(0).bytes, 0U);
    query_.name = "south";
    EXPECT_EQ(listed(), Lines{});
    query_.name = "north";
    for (const std::int64_t extreme : {INT64_MIN, INT64_MAX}) {
        query_.from_ms = query_.to_ms = extreme;
        EXPECT_EQ(listed(), Lines{});
    }
}

TEST_F(CCache, CellsAreThoseOfTheFile) {
    query_.name = "KTLX";
    ASSERT_EQ(listed().size(), 1U);
    ASSERT_EQ(read(facts_at(0).path), STORMCELLAR_OK) << error_.message;
    const auto file = cache::GridFile::open(facts_at(0).path);
    ASSERT_TRUE(file);
    const grid::Grid expected = grid::to_dense(file->view());
    auto facts = empty_facts<stormcellar_grid_facts>();
    ASSERT_EQ(stormcellar_grid_describe(grid_.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_STREQ(facts.moment, "VELD");
    EXPECT_EQ(facts.columns, expected.spec.nx);
    EXPECT_EQ(facts.time_ms, in_ms(noon));
    EXPECT_STREQ(facts.projection, "azimuthal_equidistant");
    EXPECT_EQ(facts.offset_x_cells, expected.spec.offset_x_cells);
    const float* values = nullptr;
    const std::uint8_t* states = nullptr;
    ASSERT_EQ(stormcellar_grid_values(grid_.get(), &values, nullptr), STORMCELLAR_OK);
    ASSERT_EQ(stormcellar_grid_states(grid_.get(), &states, nullptr), STORMCELLAR_OK);
    const std::size_t count = expected.spec.cell_count();
    EXPECT_EQ(std::memcmp(values, expected.values.data(), count * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(states, expected.status.data(), count), 0);
    EXPECT_NE(std::memchr(states, STORMCELLAR_CELL_AMBIGUOUS, count), nullptr);
}

TEST_F(CCache, AGridOfADomainIsDrawnAsFrameDrawsIt) {
    query_.name = "north";
    query_.to_ms = in_ms(noon);
    ASSERT_EQ(listed().size(), 1U);
    ASSERT_EQ(read(facts_at(0).path), STORMCELLAR_OK) << error_.message;
    stormcellar_draw_options options{};
    options.size = sizeof options;
    options.product = "composite";
    options.format = STORMCELLAR_PNG;
    stormcellar_picture* made = nullptr;
    ASSERT_EQ(stormcellar_grid_draw(grid_.get(), &options, &made, &error_), STORMCELLAR_OK)
        << error_.message;
    const Owned<stormcellar_picture, stormcellar_picture_free> picture(made);
    const std::string file = directory_ / "frame.png";
    const ProgramResult drawn = run_program(
        STORMCELLAR_PROGRAM, {"frame", "north", "--cache", directory_ / "cache", "--time",
                              "2024-11-22T12:00Z", "--product", "composite", "-o", file});
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    std::ifstream stream(file, std::ios::binary);
    const std::string expected{std::istreambuf_iterator<char>(stream), {}};
    const std::uint8_t* bytes = nullptr;
    auto facts = empty_facts<stormcellar_picture_facts>();
    ASSERT_EQ(stormcellar_picture_bytes(made, &bytes, nullptr), STORMCELLAR_OK);
    ASSERT_EQ(stormcellar_picture_describe(made, &facts, nullptr), STORMCELLAR_OK);
    EXPECT_TRUE(std::string(bytes, bytes + facts.bytes) == expected);
}

TEST_F(CCache, DamageIsAnError) {
    const auto grids = listed();
    ASSERT_FALSE(grids.empty());
    const std::string path = facts_at(1).path;
    {
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(-2000, std::ios::end);
        file.write("damage", 6);
    }
    EXPECT_EQ(read(path), STORMCELLAR_CORRUPT);
    EXPECT_NE(std::string(error_.message).find(path), std::string::npos) << error_.message;
    EXPECT_EQ(read(directory_ / "nothing"), STORMCELLAR_NOT_FOUND);
    EXPECT_EQ(grid_, nullptr);
    stormcellar_cache* cache = nullptr;
    EXPECT_EQ(stormcellar_cache_open((directory_ / "nothing").c_str(), &cache, nullptr),
              STORMCELLAR_NOT_FOUND);
    query_.moment = "DBZ";
    stormcellar_grid_list* list = nullptr;
    std::size_t count = 0;
    EXPECT_EQ(stormcellar_cache_list(cache_.get(), &query_, &list, &count, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_cache_list(nullptr, nullptr, nullptr, nullptr, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_grid_list_describe(list_.get(), grids.size(), nullptr, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_grid_read(nullptr, nullptr, nullptr), STORMCELLAR_BAD_ARGUMENT);
}

}  // namespace
}  // namespace stormcellar::testing
