// Tests volumes of chunks where there are no living grids, or no cache.
#include <atomic>
#include <fstream>

#include <gtest/gtest.h>

#include "pipeline/care/archive_fill.h"
#include "pipeline/care/rebuild_catalog.h"
#include "pipeline/drop/archive_volumes.h"
#include "pipeline/drop/cataloged_volume.h"
#include "pipeline/drop/chunk_path.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/chunk_directory.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::pipeline {
namespace {

using catalog::CatalogReader;
using catalog::CatalogWriter;
using catalog::FileState;

class ChunkFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        rebuild_.catalog = directory_ / "catalog";
        rebuild_.drop = directory_ / "drop";
        fs::create_directories(drop_.parent_path());
        fs::copy(testing::real_file("chunks/OPENRADAR_KLOT"), drop_);
        for (const auto& entry : fs::directory_iterator(drop_))
            paths_.push_back(entry.path());
        std::sort(paths_.begin(), paths_.end());
        ASSERT_EQ(paths_.size(), 55U);
    }
    // Expects that the first chunk's row describes one complete volume, and that the rows of all
    // other chunks are settled.
    void expect_one_volume(const CatalogReader& catalog) {
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
    [[nodiscard]] CatalogReader rebuilt() const {
        EXPECT_TRUE(rebuild_catalog(rebuild_));
        return *CatalogReader::open(rebuild_.catalog);
    }
    testing::TemporaryDirectory directory_;
    RebuildOptions rebuild_;
    fs::path drop_ = directory_ / "drop/KLOT";
    std::vector<fs::path> paths_;
};

TEST_F(ChunkFiles, WithoutLivingGridsTheyArePutTogetherAllTheSame) {
    CatalogWriter catalog = *CatalogWriter::open(directory_ / "catalog");
    auto store = *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    IngestOptions options = small_grid();
    options.living.scratch = directory_.path();
    options.living.make = false;
    Ingestor ingestor(catalog, store, options);
    int gridded = 0;
    fs::remove_all(drop_);
    fs::create_directories(drop_);
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        const fs::path& path = paths_[i];
        fs::copy_file(testing::real_file("chunks/OPENRADAR_KLOT") / path.filename(), path);
        const auto outcome = ingestor.ingest(path, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        if (outcome->result() == IngestResult::incomplete) {
            EXPECT_EQ(outcome->former_representative, i == 0 ? fs::path{} : paths_[i - 1]);
        }
        EXPECT_TRUE(outcome->living.empty());
        gridded += outcome->result() == IngestResult::gridded ? 1 : 0;
    }
    EXPECT_EQ(gridded, 1);
    EXPECT_EQ(store.list("KLOT", level2::Moment::ref, std::nullopt, std::nullopt)->size(), 1U);
    expect_one_volume(catalog);
}

TEST_F(ChunkFiles, ARebuiltCatalogHasTheVolumeAndNotItsParts) {
    const auto report = rebuild_catalog(rebuild_);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->files, paths_.size());
    EXPECT_TRUE(report->problems.empty());
    CatalogWriter catalog = *CatalogWriter::open(rebuild_.catalog);
    expect_one_volume(catalog);
    const auto again = rebuild_catalog(rebuild_);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->unchanged, paths_.size());
}

// 2026-11-24: chunks were joined even if other files had replaced them.
TEST_F(ChunkFiles, AVolumeIsReadAgainFromTheChunksThatWereCataloged) {
    const CatalogReader catalog = rebuilt();
    const auto entry = catalog.latest("KLOT")->value();
    const auto whole = read_cataloged_volume(catalog, entry);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_TRUE(whole->notes.empty());
    std::uintmax_t bytes = 0;
    for (const fs::path& path : paths_)
        bytes += fs::file_size(path);
    EXPECT_EQ(whole->bytes.size(), bytes);

    const fs::path further = drop_ / "20260328-201457-056-I";
    fs::copy_file(paths_[3], further);
    const auto without = read_cataloged_volume(catalog, entry);
    ASSERT_TRUE(without) << without.error().message;
    EXPECT_EQ(without->bytes, whole->bytes);
    ASSERT_EQ(without->notes.size(), 1U);
    EXPECT_EQ(without->notes[0],
              further.native() + ": is left out because it is not in the catalog");
    fs::remove(further);

    fs::rename(paths_[5], directory_ / "elsewhere");
    fs::create_symlink(directory_ / "elsewhere", paths_[5]);
    EXPECT_EQ(read_cataloged_volume(catalog, entry).error().code, ErrorCode::not_a_file);
    fs::remove(paths_[5]);
    std::ofstream(paths_[5]) << std::string(fs::file_size(directory_ / "elsewhere"), 'x');
    const auto changed = read_cataloged_volume(catalog, entry);
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().code, ErrorCode::corrupt);
    EXPECT_EQ(changed.error().message.find(paths_[5].native() + ": is not the file"), 0U);
}

// 2026-11-28: after a crash, pqact appended every chunk to its file again. The volume then had one
// row with one sweep and another with 31, and its joined file had twice the size.
TEST_F(ChunkFiles, AChunkThatItsFileHoldsTwiceIsReadOnce) {
    CatalogWriter catalog = *CatalogWriter::open(directory_ / "catalog");
    auto store = *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    IngestOptions options = small_grid();
    options.living.scratch = directory_.path();
    Ingestor ingestor(catalog, store, options);
    const auto take_all = [&] {
        for (const fs::path& path : paths_)
            ASSERT_TRUE(ingestor.ingest(path, false));
    };
    take_all();
    const auto whole = read_cataloged_volume(catalog, catalog.latest("KLOT")->value());
    ASSERT_TRUE(whole) << whole.error().message;
    for (const fs::path& path : paths_) {
        const auto bytes = read_file(path).value();
        testing::append_to(path, bytes);
    }
    take_all();
    take_all();
    expect_one_volume(catalog);
    EXPECT_EQ(store.list("KLOT", level2::Moment::ref, std::nullopt, std::nullopt)->size(), 1U);
    const auto again = read_cataloged_volume(catalog, catalog.latest("KLOT")->value());
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_TRUE(again->bytes == whole->bytes);
}

// Grids of an archive are made only from cataloged files, also if these are chunks.
TEST_F(ChunkFiles, AnArchiveDoesNotGridChunksThatAreOthers) {
    const CatalogReader catalog = rebuilt();
    const auto start = *catalog.latest("KLOT")->value().volume.start_time;
    const auto volumes = archive_volumes(catalog, {"KLOT"}, {start, start, false});
    ArchiveOptions coarse;
    coarse.spacing_m = 4000;
    coarse.nx = coarse.ny = 115;
    const std::atomic<bool> stop = false;
    const auto fill = [&](const std::string& name) {
        auto store = *cache::StoreWriter::open(real_file_system(), directory_ / name, true);
        FillReport report;
        ArchiveFill filling(catalog, store, directory_ / (name + "-scratch"), coarse);
        EXPECT_TRUE(filling.fill(*volumes, {}, stop, report));
        return report;
    };
    EXPECT_EQ(fill("good").grids_made, 1U);
    fs::copy_file(paths_[6], paths_[5], fs::copy_options::overwrite_existing);
    const FillReport report = fill("bad");
    EXPECT_EQ(report.grids_made, 0U);
    ASSERT_EQ(report.left_out.size(), 1U);
    EXPECT_NE(report.left_out[0].reason.find("is not the file that was cataloged"),
              std::string::npos)
        << report.left_out[0].reason;
}

TEST_F(ChunkFiles, AVolumeWithoutItsEndIsRebuiltAsPartial) {
    for (std::size_t i = 20; i < paths_.size(); ++i)
        fs::remove(paths_[i]);
    const CatalogReader catalog = rebuilt();
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
