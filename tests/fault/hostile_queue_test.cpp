// Tests files that the service might read again and again: files that cannot be gridded, and chunks
// of many volumes that take turns.
#include <array>
#include <chrono>
#include <cstdio>

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "tests/fault/hostile_cases.h"
#include "tests/fault/hostile_watch.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::slow_down;

TEST_F(HostileCases, FilesThatCannotBeGriddedAreSettledAtOnceAndFillNoQueue) {
    start({.watch = "queue_limit = 64\n"});
    const UtcTime start_time = now_utc();
    std::vector<fs::path> names;
    for (int i = 0; i < 200; ++i) {
        names.emplace_back("KTLX_bad" + std::to_string(i));
        put(names.back(), overflowing_bytes(claims_of("KTLX", start_time + milliseconds{i})));
    }
    // Wait until some files are rejected. Perhaps all files are rejected before the first look.
    const std::string at_first = not_rejected(names);
    EXPECT_TRUE(comes_true(15 * slow_down, [&] {
        const std::string now = not_rejected(names);
        return now.empty() || now != at_first;
    })) << log_end();
    expect_gridded("KFWS", put_good("KFWS"));
    EXPECT_TRUE(comes_true(15 * slow_down, [&] { return not_rejected(names).empty(); }))
        << not_rejected(names);
    EXPECT_TRUE(rests(prompt_s));
    EXPECT_EQ(lines_with("trying again"), 0U) << log_end();
    EXPECT_EQ(daemon_.status()["failures"], 0);
    stop();
}

// Counts how often files of some directories are opened, except files under a dot-name. The thread
// of the test reads the events, often enough that the kernel drops no events.
class Openings {
  public:
    Openings() : events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}
    Openings(const Openings&) = delete;
    Openings& operator=(const Openings&) = delete;
    ~Openings() { ::close(events_); }

    void watch(const fs::path& directory) const {
        EXPECT_GE(::inotify_add_watch(events_, directory.c_str(), IN_OPEN), 0);
    }
    std::size_t count() {
        alignas(inotify_event) std::array<char, 65'536> buffer{};
        for (ssize_t length = 0; (length = ::read(events_, buffer.data(), buffer.size())) > 0;) {
            for (ssize_t at = 0; at < length;) {
                const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
                EXPECT_EQ(event->mask & IN_Q_OVERFLOW, 0U);
                const bool is_file = event->len > 0 && (event->mask & IN_ISDIR) == 0;
                count_ += is_file && event->name[0] != '.' ? 1 : 0;
                at += static_cast<ssize_t>(sizeof(inotify_event)) + event->len;
            }
        }
        return count_;
    }

  private:
    int events_;
    std::size_t count_ = 0;
};

// Delivers the chunks of many volumes, one chunk of each volume in turn. The service cannot follow
// so many volumes at the same time.
TEST_F(HostileCases, ChunksOfManyVolumesInTurnAreNotReadAgainAndAgain) {
    constexpr int volumes = 350, chunks = 10;
    const UtcTime time = now_utc() - std::chrono::minutes{5};
    const auto directory_of = [&](int volume) { return fs::path{"KTLX"} / std::to_string(volume); };
    const auto put_chunk = [&](int volume, int chunk) {
        Claims claims = claims_of("KTLX", time + seconds{volume % 100});
        claims.radials = 90;
        claims.sweeps = chunks + 1;  // so that no volume ends
        claims.is_varied = true;
        Bytes bytes = wire::ldm_record(sweep_messages(claims, static_cast<unsigned>(chunk)));
        if (chunk == 0) bytes = wire::join({file_header(claims), bytes});
        const std::string name = format_compact(time + seconds{volume % 100});
        std::array<char, 40> number{};
        std::snprintf(number.data(), number.size(), "-%03d-%c", chunk + 1, chunk == 0 ? 'S' : 'I');
        put(directory_of(volume) / (name.substr(0, 8) + "-" + name.substr(9) + number.data()),
            bytes);
    };
    start();
    Openings openings;
    for (int volume = 0; volume < volumes; ++volume) {
        fs::create_directories(daemon_.drop() / directory_of(volume));
        openings.watch(daemon_.drop() / directory_of(volume));
    }
    for (int chunk = 0; chunk < chunks; ++chunk) {
        for (int volume = 0; volume < volumes; ++volume) {
            put_chunk(volume, chunk);
            openings.count();
            testing::pass_time(milliseconds{3});  // so that the daemon handles each chunk
        }
    }
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    const std::size_t opened = openings.count();
    std::printf("%d chunks, opened %zu times\n", volumes * chunks, opened);
    EXPECT_GE(opened, 16U * chunks / 2) << "not even the volumes that have a place were followed";
    EXPECT_LE(opened, static_cast<std::size_t>(volumes * chunks)) << "no chunk is opened twice";
    stop();
}

}  // namespace
}  // namespace stormcellar::fault
