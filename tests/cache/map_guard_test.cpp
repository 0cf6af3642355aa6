// Tests files that another program cuts while they are mapped (cache/map_guard.h).
#include "cache/map_guard.h"

#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stormcellar/cache/grid_file.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

class MapGuard : public ::testing::Test {
  protected:
    fs::path write(const std::string& name) {
        const auto bricks = grid::BrickGrid::from(testing::small_grid(), grid::Quantization{});
        fs::path path = directory_ / name;
        EXPECT_TRUE(write_grid_file(real_file_system(), path, describe(testing::small_grid()),
                                    bricks.view()));
        return path;
    }
    // Keeps 4096 bytes, the smallest page size, so that machines with larger pages read the first
    // missing code through the map, too.
    static void cut(const fs::path& path) { fs::resize_file(path, 4096); }

    testing::TemporaryDirectory directory_;
};

std::size_t values_in(const GridFile& file) {
    std::size_t values = 0;
    for (const grid::CellStatus status : grid::to_dense(file.view()).status)
        values += status == grid::CellStatus::value ? 1 : 0;
    return values;
}

TEST_F(MapGuard, AFileCutUnderTheMapIsAnErrorAfterUse) {
    install_map_guard();
    const fs::path path = write("a.scg");
    const auto file = GridFile::open(path);
    const auto other = GridFile::open(write("b.scg"));
    ASSERT_TRUE(file && other);
    const std::size_t whole = values_in(*other);
    ASSERT_GT(whole, 0U);
    cut(path);
    EXPECT_EQ(values_in(*file), 0U) << "missing codes read as not seen";
    EXPECT_EQ(file->check_whole().error().code, ErrorCode::truncated);
    EXPECT_TRUE(other->check_whole());
    EXPECT_EQ(values_in(*other), whole);
}

TEST_F(MapGuard, AFileThatHasItsSizeAgainWasCutAllTheSame) {
    install_map_guard();
    const fs::path path = write("a.scg");
    const auto file = GridFile::open(path);
    ASSERT_TRUE(file);
    const auto size = fs::file_size(path);
    cut(path);
    (void)values_in(*file);
    fs::resize_file(path, size);
    const Status whole = file->check_whole();
    ASSERT_FALSE(whole);
    EXPECT_EQ(whole.error().code, ErrorCode::truncated);
    EXPECT_NE(whole.error().message.find("a.scg"), std::string::npos);
    EXPECT_FALSE(file->verify());
}

// The test opens more maps than fit into the registry's first block.
TEST_F(MapGuard, EachOfManyMapsIsGuarded) {
    install_map_guard();
    const fs::path kept = write("kept.scg");
    const fs::path path = write("cut.scg");
    std::vector<GridFile> files;
    for (int i = 0; i < 600; ++i) {
        auto file = GridFile::open(i % 2 == 0 ? kept : path);
        ASSERT_TRUE(file) << file.error().message;
        files.push_back(std::move(*file));
    }
    cut(path);
    for (std::size_t i = 0; i < files.size(); ++i) {
        EXPECT_EQ(values_in(files[i]) > 0, i % 2 == 0) << i;
        EXPECT_EQ(files[i].check_whole().has_value(), i % 2 == 0) << i;
    }
    files.clear();
    const auto again = GridFile::open(kept);
    ASSERT_TRUE(again);
    EXPECT_GT(values_in(*again), 0U);
    EXPECT_TRUE(again->check_whole()) << "the registry reuses the place of a cut map";
}

TEST_F(MapGuard, ManyThreadsMeetCutFilesAtOnce) {
    install_map_guard();
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([this, t] {
            for (int i = 0; i < 20; ++i) {
                const fs::path path = write(std::to_string(t) + ".scg");
                const auto file = GridFile::open(path);
                ASSERT_TRUE(file);
                const bool spoil = (t + i) % 2 == 0;
                if (spoil) cut(path);
                EXPECT_EQ(values_in(*file) == 0, spoil);
                EXPECT_EQ(file->check_whole().has_value(), !spoil);
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
}

// The child process cuts the file at some moment while we read it.
TEST_F(MapGuard, AnotherProcessCutsTheFileWhileItIsRead) {
    install_map_guard();
    const fs::path path = write("a.scg");
    const auto file = GridFile::open(path);
    ASSERT_TRUE(file);
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        char begun = 0;
        if (::read(ends[0], &begun, 1) != 1) ::_exit(2);
        ::_exit(::truncate(path.c_str(), 4096) == 0 ? 0 : 1);
    }
    EXPECT_GT(values_in(*file), 0U);
    EXPECT_EQ(::write(ends[1], "b", 1), 1);
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (file->check_whole() && std::chrono::steady_clock::now() < limit)
        (void)values_in(*file);
    ::close(ends[0]);
    ::close(ends[1]);
    int status = 1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(file->check_whole().error().code, ErrorCode::truncated);
    EXPECT_EQ(values_in(*file), 0U);
}

// Death tests run in a new process.
class MapGuardDeathTest : public MapGuard {
  protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

    // Reads beyond the end of a file through a map that is not registered.
    void read_a_foreign_map() {
        const fs::path path = directory_ / "foreign";
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        void* const map = ::mmap(nullptr, 4096, PROT_READ, MAP_SHARED, file, 0);
        volatile const char* const byte = static_cast<const char*>(map);
        (void)*byte;
    }
};

TEST_F(MapGuardDeathTest, AnotherFaultStillEndsTheProgram) {
    EXPECT_DEATH(
        {
            install_map_guard();
            const auto file = GridFile::open(write("a.scg"));
            read_a_foreign_map();
        },
        "");
}

TEST_F(MapGuardDeathTest, ASignalThatIsSentStillEndsTheProgram) {
    EXPECT_DEATH(
        {
            install_map_guard();
            ::raise(SIGBUS);
        },
        "");
}

TEST_F(MapGuardDeathTest, TheFormerHandlerGetsEveryOtherFault) {
    EXPECT_EXIT(
        {
            std::signal(SIGBUS, [](int) { ::_exit(77); });
            install_map_guard();
            const fs::path path = write("a.scg");
            const auto file = GridFile::open(path);
            cut(path);
            if (values_in(*file) == 0) read_a_foreign_map();
        },
        ::testing::ExitedWithCode(77), "");
}

TEST_F(MapGuardDeathTest, WithoutTheGuardACutFileEndsTheProgram) {
    EXPECT_DEATH(
        {
            const fs::path path = write("a.scg");
            const auto file = GridFile::open(path);
            cut(path);
            (void)values_in(*file);
        },
        "");
}

}  // namespace
}  // namespace stormcellar::cache
