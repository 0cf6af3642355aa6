// tests/pipeline/small_house.h -- a catalog, a cache and an Ingestor of small grids, and a catalog
// of real volumes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/care/rebuild_catalog.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {

// Returns options for grids of 115 x 115 columns, 4 km apart.
inline IngestOptions small_grid() {
    IngestOptions options;
    options.spacing_m = 4000;
    options.nx = options.ny = 115;
    return options;
}

class SmallHouse : public ::testing::Test {
  protected:
    explicit SmallHouse(const IngestOptions& options = small_grid())
        : ingestor_(catalog_, store_, options) {}
    std::vector<cache::StoreEntry> grids(const std::string& domain) {
        return *store_.list(domain, level2::Moment::ref, std::nullopt, std::nullopt);
    }
    testing::TemporaryDirectory directory_;
    catalog::CatalogWriter catalog_ = *catalog::CatalogWriter::open(directory_ / "catalog");
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    Ingestor ingestor_;
};

inline const std::vector<std::string> five_volumes = {
    "KBGM20050822_024414.gz", "KBGM20050822_025001.gz", "KBGM20050822_025549.gz",
    "KBGM20050822_030243.gz", "KBGM20050822_030830.gz"};

// Copies these volumes of KBGM to `root`/drop and catalogs them in `root`/catalog.
inline void catalog_real_volumes(const fs::path& root, const std::vector<std::string>& names) {
    fs::create_directory(root / "drop");
    for (const std::string& name : names) {
        fs::copy_file(testing::real_file("sequence-kbgm") / name, root / "drop" / name);
        fs::permissions(root / "drop" / name, fs::perms::owner_write, fs::perm_options::add);
    }
    RebuildOptions rebuild;
    rebuild.catalog = root / "catalog";
    rebuild.drop = root / "drop";
    ASSERT_TRUE(rebuild_catalog(rebuild));
}

}  // namespace stormcellar::pipeline
