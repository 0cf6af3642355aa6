// Tests the watch of the cache when its listener throws or a directory cannot be read.
#include "web/data/grids/cache_watch.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <new>
#include <vector>

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"
#include "web/data/grids/cache_tree.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
using testing::noon;

// 2026-11-28: the program ended when there was no memory for the name of a grid that had come.
TEST(CacheWatch, AChangeThatCouldNotBeToldIsALookAtEverything) {
    const testing::TemporaryDirectory directory;
    auto store = *cache::StoreWriter::open(real_file_system(), directory / "cache", false);
    std::atomic<bool> is_short = false;
    std::mutex mutex;
    std::vector<CacheEvent> told;
    const auto watch = CacheWatch::open(directory / "cache", [&](const CacheChange& change) {
        if (is_short.exchange(false)) throw std::bad_alloc();
        const std::scoped_lock lock(mutex);
        told.push_back(change.event);
    });
    ASSERT_TRUE(testing::commit_sized(store, "KBGM", noon - 5min));
    watch->catch_up();
    is_short = true;
    ASSERT_TRUE(testing::commit_sized(store, "KBGM", noon));
    const auto has_told = [&](CacheEvent event) {
        const std::scoped_lock lock(mutex);
        return std::ranges::count(told, event) > 0;
    };
    EXPECT_TRUE(testing::eventually([&] {
        try {
            watch->catch_up();
        } catch (const std::bad_alloc&) {
            // catch_up() called the listener, which threw.
        }
        return has_told(CacheEvent::everything);
    }));
    ASSERT_TRUE(store.remove(store.list("KBGM", level2::Moment::ref, noon, noon)->front()));
    watch->catch_up();
    EXPECT_TRUE(has_told(CacheEvent::went)) << "the watch goes on";
}

// 2026-11-29: a grid that was removed before the watch read its first event was never reported as
// gone. The test reads both events in one call, as a busy watch does.
TEST(CacheWatch, AGridThatCameAndWentUnreadIsToldAsGone) {
    const testing::TemporaryDirectory directory;
    auto store = *cache::StoreWriter::open(real_file_system(), directory / "cache", false);
    ASSERT_TRUE(testing::commit_sized(store, "KBGM", noon - 5min));
    const int notify = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    const Descriptor descriptor(notify);
    std::vector<CacheEvent> told;
    CacheTree tree(directory / "cache", notify,
                   [&](const CacheChange& change) { told.push_back(change.event); });
    tree.scan();
    ASSERT_EQ(told, std::vector{CacheEvent::came});
    ASSERT_TRUE(testing::commit_sized(store, "KBGM", noon));
    ASSERT_TRUE(store.remove(store.list("KBGM", level2::Moment::ref, noon, noon)->front()));
    std::array<char, 65536> events{};
    const ssize_t size = ::read(notify, events.data(), events.size());
    ASSERT_GT(size, 0);
    EXPECT_TRUE(tree.take(events.data(), static_cast<std::size_t>(size)));
    EXPECT_EQ(told, (std::vector{CacheEvent::came, CacheEvent::went}));
}

// 2026-11-28: grids that could not be read for a while were reported as evicted. Here a link that
// leads to itself makes a directory unreadable.
TEST(CacheWatch, WhatCannotBeLookedAtIsNotGone) {
    const testing::TemporaryDirectory directory;
    std::filesystem::create_directory(directory / "a");
    std::filesystem::create_directory_symlink(directory / "a", directory / "b");
    auto store = *cache::StoreWriter::open(real_file_system(), directory / "a/cache", false);
    ASSERT_TRUE(testing::commit_sized(store, "KBGM", noon));
    std::vector<CacheEvent> told;
    std::mutex mutex;
    const auto watch = CacheWatch::open(directory / "b/cache", [&](const CacheChange& change) {
        const std::scoped_lock lock(mutex);
        told.push_back(change.event);
    });
    std::filesystem::remove(directory / "b");
    std::filesystem::create_symlink("b", directory / "b");
    watch->rescan();
    {
        const std::scoped_lock lock(mutex);
        EXPECT_EQ(std::ranges::count(told, CacheEvent::went), 0);
        EXPECT_TRUE(watch->problem());
    }
    std::filesystem::remove(directory / "b");
    std::filesystem::create_directory_symlink(directory / "a", directory / "b");
    watch->rescan();
    EXPECT_EQ(watch->problem(), std::nullopt);
    ASSERT_TRUE(store.remove(store.list("KBGM", level2::Moment::ref, noon, noon)->front()));
    watch->rescan();
    const std::scoped_lock lock(mutex);
    EXPECT_EQ(std::ranges::count(told, CacheEvent::went), 1);
}

}  // namespace
}  // namespace stormcellar::web
