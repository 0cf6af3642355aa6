// Tests that the parts of the data server share one reader of the catalog.
#include "web/service/sources.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "tests/web/setup_below.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;

// Makes a catalog with one volume of each of `stations` stations.
void make_catalog(const fs::path& directory, std::size_t stations) {
    auto writer = catalog::CatalogWriter::open(directory);
    ASSERT_TRUE(writer);
    for (const Station& station : all_stations().first(stations)) {
        catalog::FileFacts facts;
        facts.station = station.icao;
        facts.path = "/drop/" + facts.station + "20240601_000000_V06";
        facts.state = catalog::FileState::complete;
        facts.content_hash = 1;
        catalog::VolumeFacts volume;
        volume.start_time = *parse_utc("2024-06-01T00:00:00Z", UtcTime{});
        facts.volumes = {volume};
        ASSERT_TRUE(writer->register_file(facts));
    }
}

std::size_t count_open_databases(const fs::path& catalog) {
    std::size_t count = 0;
    for (const auto& descriptor : fs::directory_iterator("/proc/self/fd")) {
        std::error_code closed;
        const fs::path file = fs::read_symlink(descriptor.path(), closed);
        if (!closed && file.parent_path() == catalog && file.extension() == ".sqlite") ++count;
    }
    return count;
}

// 2026-11-27: each part had its own reader. The API's reader kept fewer databases open than there
// are radars, so it closed and opened all databases for each list of stations.
TEST(WebSources, AllPartsShareOneReaderWithEveryStationsDatabase) {
    constexpr std::size_t stations = 40;
    const testing::TemporaryDirectory directory;
    make_catalog(directory / "catalog", stations);
    fs::create_directories(directory / "cache");
    const auto sources = open_sources(setup_below(directory.path()));
    ASSERT_TRUE(sources);
    Measures measures;
    const auto doors = doors_to(*sources, measures);
    for (const char* path :
         {"/api/v1/stations", "/s3/unidata-nexrad-level2?list-type=2&prefix=2024/06/01/",
          "/thredds/radarServer/nexrad/level2/IDD/dataset.xml"}) {
        const auto answer = asked(*doors->find(request_for(path).path), path);
        EXPECT_EQ(answer.status, 200U) << path;
        EXPECT_EQ(sources->catalog->open_databases(), stations) << path;
        EXPECT_EQ(count_open_databases(fs::canonical(directory / "catalog")), stations) << path;
    }
}

}  // namespace
}  // namespace stormcellar::web
