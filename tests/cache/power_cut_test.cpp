// Tests a power cut, or a lasting failure of the disk, at each operation of a RollingStore.
#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "cache/pins.h"
#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;
using testing::noon;

constexpr std::uint64_t budget = 260'000;

Budgets budgets() {
    Budgets made;
    made.total.bytes = budget;
    made.low_watermark = 0.6;
    return made;
}

struct Promises {
    std::map<fs::path, std::string> grids;  // notes of the grids that commit() returned, by path
    std::optional<fs::path> pinned;
};

// Commits more grids of two days than the budget holds, replaces a grid, pins a grid, and rolls.
void live(FileSystem& disk, const fs::path& cache, Promises& promised) {
    auto store = RollingStore::open(disk, cache, budgets());
    if (!store) return;
    int number = 0;
    const auto commit = [&](int minute, int stored) {
        ++number;
        const auto path =
            testing::commit_sized(*store, "A", noon + minutes{minute}, stored, number);
        if (path && !path->empty()) promised.grids[*path] = std::to_string(number);
    };
    for (const int minute : {700, 710, 720, 725, 730})
        commit(minute, 4);
    const auto path = *store->path_of("A", level2::Moment::ref, noon + minutes{710});
    if (pin_grid(disk, path)) promised.pinned = path;
    commit(730, 6);
    for (const int minute : {740, 750, 760})
        commit(minute, 3);
    store->roll();
    commit(770, 4);
}

std::string note_of(const fs::path& path) {
    const auto file = GridFile::open(path);
    return file ? file->description().provenance.notes.at(0) : file.error().message;
}

// Expects that every grid is whole, and that the cache is within its budget now and after the next
// start. No temporary file may be left after that start. The newest grid that commit() returned
// must exist, unchanged or replaced by a later grid.
void check(const fs::path& cache, const Promises& promised) {
    if (!fs::exists(cache)) return;
    EXPECT_LE(testing::allocated_bytes(cache), budget);
    {
        const auto store = *StoreReader::open(cache);
        for (const StoreEntry& entry : testing::all_grids(store))
            EXPECT_EQ(testing::trouble_in(entry), "");
    }
    testing::MeteredFileSystem disk(cache);
    auto store = RollingStore::open(disk, cache, budgets());
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_LE(testing::allocated_bytes(cache), budget);
    EXPECT_EQ(store->usage().bytes, testing::allocated_bytes(cache));
    for (const auto& entry : fs::recursive_directory_iterator(cache)) {
        EXPECT_FALSE(entry.path().filename().native().starts_with(temporary_prefix));
    }
    if (promised.pinned) {
        EXPECT_TRUE(fs::exists(*promised.pinned) && is_pinned(*promised.pinned));
    }
    if (promised.grids.empty()) return;
    const auto& [newest, number] = *promised.grids.rbegin();
    ASSERT_TRUE(fs::exists(newest)) << newest;
    EXPECT_GE(std::stoi(note_of(newest)), std::stoi(number));
}

std::uint64_t operations_of_a_whole_life() {
    const testing::TemporaryDirectory directory;
    testing::PowerCutFileSystem disk;
    Promises promised;
    live(disk, directory / "cache", promised);
    return disk.operation_count();
}

enum class Ending { failure, power_cut };

// Runs live() on a disk that fails at operation `at` and at all later operations. Then checks what
// remains.
void live_until(std::uint64_t at, Ending ending) {
    SCOPED_TRACE(at);
    const testing::TemporaryDirectory directory;
    testing::PowerCutFileSystem disk;
    disk.fail_from(at);
    Promises promised;
    live(disk, directory / "cache", promised);
    if (ending == Ending::power_cut) disk.power_cut();
    check(directory / "cache", promised);
}

// The room of a removed grid is used again only after the removal was synced. Otherwise a power cut
// would bring the grid back beside the grid that took its room.
TEST(RollingPowerCut, LeavesWholeGridsAndTheBudgetAtEachOperation) {
    const std::uint64_t operations = operations_of_a_whole_life();
    ASSERT_GT(operations, 80U);
    for (std::uint64_t at = 0; at <= operations; ++at)
        live_until(at, Ending::power_cut);
}

TEST(RollingPowerCut, ADiskThatFailsForGoodLeavesWholeGridsAndTheBudget) {
    const std::uint64_t operations = operations_of_a_whole_life();
    for (std::uint64_t at = 0; at <= operations; at += 3)
        live_until(at, Ending::failure);
}

}  // namespace
}  // namespace stormcellar::cache
