#include "base/memory.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace stormcellar {
namespace {

constexpr std::size_t volume_bytes = std::size_t{16} << 20;

// Touches new arrays of the size of a volume, frees them, and returns the number of page faults.
long faults_of_a_volume() {
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    {
        const std::unique_ptr<void, decltype(&std::free)> arrays{std::malloc(volume_bytes),
                                                                 &std::free};
        std::memset(arrays.get(), 1, volume_bytes);
        volatile const char* kept = static_cast<const char*>(arrays.get());
        EXPECT_EQ(kept[volume_bytes / 2], 1);
    }
    getrusage(RUSAGE_SELF, &after);
    return after.ru_minflt - before.ru_minflt;
}

TEST(KeepFreedMemory, TheSecondVolumeCostsNoFaults) {
#if defined(STORMCELLAR_SANITIZED) || !defined(__GLIBC__)
    GTEST_SKIP() << "needs glibc's malloc without a sanitizer";
#endif
    keep_freed_memory();
    EXPECT_GT(faults_of_a_volume(), 2000);
    EXPECT_LT(faults_of_a_volume(), 100);
}

// Every tenth of many small blocks is kept, so that the freed memory is between blocks in use.
TEST(GiveBackFreedMemory, WhatIsFreeBetweenOtherThingsGoesBackToTheSystem) {
#if defined(STORMCELLAR_SANITIZED) || !defined(__GLIBC__)
    GTEST_SKIP() << "needs glibc's malloc without a sanitizer";
#endif
    constexpr std::size_t count = 2000, bytes = 50'000;
    constexpr std::size_t most_kept = count * bytes / 2;
    std::vector<std::vector<char>> things;
    for (std::size_t i = 0; i < count; ++i)
        things.emplace_back(bytes, 'x');
    EXPECT_FALSE(give_back_freed_memory(std::size_t{1} << 40));
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 10 != 0) std::vector<char>{}.swap(things[i]);
    }
    const auto resident = [] {
        std::ifstream statm("/proc/self/statm");
        std::size_t all = 0, pages = 0;
        statm >> all >> pages;
        return pages * 4096;
    };
    const std::size_t before = resident();
    EXPECT_TRUE(give_back_freed_memory(most_kept));
    EXPECT_LT(resident() + count * bytes / 2, before);
    EXPECT_EQ(things[10], std::vector<char>(bytes, 'x'));
}

TEST(LargePages, AnArrayIsAllZero) {
    for (const std::size_t size : {0, 1, 1000, (1 << 20) + 3}) {
        std::vector<float> dirty(size, 1);
        dirty.clear();
        dirty.shrink_to_fit();
        const auto values = zeros_in_large_pages<float>(size);
        ASSERT_EQ(values.size(), size);
        for (const float value : values)
            ASSERT_EQ(value, 0.0F);
    }
}

// With large pages, touching 32 MiB causes few faults. Without large pages, the number of faults is
// as usual.
TEST(LargePages, AreAHintThatCostsNoMoreFaults) {
#if defined(STORMCELLAR_SANITIZED) || !defined(__GLIBC__)
    GTEST_SKIP() << "needs glibc's malloc without a sanitizer";
#endif
    constexpr std::size_t size = std::size_t{32} << 20;
    const auto faults = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_minflt;
    };
    const long before = faults();
    const auto values = zeros_in_large_pages<char>(size);
    EXPECT_EQ(values[size / 2], 0);
    EXPECT_LE(faults() - before, static_cast<long>(size / 4096) + 100);
}

}  // namespace
}  // namespace stormcellar
