// Tests that a database that cannot be opened affects only its own station.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

class Neighbors : public ::testing::Test {
  protected:
    void SetUp() override {
        auto catalog = *CatalogWriter::open(catalog_);
        ASSERT_TRUE(catalog.register_file(file("/d/KTLX_a", {volume("2022-03-17T00:00")})));
        ASSERT_TRUE(catalog.register_file(file("/d/KFWS_a", {volume("2022-03-17T00:00")}, "KFWS")));
    }
    // Expects all requests for files of KFWS, and for files without a station, to succeed while the
    // database of KTLX cannot be used.
    void expect_that_others_go_on(CatalogWriter& catalog, ErrorCode code) {
        EXPECT_FALSE(*catalog.is_known("/d/KFWS_b"));
        ASSERT_TRUE(catalog.note_file(file("/d/KFWS_b", {}, "KFWS")));
        EXPECT_TRUE(catalog.register_file(file("/d/KFWS_b", {}, "KFWS")));
        EXPECT_FALSE(*catalog.is_known("/d/odd"));
        EXPECT_TRUE(catalog.register_file(file("/d/odd", {}, "KINX")));
        EXPECT_TRUE(catalog.register_files("KINX", {file("/d/odd2", {}, "KINX")}));
        EXPECT_TRUE(*catalog.is_settled("/d/odd", 1000, 42));
        EXPECT_EQ(*catalog.mark_gone("/d/odd"), 1);
        EXPECT_EQ(*catalog.mark_gone("/d/never"), 0);
        EXPECT_EQ(*catalog.mark_missing("/d"), 3);
        EXPECT_EQ(*catalog.forget_gone(now_utc() + std::chrono::hours{1}), 4);
        EXPECT_TRUE(catalog.roll());
        EXPECT_EQ(catalog.stations()->size(), 2U);
        const auto own = catalog.register_file(file("/d/KTLX_b", {}));
        ASSERT_FALSE(own);
        EXPECT_EQ(own.error().code, code) << own.error().message;
        EXPECT_FALSE(catalog.is_settled("/d/KTLX_b", 1, 1));
        EXPECT_FALSE(catalog.examine("KTLX"));
        const auto troubles = catalog.troubles();
        ASSERT_EQ(troubles.size(), 1U) << "the trouble is listed once";
        EXPECT_EQ(troubles[0].station, "KTLX");
        EXPECT_EQ(troubles[0].error.code, code);
        EXPECT_NE(troubles[0].error.message.find("KTLX.sqlite"), std::string::npos);
    }
    void expect_that_it_is_over(CatalogWriter& catalog) {
        EXPECT_TRUE(catalog.register_file(file("/d/KTLX_b", {})));
        EXPECT_TRUE(catalog.troubles().empty());
        EXPECT_EQ(catalog.list("KTLX", {{}, {}, true})->size(), 2U);
    }
    // Puts the database back in its place, and expects requests for its station to succeed.
    void expect_that_it_is_over_with_its_own(CatalogWriter& catalog) {
        fs::remove(database_);
        fs::rename(directory_ / "aside", database_);
        expect_that_it_is_over(catalog);
    }
    testing::TemporaryDirectory directory_;
    fs::path catalog_ = directory_ / "catalog";
    fs::path database_ = catalog_ / "KTLX.sqlite";
};

// 2026-11-24: a reader waited forever at a FIFO in the place of a database.
TEST_F(Neighbors, AFifoInPlaceOfADatabaseHoldsNobodyUp) {
    fs::rename(database_, directory_ / "aside");
    ASSERT_EQ(::mkfifo(database_.c_str(), 0600), 0);
    auto catalog = *CatalogWriter::open(catalog_);
    expect_that_others_go_on(catalog, ErrorCode::not_a_file);
    auto reader = *CatalogReader::open(catalog_);
    EXPECT_EQ(reader.list("KTLX", {}).error().code, ErrorCode::not_a_file);
    EXPECT_EQ(reader.stations()->size(), 2U);
    EXPECT_EQ(reader.troubles().size(), 1U);
    EXPECT_EQ(examine_database(database_).error().code, ErrorCode::not_a_file);
    expect_that_it_is_over_with_its_own(catalog);
}

TEST_F(Neighbors, FifosBesideADatabaseHoldNobodyUp) {
    for (const char* ending : {"-wal", "-shm", "-journal"}) {
        const fs::path fifo = database_.native() + ending;
        ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
        auto reader = *CatalogReader::open(catalog_);
        EXPECT_EQ(reader.list("KTLX", {}).error().code, ErrorCode::not_a_file) << ending;
        auto catalog = *CatalogWriter::open(catalog_);
        EXPECT_EQ(catalog.list("KTLX", {}).error().code, ErrorCode::not_a_file) << ending;
        fs::remove(fifo);
    }
}

TEST_F(Neighbors, ADirectoryInPlaceOfADatabaseHoldsNobodyUp) {
    fs::rename(database_, directory_ / "aside");
    fs::create_directory(database_);
    auto catalog = *CatalogWriter::open(catalog_);
    expect_that_others_go_on(catalog, ErrorCode::not_a_file);
    expect_that_it_is_over_with_its_own(catalog);
}

// 2026-11-24: `sudo stormcellar catalog rebuild` left a database that belonged to root. This
// database stopped new files of all other stations. The test needs a process of a user who may not
// read the database.
TEST_F(Neighbors, ADatabaseWithoutPermissionHoldsNobodyUp) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can become a user without rights";
    fs::permissions(directory_.path(), fs::perms::all);
    fs::permissions(catalog_, fs::perms::all);
    for (const auto& entry : fs::directory_iterator(catalog_))
        fs::permissions(entry.path(), fs::perms{0666});
    fs::permissions(database_, fs::perms{0600});
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(2);
        auto catalog = *CatalogWriter::open(catalog_);
        expect_that_others_go_on(catalog, ErrorCode::permission);
        ::_exit(HasFailure() ? 1 : 0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << "an expectation failed in the child process";
}

// Another program's database cannot be repaired, either.
TEST_F(Neighbors, AnotherProgramsDatabaseHoldsNobodyUp) {
    fs::rename(database_, directory_ / "aside");
    {
        SQLite::Database foreign(database_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
        foreign.exec("CREATE TABLE other (x)");
    }
    auto catalog = *CatalogWriter::open(catalog_);
    expect_that_others_go_on(catalog, ErrorCode::unsupported);
    expect_that_it_is_over_with_its_own(catalog);
}

// While a worker waits for a lock, it serves no other station.
TEST_F(Neighbors, ADatabaseThatSomebodyHasLockedHoldsItsOwnStationUpAndOnlyNowAndThen) {
    auto catalog = *CatalogWriter::open(catalog_);
    const auto expect_that_nobody_waits = [&](const std::string& odd, const std::string& known) {
        EXPECT_FALSE(catalog.register_file(file("/d/KTLX_b", {})));
        EXPECT_FALSE(*catalog.is_known(odd));
        EXPECT_TRUE(catalog.register_file(file(odd, {}, "KFWS")));
        EXPECT_TRUE(catalog.register_file(file(known, {}, "KFWS")));
        EXPECT_EQ(*catalog.mark_gone(odd), 1);
        EXPECT_EQ(catalog.troubles().size(), 1U);
    };
    SQLite::Database other(database_, SQLite::OPEN_READWRITE);
    other.exec("BEGIN EXCLUSIVE");
    const auto refused = catalog.register_file(file("/d/KTLX_b", {}));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::busy);
    expect_that_nobody_waits("/d/odd", "/d/KFWS_b");
    // Opening the database would now succeed and end the trouble, but nothing tries to open it.
    other.exec("ROLLBACK");
    expect_that_nobody_waits("/d/odd2", "/d/KFWS_c");
}

// A file has one row. If its old row cannot be deleted, only this file waits.
TEST_F(Neighbors, AFileWhoseRowStandsInADatabaseThatCannotBeUsedWaits) {
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.register_file(file("/d/odd", {}, "KTLX")));
    fs::rename(database_, directory_ / "aside");
    fs::create_directory(database_);
    EXPECT_FALSE(catalog.register_file(file("/d/odd", {}, "KFWS")));
    EXPECT_TRUE(catalog.register_file(file("/d/odd2", {}, "KFWS")));
    fs::remove(database_);
    fs::rename(directory_ / "aside", database_);
    catalog = *CatalogWriter::open(catalog_);
    EXPECT_TRUE(catalog.register_file(file("/d/odd", {}, "KFWS")));
    EXPECT_EQ(catalog.list("KTLX", {{}, {}, true})->size(), 1U);
}

// A file without a station in its name is first searched among the files of unknown stations.
TEST_F(Neighbors, TheDatabaseOfUnknownFilesHoldsNobodyUp) {
    fs::create_directory(catalog_ / "_unknown.sqlite");
    auto catalog = *CatalogWriter::open(catalog_);
    EXPECT_FALSE(*catalog.is_known("/d/odd"));
    EXPECT_TRUE(catalog.note_file(file("/d/odd", {}, "")));
    EXPECT_TRUE(catalog.register_file(file("/d/odd", {}, "KFWS")));
    EXPECT_TRUE(*catalog.is_settled("/d/odd", 1000, 42));
    EXPECT_EQ(*catalog.mark_gone("/d/odd"), 1);
    EXPECT_EQ(*catalog.mark_gone("/d/odd2"), 0);
    EXPECT_FALSE(catalog.register_file(file("/d/odd3", {}, "")));
    const auto troubles = catalog.troubles();
    ASSERT_EQ(troubles.size(), 1U);
    EXPECT_EQ(troubles[0].station, "");
}

}  // namespace
}  // namespace stormcellar::catalog
