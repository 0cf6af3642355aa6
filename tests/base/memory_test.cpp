#include "base/memory.h"

#include <cstdlib>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace stormcellar {
namespace {

constexpr std::size_t volume_bytes = std::size_t{16} << 20;

// Faults that it takes to touch fresh arrays of a volume's size, which are then freed.
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
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
    GTEST_SKIP() << "another allocator";
#endif
    keep_freed_memory();
    EXPECT_GT(faults_of_a_volume(), 2000);
    EXPECT_LT(faults_of_a_volume(), 100);
}

}  // namespace
}  // namespace stormcellar
