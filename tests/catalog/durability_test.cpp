// Tests the catalog after power cuts and kill -9. Afterward the catalog can be opened and is sound.
// It has every registration that returned success, except those of files that were only seen.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <map>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stormcellar/catalog/catalog.h"
#include "stormcellar/catalog/repair.h"
#include "tests/catalog/power_cut_vfs.h"
#include "tests/testing/slow_down.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::catalog {
namespace {

using testing::Kept;

FileFacts facts_of(int number, FileState state, const std::string& station = "KTLX") {
    FileFacts facts;
    facts.path = fmt::format("/d/{:06}", number);
    facts.station = station;
    facts.size_bytes = 1000;
    facts.modified_ns = number;
    facts.content_hash = static_cast<std::uint64_t>(number);
    facts.state = state;
    facts.reason = std::string(static_cast<std::size_t>(number) % 7 * 100, 'r');
    VolumeFacts volume;
    volume.start_time = UtcTime{std::chrono::minutes{number}};
    volume.volume_number = number % 1000;
    facts.volumes = {volume};
    return facts;
}

// The requests that returned success, and the request that did not return.
struct Progress {
    std::map<fs::path, FileState> answered;
    std::optional<std::pair<fs::path, FileState>> asked;  // did not return; the row may exist
};

bool ask(CatalogWriter& catalog, const FileFacts& facts, Progress& progress) {
    progress.asked = {facts.path, facts.state};
    if (!catalog.register_file(facts)) return false;
    if (facts.state != FileState::seen) progress.answered[facts.path] = facts.state;
    progress.asked.reset();
    return true;
}

bool ask_gone(CatalogWriter& catalog, const fs::path& path, Progress& progress) {
    progress.asked = {path, FileState::gone};
    if (!catalog.mark_gone(path)) return false;
    progress.answered[path] = FileState::gone;
    progress.asked.reset();
    return true;
}

// Does the work of two runs of a daemon, each with its own catalog object. Returns false after a
// failure of the disk.
bool write_all(const fs::path& directory, Progress& progress) {
    for (const int first : {0, 3}) {
        auto catalog = CatalogWriter::open(directory);
        if (!catalog) return false;
        for (int number = first; number < first + 3; ++number) {
            for (const FileState state : {FileState::seen, FileState::complete}) {
                if (!ask(*catalog, facts_of(number, state), progress)) return false;
            }
        }
        if (!ask(*catalog, facts_of(100 + first, FileState::rejected, ""), progress)) return false;
        if (!ask_gone(*catalog, facts_of(first + 1, FileState::gone).path, progress)) return false;
        // The file of this name now belongs to another station.
        if (!ask(*catalog, facts_of(first + 2, FileState::partial, "KDMX"), progress)) return false;
    }
    return true;
}

std::map<fs::path, FileState> rows_in(const CatalogReader& catalog) {
    std::map<fs::path, FileState> rows;
    const auto stations = catalog.station_names();
    EXPECT_TRUE(stations);
    for (const std::string& station : *stations) {
        const auto entries = catalog.list(station, {{}, {}, true});
        EXPECT_TRUE(entries) << entries.error().message;
        for (const CatalogEntry& entry : *entries)
            rows[entry.path] = entry.state;
    }
    return rows;
}

void expect_sound(const fs::path& directory, const Progress& progress) {
    auto catalog = CatalogWriter::open(directory);
    ASSERT_TRUE(catalog);
    auto rows = rows_in(*catalog);
    EXPECT_TRUE(catalog->take_repairs().empty());
    for (const auto& [path, state] : progress.answered) {
        ASSERT_TRUE(rows.contains(path)) << path << " is lost, although its registration succeeded";
        const bool may_differ = progress.asked && progress.asked->first == path;
        EXPECT_TRUE(rows[path] == state || (may_differ && rows[path] == progress.asked->second))
            << path << ": " << file_state_name(rows[path]) << " instead of "
            << file_state_name(state);
    }
    for (const auto& entry : fs::directory_iterator(directory)) {
        if (entry.path().extension() != ".sqlite") continue;
        const auto found = examine_database(entry.path());
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_TRUE(found->damage.empty()) << entry.path() << ": " << found->damage.front();
    }
}

// Cuts the power at an operation. Returns false if there were fewer operations.
bool cut_at(std::uint64_t operation, Kept kept, unsigned seed) {
    const testing::TemporaryDirectory directory;
    fs::create_directory(directory / "catalog");
    testing::PowerCutVfs disk;
    Progress progress;
    disk.fail_from(operation);
    const bool finished = write_all(directory / "catalog", progress);
    const bool ran_through = disk.operation_count() <= operation;
    disk.power_cut(kept, seed);
    expect_sound(directory / "catalog", progress);
    EXPECT_TRUE(finished || !ran_through);
    Progress again;
    EXPECT_TRUE(write_all(directory / "catalog", again))
        << "work cannot continue after the power cut";
    expect_sound(directory / "catalog", again);
    return !ran_through;
}

// STORMCELLAR_CRASHES=N tests every operation, each with N random remains of data that were not
// synced.
TEST(CatalogDurability, PowerCutAtEveryOperation) {
    const char* wanted = std::getenv("STORMCELLAR_CRASHES");
    const unsigned random_ones = wanted != nullptr ? static_cast<unsigned>(std::atoi(wanted)) : 1;
    const std::uint64_t step = wanted != nullptr ? 1 : 19 * testing::slow_down;
    std::uint64_t points = 0, cuts = 0;
    for (std::uint64_t operation = 0;; operation += step) {
        bool more = cut_at(operation, Kept::nothing, 0);
        more = cut_at(operation, Kept::everything, 0) && more;
        for (unsigned seed = 0; seed < random_ones; ++seed)
            more = cut_at(operation, Kept::some, seed) && more;
        ++points;
        cuts += 2 + random_ones;
        ASSERT_FALSE(::testing::Test::HasFailure()) << "operation " << operation;
        if (!more) break;
    }
    std::cout << points << " crash points, " << cuts << " power cuts\n";
    EXPECT_GT(points, 8U / testing::slow_down);
}

// Tests that PowerCutVfs loses data that were not synced. Otherwise the test above could not fail.
TEST(CatalogDurability, TheDoubleForgetsWhatWasNotSynced) {
    const testing::TemporaryDirectory directory;
    testing::PowerCutVfs disk;
    {
        auto catalog = *CatalogWriter::open(directory / "catalog");
        ASSERT_TRUE(catalog.register_file(facts_of(1, FileState::complete)));
        disk.fail_from(disk.operation_count());
        EXPECT_FALSE(catalog.register_file(facts_of(2, FileState::complete)));
    }
    disk.power_cut(Kept::nothing, 0);
    auto catalog = *CatalogWriter::open(directory / "catalog");
    EXPECT_EQ(rows_in(catalog).size(), 1U);
}

// A child process registers files, reports each success, and is killed at some moment.
TEST(CatalogDurability, KilledAtAnyMoment) {
    std::minstd_rand random(1);
    int kills = 0;
    std::size_t answered = 0;
    for (; kills < 10; ++kills) {
        const testing::TemporaryDirectory directory;
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            auto catalog = CatalogWriter::open(directory / "catalog");
            for (int number = 0; catalog; ++number) {
                if (!catalog->register_file(facts_of(number, FileState::complete))) break;
                if (::write(ends[1], &number, sizeof number) != sizeof number) break;
            }
            ::_exit(1);
        }
        ::close(ends[1]);
        Progress progress;
        int number = 0;
        const std::size_t enough = random() % 40;
        while (progress.answered.size() < enough && ::read(ends[0], &number, sizeof number) > 0)
            progress.answered[facts_of(number, FileState::complete).path] = FileState::complete;
        testing::pass_time(std::chrono::microseconds{random() % 3000});
        ::kill(child, SIGKILL);
        while (::read(ends[0], &number, sizeof number) > 0)
            progress.answered[facts_of(number, FileState::complete).path] = FileState::complete;
        ::waitpid(child, nullptr, 0);
        ::close(ends[0]);
        answered += progress.answered.size();
        if (fs::exists(directory / "catalog")) expect_sound(directory / "catalog", progress);
    }
    std::cout << kills << " kills, " << answered << " registrations answered before\n";
    EXPECT_GT(answered, 20U);
}

}  // namespace
}  // namespace stormcellar::catalog
