// tests/web/served_volumes.h -- a drop directory with real volumes, and their catalog, as
// stormcellard would make it.
//
//   KTLX   2017-01-01 03:00:27, 488,081 bytes; 1991-07-20 16:05:18, compressed with gzip
//   KABR   2005-01-01 00:07:45, compressed with gzip
//   KLOT   2026-03-28 20:14:57, the first of 55 chunks; take_chunks() adds further chunks
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/door_test.h"
#include "web/data/raw/raw_files.h"

namespace stormcellar::web {

class ServedVolumes {
  public:
    // Ingestion decodes the files, which takes a tenth of a second for the three of them.
    explicit ServedVolumes(bool with_files = true) {
        namespace fs = std::filesystem;
        fs::create_directories(drop());
        catalog::CatalogOptions options;
        options.drop = fs::canonical(drop());
        catalog_.emplace(*catalog::CatalogWriter::open(directory_ / "catalog", options));
        pipeline::IngestOptions ingest;
        ingest.living.scratch = directory_.path();
        ingestor_ = std::make_unique<pipeline::Ingestor>(*catalog_, ingest);
        if (with_files) {
            for (const char* name :
                 {"KTLX20170101_030027_V06", "KTLX19910720_160529.gz", "KABR20050101_000745.gz"})
                take(*testing::data_directory() / "volumes" / name, name);
        }
        files_ = RawFiles::open_catalog({.catalog = directory_ / "catalog", .scratch = {}});
    }
    [[nodiscard]] std::filesystem::path drop() const { return directory_ / "drop"; }
    [[nodiscard]] std::filesystem::path state() const { return directory_.path(); }
    [[nodiscard]] const std::shared_ptr<RawFiles>& files() const { return files_; }
    [[nodiscard]] catalog::CatalogWriter& catalog() { return *catalog_; }
    // Copies a file into the drop directory, under this name, and ingests it.
    pipeline::IngestResult take(const std::filesystem::path& from, const std::string& name) {
        const std::filesystem::path path = std::filesystem::canonical(drop()) / name;
        std::filesystem::create_directories(path.parent_path());
        std::filesystem::copy_file(from, path, std::filesystem::copy_options::overwrite_existing);
        const auto outcome = ingestor_->ingest(path, false);
        EXPECT_TRUE(outcome) << outcome.error().message;
        return outcome ? outcome->result() : pipeline::IngestResult::rejected;
    }
    // Ingests the chunks of KLOT up to this number. Returns the bytes of all chunks so far.
    std::string take_chunks(std::size_t count) {
        if (chunks_.empty()) {
            for (const auto& entry : std::filesystem::directory_iterator(
                     *testing::data_directory() / "chunks/OPENRADAR_KLOT"))
                chunks_.push_back(entry.path());
            std::ranges::sort(chunks_);
        }
        for (; taken_ < std::min(count, chunks_.size()); ++taken_) {
            take(chunks_[taken_], "KLOT/" + chunks_[taken_].filename().string());
            const auto bytes = read_file(chunks_[taken_]);
            joined_.append(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        }
        return joined_;
    }

  private:
    testing::TemporaryDirectory directory_;
    std::optional<catalog::CatalogWriter> catalog_;
    std::unique_ptr<pipeline::Ingestor> ingestor_;
    std::shared_ptr<RawFiles> files_;
    std::vector<std::filesystem::path> chunks_;
    std::size_t taken_ = 0;
    std::string joined_;
};

// Returns volumes that all tests of a program share. No test may change them.
inline ServedVolumes& served_volumes() {
    static ServedVolumes served;
    return served;
}

// A test of a door (the handler of a path) that serves these shared volumes.
template <class AnyDoor>
class VolumesDoorTest : public DoorTest<AnyDoor> {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        this->door_ = std::make_unique<AnyDoor>(served_volumes().files());
    }
};

}  // namespace stormcellar::web
