// Tests that the number of open databases is limited, and that no database is closed while it is in
// use.
#include "catalog/open_databases.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <mutex>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "stormcellar/base/descriptor.h"
#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

std::string station(int k) {
    return fmt::format("X{:03}", k);
}

class OpenDatabasesTest : public ::testing::Test {
  protected:
    CatalogWriter open(std::size_t most_open) {
        CatalogOptions options;
        options.most_open = most_open;
        return *CatalogWriter::open(catalog_, options);
    }
    static std::size_t descriptors() {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator{}));
    }
    testing::TemporaryDirectory directory_;
    fs::path catalog_ = directory_ / "catalog";
};

TEST_F(OpenDatabasesTest, OnlySoManyAreOpenAndEachIsFoundAgain) {
    const std::size_t before = descriptors();
    auto catalog = open(4);
    for (int k = 0; k < 30; ++k) {
        const std::string path = "/d/" + station(k) + "_a";
        ASSERT_TRUE(catalog.register_file(file(path, {}, station(k))));
        EXPECT_LE(catalog.open_databases(), 4U);
    }
    EXPECT_LE(descriptors() - before, 3U * 4U + 2U);
    for (int k = 0; k < 30; ++k)
        EXPECT_TRUE(*catalog.is_settled("/d/" + station(k) + "_a", 1000, 42)) << k;
    EXPECT_EQ(*catalog.mark_missing("/d"), 30);
    EXPECT_EQ(catalog.stations()->size(), 30U);
    EXPECT_TRUE(catalog.examine_all());
    EXPECT_LE(catalog.open_databases(), 4U);
    EXPECT_TRUE(catalog.take_repairs().empty());

    auto reader = *CatalogReader::open(catalog_);
    EXPECT_EQ(reader.stations()->size(), 30U);
    EXPECT_LE(reader.open_databases(), CatalogOptions::most_open_of_reader);
}

TEST_F(OpenDatabasesTest, TheLeastRecentlyUsedIsClosedFirst) {
    OpenDatabases all(2);
    const auto use = [&](const std::string& name) {
        const auto slot = all.lease(name);
        const std::scoped_lock lock(slot->mutex);
        const bool was_open = slot->database != nullptr;
        if (!was_open) {
            all.make_room(*slot);
            slot->database = std::move(*StationDatabase::open_for_writing(directory_ / name, name));
        }
        return was_open;
    };
    EXPECT_FALSE(use("KAAA"));
    EXPECT_FALSE(use("KBBB"));
    EXPECT_TRUE(use("KAAA"));
    EXPECT_FALSE(use("KCCC")) << "opening KCCC closes KBBB";
    EXPECT_TRUE(use("KAAA"));
    EXPECT_FALSE(use("KBBB"));
    EXPECT_EQ(all.open_count(), 2U);
    {
        const auto one = all.lease("KAAA");
        const auto other = all.lease("KBBB");
        EXPECT_FALSE(use("KCCC"));
        EXPECT_EQ(all.open_count(), 3U) << "leased databases stay open";
        EXPECT_TRUE(use("KAAA"));
    }
    EXPECT_EQ(all.close_idle(9), 3U);
    EXPECT_EQ(all.slot_count(), 0U) << "slots of closed databases without information are dropped";
}

TEST_F(OpenDatabasesTest, NamesThatAreAskedForLeaveNothingBehind) {
    OpenDatabases all(2);
    for (int k = 0; k < 1000; ++k)
        (void)all.lease(station(k));
    EXPECT_EQ(all.slot_count(), 0U);
}

TEST_F(OpenDatabasesTest, ManyThreadsUseMoreDatabasesThanMayBeOpen) {
    auto catalog = open(2);
    constexpr int files = 25;
    std::atomic<bool> is_done = false;
    std::atomic<int> failed = 0;
    const auto register_all = [&](int thread) {
        for (int k = 0; k < files; ++k) {
            const std::string path = fmt::format("/d/{}_{}_{}", station(k % 7), thread, k);
            if (!catalog.register_file(file(path, {}, station(k % 7)))) ++failed;
            if (!*catalog.is_settled(path, 1000, 42)) ++failed;
        }
    };
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 4; ++thread)
        threads.emplace_back(register_all, thread);
    std::thread looker([&] {
        while (!is_done) {
            const auto stations = catalog.stations();
            if (!stations || stations->size() > 7) ++failed;
        }
    });
    for (std::thread& thread : threads)
        thread.join();
    is_done = true;
    looker.join();
    EXPECT_EQ(failed, 0);
    EXPECT_TRUE(catalog.troubles().empty());
    std::size_t rows = 0;
    for (int k = 0; k < 7; ++k)
        rows += catalog.list(station(k), {{}, {}, true})->size();
    EXPECT_EQ(rows, 4U * files);
}

// 2026-11-24: when no descriptors were left, no station could register files any more.
TEST_F(OpenDatabasesTest, WhereDescriptorsRunOutDatabasesAreClosed) {
#if defined(STORMCELLAR_SANITIZED)
    GTEST_SKIP() << "the sanitizer needs descriptors to check memory";
#endif
    auto catalog = open(256);
    for (int k = 0; k < 10; ++k)
        ASSERT_TRUE(catalog.register_file(file("/d/" + station(k), {}, station(k))));
    EXPECT_EQ(catalog.open_databases(), 10U);
    rlimit usual{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &usual), 0);
    rlimit tight = usual;
    tight.rlim_cur = 300;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &tight), 0);
    std::vector<Descriptor> taken;
    for (int one = ::open("/dev/null", O_RDONLY); one >= 0; one = ::open("/dev/null", O_RDONLY))
        taken.emplace_back(one);
    for (int k = 10; k < 30; ++k) {
        const auto registered = catalog.register_file(file("/d/" + station(k), {}, station(k)));
        EXPECT_TRUE(registered) << registered.error().message;
    }
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &usual), 0);
    EXPECT_LT(catalog.open_databases(), 14U);
    EXPECT_TRUE(catalog.troubles().empty());
}

TEST_F(OpenDatabasesTest, ADatabaseThatIsDeletedWhileItIsClosedIsMadeAgainAndSaid) {
    auto catalog = open(1);
    ASSERT_TRUE(catalog.register_file(file("/d/KTLX_a", {}, "KTLX")));
    ASSERT_TRUE(catalog.register_file(file("/d/KOUN_a", {}, "KOUN")));
    fs::remove(catalog_ / "KTLX.sqlite");
    EXPECT_EQ(*catalog.register_file(file("/d/KTLX_b", {}, "KTLX")), Registered::added);
    EXPECT_EQ(catalog.take_repairs().size(), 1U)
        << "a repair must be reported, so that files are offered again";
    EXPECT_EQ(catalog.list("KTLX", {{}, {}, true})->size(), 1U);
}

// 2026-11-29, by ThreadSanitizer: a thread that gave its lease back read the slot's `file` while
// another thread with a lease wrote `file`.
TEST(OpenDatabases, GivingBackALeaseReadsNothingThatAnotherThreadWrites) {
    OpenDatabases databases(1);
    {
        const OpenDatabases::Lease place = databases.lease("KTLX");
        const std::scoped_lock lock(place->mutex);
        std::thread other([&] { (void)databases.lease("KTLX"); });
        place->file = {1, 1};
        other.join();
    }
    EXPECT_EQ(databases.slot_count(), 1U) << "the slot stays, because it has the file's identity";
}

}  // namespace
}  // namespace stormcellar::catalog
