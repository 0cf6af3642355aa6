// Volumes of one file a chunk where nothing is followed: no living grids, no cache at all.
#include <fstream>

#include <gtest/gtest.h>

#include "cache/store.h"
#include "catalog/catalog.h"
#include "level2/chunk_directory.h"
#include "pipeline/chunk_path.h"
#include "pipeline/ingest.h"
#include "pipeline/rebuild_catalog.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::Catalog;
using catalog::FileState;

class ChunkFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        fs::create_directories(drop_.parent_path());
        fs::copy(*testing::data_directory() / "chunks/OPENRADAR_KLOT", drop_);
        for (const auto& entry : fs::directory_iterator(drop_))
            paths_.push_back(entry.path());
        std::sort(paths_.begin(), paths_.end());
        ASSERT_EQ(paths_.size(), 55U);
    }
    // One volume, whole, in the first chunk's row, and every other chunk settled beside it.
    void expect_one_volume(Catalog& catalog) {
        const auto volumes = catalog.list("KLOT", {});
        ASSERT_TRUE(volumes);
        ASSERT_EQ(volumes->size(), 1U);
        const auto whole = level2::decode_chunk_directory(drop_).value().volume;
        EXPECT_EQ(volumes->at(0).path, paths_[0]);
        EXPECT_EQ(volumes->at(0).state, FileState::complete);
        EXPECT_EQ(volumes->at(0).volume.sweep_count, static_cast<int>(whole.sweeps.size()));
        EXPECT_EQ(volumes->at(0).volume.start_time, whole.start_time());
        const auto rows = catalog.list("KLOT", {std::nullopt, std::nullopt, true});
        ASSERT_EQ(rows->size(), paths_.size());
        for (const catalog::CatalogEntry& row : *rows)
            EXPECT_EQ(row.state, FileState::complete) << row.path;
    }
    testing::TemporaryDirectory directory_;
    fs::path drop_ = directory_ / "drop/KLOT";
    std::vector<fs::path> paths_;
};

TEST_F(ChunkFiles, WithoutLivingGridsTheyArePutTogetherAllTheSame) {
    Catalog catalog = *Catalog::open_for_writing(directory_ / "catalog");
    const auto store =
        *cache::Store::open_for_writing(real_file_system(), directory_ / "cache", true);
    IngestOptions options;
    options.spacing_m = 4000;
    options.nx = options.ny = 115;
    options.living.scratch = directory_.path();
    options.living.make = false;
    Ingestor ingestor(catalog, store, options);
    int gridded = 0;
    fs::remove_all(drop_);
    fs::create_directories(drop_);
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        const fs::path& path = paths_[i];
        fs::copy_file(*testing::data_directory() / "chunks/OPENRADAR_KLOT" / path.filename(), path);
        const auto outcome = ingestor.ingest(path, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        if (outcome->result == IngestResult::incomplete) {
            EXPECT_EQ(outcome->instead_of, i == 0 ? fs::path{} : paths_[i - 1]);
        }
        EXPECT_TRUE(outcome->living.empty());
        gridded += outcome->result == IngestResult::gridded ? 1 : 0;
    }
    EXPECT_EQ(gridded, 1);
    EXPECT_EQ(store.list("KLOT", level2::Moment::ref, std::nullopt, std::nullopt)->size(), 1U);
    expect_one_volume(catalog);
}

TEST_F(ChunkFiles, ARebuiltCatalogHasTheVolumeAndNotItsParts) {
    RebuildOptions options;
    options.catalog = directory_ / "catalog";
    options.drop = directory_ / "drop";
    const auto report = rebuild_catalog(options);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->files, paths_.size());
    EXPECT_TRUE(report->problems.empty());
    Catalog catalog = *Catalog::open_for_writing(options.catalog);
    expect_one_volume(catalog);
    const auto again = rebuild_catalog(options);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->unchanged, paths_.size());
}

TEST_F(ChunkFiles, AVolumeWithoutItsEndIsRebuiltAsPartial) {
    for (std::size_t i = 20; i < paths_.size(); ++i)
        fs::remove(paths_[i]);
    RebuildOptions options;
    options.catalog = directory_ / "catalog";
    options.drop = directory_ / "drop";
    ASSERT_TRUE(rebuild_catalog(options));
    Catalog catalog = *Catalog::open_for_reading(options.catalog);
    const auto volumes = catalog.list("KLOT", {});
    ASSERT_EQ(volumes->size(), 1U);
    EXPECT_EQ(volumes->at(0).state, FileState::partial);
    EXPECT_EQ(catalog.list("KLOT", {std::nullopt, std::nullopt, true})->size(), 20U);
}

TEST_F(ChunkFiles, OthersBesideAreThoseOfTheSameVolumeInTheirOrder) {
    std::ofstream(drop_ / "20260328-201457-007-I.tmp") << "not done";
    std::ofstream(drop_ / "20260328-201957-002-I") << "another volume";
    std::ofstream(drop_ / "notes") << "no chunk";
    const auto others = chunks_beside(*ChunkPath::of(paths_[3]));
    ASSERT_TRUE(others);
    ASSERT_EQ(others->size(), paths_.size() - 1);
    for (std::size_t i = 0; i < others->size(); ++i)
        EXPECT_EQ(others->at(i).path, paths_[i < 3 ? i : i + 1]);
    EXPECT_FALSE(chunks_beside(*ChunkPath::of("/nowhere/20260328-201957-002-I")));
}

}  // namespace
}  // namespace stormcellar::pipeline
