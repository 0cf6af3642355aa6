// Tests readers beside a writer that evicts, and writers that are killed, in separate processes.
#include <atomic>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/slow_down.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

extern char** environ;

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::minutes;
using testing::noon;

constexpr std::uint64_t budget = 400'000;

pid_t start(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CACHE_WORKER);
    std::vector<char*> argv;
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    EXPECT_EQ(posix_spawn(&child, CACHE_WORKER, nullptr, nullptr, argv.data(), environ), 0);
    return child;
}

int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

Budgets budgets() {
    Budgets made;
    made.total.bytes = budget;
    return made;
}

// Many readers read while a writer commits and evicts. A reader that holds a file open can still
// read it after the file was evicted.
TEST(CacheProcesses, ReadersSeeWholeGridsWhileAWriterEvicts) {
    const testing::TemporaryDirectory directory;
    const fs::path cache = directory / "cache";
    testing::MeteredFileSystem disk(cache);
    RollingStore store = *RollingStore::open(disk, cache, budgets());
    ASSERT_TRUE(testing::commit_sized(store, "A", noon - minutes{1}));
    const pid_t reader = start({"read", cache, directory / "stop"});

    std::atomic<bool> stop{false};
    std::atomic<int> read{0}, held{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i) {
        threads.emplace_back([&] {
            // The grids are kept open until one of them is evicted.
            std::vector<std::pair<fs::path, GridFile>> open;
            const auto close_all = [&] {
                for (const auto& [path, file] : open) {
                    EXPECT_TRUE(file.verify());
                    EXPECT_EQ(grid::to_dense(file.view()).values.size(),
                              file.description().spec.cell_count());
                    if (!fs::exists(path)) ++held;
                    ++read;
                }
                open.clear();
            };
            while (!stop) {
                for (const StoreEntry& entry : testing::all_grids(store)) {
                    auto file = GridFile::open(entry.path);
                    if (!file) {
                        EXPECT_EQ(file.error().code, ErrorCode::not_found);
                        continue;
                    }
                    open.emplace_back(entry.path, std::move(*file));
                }
                const auto is_evicted = [](const auto& one) { return !fs::exists(one.first); };
                (void)testing::eventually(
                    [&] { return stop || open.empty() || std::ranges::any_of(open, is_evicted); });
                close_all();
            }
        });
    }
    for (int minute = 0; minute < 200; ++minute)
        EXPECT_TRUE(testing::commit_sized(store, "A", noon + minutes{minute}, 1 + minute % 8));
    stop = true;
    for (auto& thread : threads)
        thread.join();
    std::ofstream(directory / "stop") << "stop";
    EXPECT_EQ(wait_for(reader), 0);
    EXPECT_GT(read, 0);
    EXPECT_GT(held, 0) << "no reader held a grid that was evicted";
    EXPECT_GT(store.usage().evicted, 150U);
    EXPECT_LE(disk.most(), budget);
}

// Returns false if the file does not appear within a minute.
bool wait_for_file(const fs::path& path) {
    return testing::eventually([&] { return fs::exists(path); });
}

// After each kill -9 at a random moment, all grids are whole and within the budget, and the next
// writer starts.
TEST(CacheProcesses, AKilledWriterLeavesWholeGridsWithinTheBudget) {
    const testing::TemporaryDirectory directory;
    const fs::path cache = directory / "cache";
    std::mt19937 random(3);
    int seen = 0;
    for (int round = 0; round < 30 / testing::slow_down; ++round) {
        SCOPED_TRACE(round);
        const fs::path begun = directory / ("begun-" + std::to_string(round));
        const pid_t writer =
            start({"write", cache, std::to_string(budget), std::to_string(round), begun});
        // Every third writer is killed early, perhaps while it starts.
        if (round % 3 != 2) {
            EXPECT_TRUE(wait_for_file(begun));
        }
        testing::pass_time(milliseconds{random() % 50});
        kill(writer, SIGKILL);
        ASSERT_EQ(wait_for(writer), -SIGKILL) << "the writer ended before it was killed";
        if (!fs::exists(cache)) continue;
        EXPECT_LE(testing::allocated_bytes(cache), budget);
        for (const StoreEntry& entry : testing::all_grids(*StoreReader::open(cache))) {
            EXPECT_EQ(testing::trouble_in(entry), "");
            ++seen;
        }
    }
    EXPECT_GT(seen, 0);
    RollingStore store = *RollingStore::open(real_file_system(), cache, budgets());
    EXPECT_EQ(store.usage().bytes, testing::allocated_bytes(cache));
    EXPECT_GT(store.usage().grids, 0U);
    for (const auto& entry : fs::recursive_directory_iterator(cache))
        EXPECT_FALSE(entry.path().filename().native().starts_with(temporary_prefix));
}

}  // namespace
}  // namespace stormcellar::cache
