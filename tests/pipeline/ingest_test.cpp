// Real files through the whole pipeline: what the catalog says, what stands in the cache.
#include "pipeline/ingest.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileState;

class IngestTest : public ::testing::Test {
  protected:
    fs::path real(const std::string& name) { return *testing::data_directory() / name; }
    fs::path write(const std::string& name, const std::string& text) {
        std::ofstream(directory_ / name, std::ios::binary) << text;
        return directory_ / name;
    }
    std::vector<cache::StoreEntry> grids(const std::string& domain) {
        return *store_.list(domain, level2::Moment::ref, std::nullopt, std::nullopt);
    }
    catalog::CatalogEntry only_entry(const std::string& station) {
        const auto entries = catalog_.list(station, {std::nullopt, std::nullopt, true});
        EXPECT_TRUE(entries);
        EXPECT_EQ(entries->size(), 1U);
        return entries->at(0);
    }
    IngestOptions small_grid() {
        IngestOptions options;
        options.spacing_m = 4000;
        options.nx = options.ny = 115;
        return options;
    }
    testing::TemporaryDirectory directory_;
    catalog::Catalog catalog_ = *catalog::Catalog::open_for_writing(directory_ / "catalog");
    cache::Store store_ =
        *cache::Store::open_for_writing(real_file_system(), directory_ / "cache", true);
    Ingestor ingestor_{catalog_, store_, small_grid()};
};

TEST_F(IngestTest, WholeVolumeIsGriddedOnceAndThenUnchanged) {
    STORMCELLAR_NEED_DATA();
    const fs::path path = real("sequence-kbgm/KBGM20050822_024414.gz");
    const auto outcome = ingestor_.ingest(path, false);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result, IngestResult::gridded);
    EXPECT_EQ(outcome->station, "KBGM");
    EXPECT_EQ(only_entry("KBGM").state, FileState::complete);
    ASSERT_EQ(grids("KBGM").size(), 1U);
    const auto file = cache::GridFile::open(grids("KBGM")[0].path);
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->verify());
    EXPECT_EQ(file->description().provenance.source_files,
              std::vector<std::string>{"KBGM20050822_024414.gz"});
    EXPECT_FALSE(file->description().provenance.partial);
    EXPECT_EQ(ingestor_.ingest(path, false)->result, IngestResult::unchanged);
}

// golden: 4 volumes in one file
TEST_F(IngestTest, FileOfSeveralVolumesGivesAGridForEach) {
    STORMCELLAR_NEED_DATA();
    const auto outcome = ingestor_.ingest(real("volumes/KBBX20060113_170337.gz"), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->grids.size(), 4U);
    EXPECT_EQ(grids("KBBX").size(), 4U);
    EXPECT_EQ(catalog_.stations()->at(0).volume_count, 4);
}

TEST_F(IngestTest, VolumeThatHasNotEndedWaitsUntilItIsFinished) {
    STORMCELLAR_NEED_DATA();
    std::string bytes;
    for (const char* chunk : {"001-S", "002-I", "003-I"}) {
        std::ifstream file(real("chunks/KLOT_34/20201019-054806-") += chunk, std::ios::binary);
        bytes.append(std::istreambuf_iterator<char>(file), {});
    }
    const fs::path path = write("KLOT20201019_054806_V06", bytes);
    EXPECT_EQ(ingestor_.ingest(path, false)->result, IngestResult::incomplete);
    EXPECT_EQ(only_entry("KLOT").state, FileState::seen);
    EXPECT_TRUE(grids("KLOT").empty());
    const auto outcome = ingestor_.ingest(path, true);
    EXPECT_EQ(outcome->result, IngestResult::gridded);
    EXPECT_EQ(only_entry("KLOT").state, FileState::partial);
    EXPECT_NE(only_entry("KLOT").reason, "");
    EXPECT_TRUE(cache::GridFile::open(grids("KLOT").at(0).path)->description().provenance.partial);
}

TEST_F(IngestTest, VolumeWithoutRadialsIsPartialAndHasNoGrid) {
    STORMCELLAR_NEED_DATA();
    const auto outcome = ingestor_.ingest(real("volumes/KFDR20160420_214957_V06.gz"), true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result, IngestResult::no_moment);
    EXPECT_EQ(only_entry("KFDR").state, FileState::partial);
    EXPECT_TRUE(grids("KFDR").empty());
}

TEST_F(IngestTest, GarbageIsRejectedWithAReasonAndIsNotTriedAgain) {
    const fs::path path = write("KTLX_nonsense", std::string(5000, 'x'));
    const auto outcome = ingestor_.ingest(path, false);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result, IngestResult::rejected);
    EXPECT_EQ(only_entry("KTLX").state, FileState::rejected);
    EXPECT_NE(only_entry("KTLX").reason, "");
    EXPECT_EQ(ingestor_.ingest(path, true)->result, IngestResult::unchanged);
}

TEST_F(IngestTest, EmptyFileWaitsAndIsRejectedWhenItStaysEmpty) {
    const fs::path path = write("empty", "");
    EXPECT_EQ(ingestor_.ingest(path, false)->result, IngestResult::incomplete);
    EXPECT_EQ(ingestor_.ingest(path, true)->result, IngestResult::rejected);
    EXPECT_EQ(only_entry("").state, FileState::rejected);
}

TEST_F(IngestTest, OddThingsAreRejectedAndNeverFollowed) {
    ASSERT_EQ(::mkfifo((directory_ / "fifo").c_str(), 0600), 0);
    EXPECT_EQ(ingestor_.ingest(directory_ / "fifo", true)->result, IngestResult::rejected);
    fs::create_symlink("/etc/passwd", directory_ / "link");
    const auto outcome = ingestor_.ingest(directory_ / "link", true);
    EXPECT_EQ(outcome->result, IngestResult::rejected);
    EXPECT_EQ(outcome->reason, "is not a regular file");
}

TEST_F(IngestTest, FileThatIsGoneIsMarkedSo) {
    const fs::path path = write("KTLX_nonsense", std::string(5000, 'x'));
    ASSERT_TRUE(ingestor_.ingest(path, false));
    fs::remove(path);
    EXPECT_EQ(ingestor_.ingest(path, false)->result, IngestResult::vanished);
    EXPECT_EQ(only_entry("KTLX").state, FileState::gone);
}

}  // namespace
}  // namespace stormcellar::pipeline
