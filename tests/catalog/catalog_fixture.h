// tests/catalog/catalog_fixture.h -- an empty catalog, and facts of files to register.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/catalog/catalog.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::catalog {

inline UtcTime at(const char* text) {
    return *parse_utc(text, UtcTime{});
}

inline VolumeFacts volume(const char* start, std::optional<int> number = 7) {
    VolumeFacts facts;
    facts.start_time = at(start);
    facts.end_time = at(start) + std::chrono::minutes{5};
    facts.volume_number = number;
    facts.vcp = 212;
    facts.sweep_count = 14;
    facts.radial_count = 6480;
    facts.complete = true;
    return facts;
}

inline FileFacts file(const std::string& path, std::vector<VolumeFacts> volumes,
                      const std::string& station = "KTLX") {
    FileFacts facts;
    facts.path = path;
    facts.station = station;
    facts.size_bytes = 1000;
    facts.modified_ns = 42;
    facts.content_hash = 0xFEDC'BA98'7654'3210;  // uses the sign bit of SQLite's integers
    facts.state = FileState::complete;
    facts.volumes = std::move(volumes);
    return facts;
}

class CatalogTest : public ::testing::Test {
  protected:
    testing::TemporaryDirectory directory_;
    CatalogWriter catalog_ = *CatalogWriter::open(directory_ / "catalog");
};

}  // namespace stormcellar::catalog
