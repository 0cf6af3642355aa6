#include "catalog/check_catalog.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "stormcellar/catalog/catalog.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::catalog {
namespace {

class CheckCatalog : public ::testing::Test {
  protected:
    // Makes a file on disk and its row, as the daemon does.
    fs::path put(const std::string& name, const std::string& station = "KTLX") {
        fs::path path = directory_ / name;
        std::ofstream(path) << "contents";
        struct stat facts {};
        EXPECT_EQ(::stat(path.c_str(), &facts), 0);
        FileFacts file;
        file.path = path;
        file.station = station;
        file.size_bytes = static_cast<std::uint64_t>(facts.st_size);
        file.modified_ns =
            std::int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec;
        file.state = FileState::complete;
        auto catalog = *CatalogWriter::open(catalog_);
        EXPECT_TRUE(catalog.register_file(file));
        return path;
    }
    testing::TemporaryDirectory directory_;
    fs::path catalog_ = directory_ / "catalog";
};

TEST_F(CheckCatalog, ASoundCatalogThatAgreesWithTheFilesIsSound) {
    put("a");
    put("b", "");
    const auto check = check_catalog(catalog_, "");
    ASSERT_TRUE(check) << check.error().message;
    ASSERT_EQ(check->stations.size(), 2U);
    EXPECT_EQ(check->stations[0].station, "KTLX");
    EXPECT_EQ(check->stations[0].files, 1);
    EXPECT_TRUE(check->is_sound());
    EXPECT_EQ(check_catalog(catalog_, "KTLX")->stations.size(), 1U);
}

TEST_F(CheckCatalog, FilesThatWentOrChangedAreNamedAndGoneOnesAreNot) {
    const fs::path went = put("went"), changed = put("changed"), gone = put("gone");
    fs::remove(went);
    fs::remove(gone);
    std::ofstream(changed) << "other contents";
    {
        auto catalog = *CatalogWriter::open(catalog_);
        ASSERT_TRUE(catalog.mark_gone(gone));
    }
    const auto check = check_catalog(catalog_, "KTLX");
    ASSERT_TRUE(check);
    EXPECT_FALSE(check->is_sound());
    EXPECT_EQ(check->stations[0].missing, std::vector<fs::path>{went});
    EXPECT_EQ(check->stations[0].changed, std::vector<fs::path>{changed});
}

// 2026-11-29: files that could not be examined were ignored, and the catalog counted as sound.
TEST_F(CheckCatalog, FilesThatCannotBeLookedAtAreNamed) {
    fs::create_directory(directory_ / "drop");
    const fs::path unseen = put("drop/a");
    fs::remove_all(directory_ / "drop");
    fs::create_directory_symlink("drop", directory_ / "drop");
    const auto check = check_catalog(catalog_, "KTLX");
    ASSERT_TRUE(check);
    EXPECT_FALSE(check->is_sound());
    EXPECT_EQ(check->stations[0].unseen, std::vector<fs::path>{unseen});
    EXPECT_TRUE(check->stations[0].missing.empty());
}

TEST_F(CheckCatalog, DamageIsNamedAndNothingIsWritten) {
    put("a");
    fs::resize_file(catalog_ / "KTLX.sqlite", 6000);
    const auto check = check_catalog(catalog_, "");
    ASSERT_TRUE(check) << check.error().message;
    ASSERT_EQ(check->stations.size(), 1U);
    EXPECT_FALSE(check->stations[0].damage.empty());
    EXPECT_TRUE(check->set_aside.empty());
    EXPECT_EQ(fs::file_size(catalog_ / "KTLX.sqlite"), 6000U);

    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.examine_all());
    const auto mended = check_catalog(catalog_, "");
    ASSERT_TRUE(mended);
    EXPECT_TRUE(mended->stations[0].damage.empty());
    EXPECT_EQ(mended->set_aside.size(), 1U);
}

// 2026-11-24: the databases that an attack with invented names had left could only be removed by
// hand.
TEST_F(CheckCatalog, DatabasesOfUnknownStationsAreNamedAndCleared) {
    const fs::path real = put("real"), there = put("there", "XAAA"), went = put("went", "XBBB");
    put("nameless", "");
    {
        auto catalog = *CatalogWriter::open(catalog_);
        ASSERT_TRUE(catalog.mark_gone(went));
    }
    fs::remove(went);
    std::ofstream(catalog_ / "XCCC.sqlite") << std::string(5000, 'x');
    fs::create_directory(catalog_ / "XDDD.sqlite");
    std::ofstream(catalog_ / "XAAA.sqlite-wal");
    const StationRule known;
    const auto check = check_catalog(catalog_, "", &known);
    ASSERT_TRUE(check);
    ASSERT_EQ(check->stations.size(), 5U);
    for (const StationCheck& one : check->stations)
        EXPECT_EQ(one.is_known, !one.station.starts_with('X')) << one.station;
    ASSERT_EQ(check->troubles.size(), 1U)
        << "one bad database does not stop the check of other databases";
    EXPECT_EQ(check->troubles[0].station, "XDDD");
    EXPECT_FALSE(check->is_sound());
    EXPECT_TRUE(check_catalog(catalog_, "XAAA")->stations[0].is_known)
        << "without a rule, every station is known";

    const auto cleared = clear_unknown(catalog_, known);
    ASSERT_TRUE(cleared) << cleared.error().message;
    ASSERT_EQ(cleared->cleared.size(), 2U);
    EXPECT_EQ(cleared->cleared[0].station, "XAAA");
    EXPECT_EQ(cleared->cleared[0].files, 1);
    EXPECT_EQ(cleared->cleared[0].there, 1);
    EXPECT_EQ(cleared->cleared[1].station, "XBBB");
    EXPECT_EQ(cleared->cleared[1].there, 0);
    ASSERT_EQ(cleared->kept.size(), 2U);
    EXPECT_EQ(cleared->kept[0].station, "XCCC");
    EXPECT_EQ(cleared->kept[1].station, "XDDD");
    for (const char* name : {"XAAA.sqlite", "XAAA.sqlite-wal", "XBBB.sqlite", "XBBB.sqlite-shm"})
        EXPECT_FALSE(fs::exists(catalog_ / name)) << name;
    for (const char* name : {"KTLX.sqlite", "_unknown.sqlite", "XCCC.sqlite", "XDDD.sqlite"})
        EXPECT_TRUE(fs::exists(catalog_ / name)) << name;
    EXPECT_TRUE(fs::exists(there)) << "raw files must stay";
    EXPECT_TRUE(fs::exists(real));
    EXPECT_TRUE(clear_unknown(catalog_, known)->cleared.empty());
}

TEST_F(CheckCatalog, UnknownStationsAndDirectoriesAreNotFound) {
    put("a");
    EXPECT_EQ(check_catalog(catalog_, "KOKX").error().code, ErrorCode::not_found);
    EXPECT_EQ(check_catalog(directory_ / "none", "").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace stormcellar::catalog
