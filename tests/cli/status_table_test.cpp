#include "cli/query/status_table.h"

#include <array>
#include <cstdlib>
#include <limits>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/shared/paint.h"
#include "cli/shared/short_duration.h"

namespace stormcellar::cli {
namespace {

using nlohmann::json;

const UtcTime now = *parse_utc("2022-03-17T00:20:00Z", UtcTime{});

TEST(ShortDuration, IsShort) {
    const auto text = [](double seconds) { return short_duration(seconds); };
    EXPECT_EQ(text(0), "0 ms");
    EXPECT_EQ(text(0.085), "85 ms");
    EXPECT_EQ(text(0.9994), "999 ms");
    EXPECT_EQ(text(0.9996), "1.0 s");
    EXPECT_EQ(text(4.25), "4.2 s");
    EXPECT_EQ(text(9.96), "10 s");
    EXPECT_EQ(text(99), "99 s");
    EXPECT_EQ(text(100), "1.7 min");
    EXPECT_EQ(text(720), "12 min");
    EXPECT_EQ(text(11'520), "3.2 h");
    EXPECT_EQ(text(40 * 3600), "40 h");
    EXPECT_EQ(text(5 * 86'400), "5.0 d");
    EXPECT_EQ(text(21 * 365.25 * 86'400), "21 y");
    EXPECT_EQ(text(-42), "-42 s");
    EXPECT_EQ(short_duration(std::nullopt), "-");
    EXPECT_EQ(text(std::numeric_limits<double>::infinity()), "-");
}

json station(const std::string& name) {
    return {{"station", name},
            {"volume_time", "2022-03-17T00:08:42Z"},
            {"ingested_at", "2022-03-17T00:19:50Z"},
            {"data_at", "2022-03-17T00:19:55Z"},
            {"gridded", 12U},
            {"partial", 1U},
            {"rejected", 2U},
            {"latency_s", {{"count", 9U}, {"median", 0.085}, {"p95", 0.12}, {"max", 2.5}}},
            {"antenna_to_cache_s",
             {{"count", 3U}, {"median", 21}, {"p95", 30}, {"max", 33}, {"last", 20}}},
            {"sweep_latency_s", {{"count", 8U}, {"median", 0.2}, {"p95", 0.5}, {"max", 2}}},
            {"missing_chunks", 70U},
            {"missing", json::array()}};
}

TEST(StatusTable, ShowsStationsByNameAndWhatIsWrong) {
    json ktlx = station("KTLX");
    ktlx["missing"] = {
        {{"volume_time", "2022-03-17T00:08:42Z"}, {"count", 70U}, {"numbers", {3, 9}}}};
    json kbgm = station("KBGM");
    kbgm["latency_s"] = {{"count", 0U}, {"median", nullptr}, {"p95", nullptr}, {"max", nullptr}};
    kbgm["antenna_to_cache_s"] = {{"median", nullptr}, {"p95", nullptr}, {"last", 720'000}};
    const json status = {
        {"state", "running"},
        {"pid", 17U},
        {"version", "1.2"},
        {"started", "2022-03-17T00:00:00Z"},
        {"drop", "/d"},
        {"cache", "/c"},
        {"directories", 3U},
        {"rolling",
         {{"grids", 120U},
          {"pinned", 2U},
          {"bytes", 500'000'000U},
          {"budget_bytes", 1'000'000'000U},
          {"evicted", 7U},
          {"evicted_bytes", 7000U}}},
        {"pending", {{"waiting", 4U}, {"running", 2U}, {"growing", 1U}}},
        {"overflows", 1U},
        {"scans", 5U},
        {"ingested", 24U},
        {"partial", 2U},
        {"rejected", 3U},
        {"rejected_by", {{"corrupt", 2U}, {"empty", 1U}}},
        {"failures", 0U},
        {"failures_by", json::object()},
        {"latency_s", {{"count", 9U}, {"median", 0.085}, {"p95", 0.12}, {"max", 2.5}}},
        {"living_grids", 180U},
        {"sweep_latency_s", {{"count", 180U}, {"median", 0.2}, {"p95", 0.5}, {"max", 2}}},
        {"antenna_to_cache_s",
         {{"count", 3U}, {"median", 21}, {"p95", 30}, {"max", 33}, {"not_live", 6U}}},
        {"stations", {ktlx, kbgm}},
        {"rejected_files",
         {{{"file", "/d/x"},
           {"at", "2022-03-17T00:01:00Z"},
           {"by", "corrupt"},
           {"reason", "why"}}}},
        {"loops",
         {{"running", 1U},
          {"restarts", 2U},
          {"made", 30U},
          {"each",
           {{{"name", "plains"},
             {"running", true},
             {"last_made", "2022-03-17T00:19:30Z"},
             {"frames", 24U},
             {"made", 30U},
             {"restarts", 2U},
             {"last_problem", "signal 9"}}}}}},
        {"loops_service", {{"state", "running"}, {"pid", 18U}, {"alive", true}}}};
    EXPECT_EQ(
        status_table(status, now),
        "stormcellard 1.2 (process 17): running, started 2022-03-17T00:00:00Z, 20 min ago\n"
        "drop     /d: 3 directories\n"
        "cache    /c: 120 grids, 500 MB of 1.00 GB (50 %), 2 pinned; 7 evicted (7.00 kB)\n"
        "queue    4 waiting, 2 running, 1 growing; 1 overflow of the kernel's event queue, 5 "
        "scans\n"
        "files    24 gridded (2 partial), 3 rejected (2 corrupt, 1 empty), 0 with nothing to "
        "grid, 0 failures\n"
        "close to cache    p50 85 ms, p95 120 ms, max 2.5 s (9 files)\n"
        "close to sweep    p50 200 ms, p95 500 ms, max 2.0 s (180 living grids)\n"
        "antenna to cache  p50 21 s, p95 30 s, max 33 s (3 volumes; 6 more were over an hour "
        "old)\n"
        "loops    1 of 1 running, 30 made, 2 restarts; run by process 18: running\n"
        "\n"
        "station  volume  cached   data    p50     p95    max  sweep p50  sweep p95  sweep max  "
        "antenna p50  antenna p95  gridded  partial  rejected  missing\n"
        "KBGM     11 min    10 s  5.0 s      -       -      -     200 ms     500 ms      2.0 s   "
        "old: 8.3 d            -       12        1         2       70\n"
        "KTLX     11 min    10 s  5.0 s  85 ms  120 ms  2.5 s     200 ms     500 ms      2.0 s  "
        "       21 s         30 s       12        1         2       70\n"
        "missing chunks of KTLX, volume 2022-03-17T00:08:42Z: 3, 9, ...\n"
        "rejected last:\n"
        "  2022-03-17T00:01:00Z  /d/x: corrupt (why)\n"
        "\n"
        "loop    running  last made  frames  made  restarts\n"
        "plains      yes       30 s      24    30         2\n"
        "loop plains: signal 9\n");
}

TEST(StatusTable, SaysWhichProcessRunsTheLoopsOrThatItIsGone) {
    json status = {{"loops", {{"running", 1U}, {"each", {{{"name", "a"}, {"running", true}}}}}},
                   {"loops_service", {{"state", "running"}, {"pid", 18U}, {"alive", false}}}};
    const std::string gone = "; process 18, which ran them, is gone\n";
    EXPECT_NE(status_table(status, now).find(gone), std::string::npos);
    status["loops_service"]["state"] = "stopped";
    EXPECT_EQ(status_table(status, now).find(gone), std::string::npos);
    EXPECT_NE(status_table(status, now).find("; run by process 18: stopped\n"), std::string::npos);
    status.erase("loops_service");
    EXPECT_EQ(status_table(status, now).find("process runs them"), std::string::npos);
    status["loops"]["elsewhere"] = true;
    EXPECT_NE(status_table(status, now).find("; no process runs them\n"), std::string::npos);
}

TEST(StatusTable, AStatusWithMissingOrWrongFieldsIsStillShown) {
    for (const char* text :
         {"{}", R"({"stations": 5, "rolling": [], "loops": 7, "rejected_files": {}})",
          R"({"stations": [null, 5, {"missing": [1], "latency_s": "x"}], "pending": "x"})",
          R"({"pid": -1, "started": "yesterday", "rejected_files": [null, {"file": 3}]})",
          R"({"rolling": {"bytes": "many", "budget_bytes": 0}, "rejected_by": {"a": "b"}})"}) {
        const std::string page = status_table(json::parse(text), now);
        EXPECT_TRUE(page.starts_with("stormcellard - ")) << page;
    }
}

TEST(StatusTable, SaysWhenTheDropDirectoryIsLost) {
    const json status = {
        {"drop", "/d"}, {"directories", 0U}, {"drop_lost", "/d: Permission denied"}};
    EXPECT_NE(
        status_table(status, now).find("drop     /d: 0 directories; LOST: /d: Permission denied\n"),
        std::string::npos);
}

// 2026-11-28: if LDM wrote with umask 027 and the service was not in its group, the status showed a
// feed without data.
TEST(StatusTable, NamesDirectoriesThatCannotBeRead) {
    const json status = {
        {"drop", "/d"},
        {"unreadable",
         {{"count", 3U},
          {"directories",
           {{{"directory", "/d/KLOT"}, {"reason", "Permission denied; (ldm-group.conf)"}}}}}}};
    const std::string page = status_table(status, now);
    EXPECT_NE(page.find("unread   /d/KLOT: Permission denied; (ldm-group.conf)\n"
                        "unread   and 2 more\n"),
              std::string::npos)
        << page;
}

TEST(StatusTable, ControlCharactersAreNotPassedOn) {
    const json status = {{"state", "\x1b[2J"}, {"stations", {{{"station", "K\n\x07"}}}}};
    const std::string page = status_table(status, now);
    EXPECT_EQ(page.find('\x1b'), std::string::npos);
    EXPECT_EQ(page.find('\x07'), std::string::npos);
}

std::string without_colors(std::string text) {
    for (std::size_t at = text.find('\x1B'); at != std::string::npos; at = text.find('\x1B'))
        text.erase(at, text.find('m', at) + 1 - at);
    return text;
}

TEST(StatusTable, TroubleHasColorsAndTheTextStays) {
    json ktlx = station("KTLX");
    ktlx["missing"] = {
        {{"volume_time", "2022-03-17T00:08:42Z"}, {"count", 70U}, {"numbers", {3, 9}}}};
    json status = {{"state", "stopped"},
                   {"drop_lost", "/d: Permission denied"},
                   {"rejected", 2U},
                   {"failures", 0U},
                   {"stations", {ktlx}}};
    const std::string page = status_table(status, now, Paint::colors);
    EXPECT_EQ(without_colors(page), status_table(status, now));
    EXPECT_NE(page.find("\x1B[1;31mstopped\x1B[0m"), std::string::npos) << page;
    EXPECT_NE(page.find("\x1B[1;31mLOST: /d: Permission denied\x1B[0m"), std::string::npos);
    EXPECT_NE(page.find("\x1B[33m2 rejected\x1B[0m"), std::string::npos);
    EXPECT_NE(page.find("\x1B[33mmissing chunks of KTLX"), std::string::npos);
    EXPECT_NE(page.find(" 0 failures\n"), std::string::npos) << "0 failures have no color";
    status = {{"state", "running"}, {"stations", json::array()}};
    EXPECT_EQ(status_table(status, now, Paint::colors), status_table(status, now));
}

TEST(Paint, IsForTerminalsAlone) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    ::unsetenv("NO_COLOR");
    ::setenv("TERM", "xterm-256color", 1);
    EXPECT_EQ(paint_for(ends[1]), Paint::plain) << "a pipe is not a terminal";
    ::close(ends[0]);
    ::close(ends[1]);
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0) GTEST_SKIP() << "this machine has no pseudo-terminals";
    EXPECT_EQ(paint_for(terminal), Paint::colors);
    ::setenv("TERM", "dumb", 1);
    EXPECT_EQ(paint_for(terminal), Paint::plain);
    ::unsetenv("TERM");
    EXPECT_EQ(paint_for(terminal), Paint::plain);
    ::setenv("TERM", "xterm", 1);
    ::setenv("NO_COLOR", "1", 1);
    EXPECT_EQ(paint_for(terminal), Paint::plain);
    ::setenv("NO_COLOR", "", 1);
    EXPECT_EQ(paint_for(terminal), Paint::colors) << "an empty NO_COLOR counts as not set";
    ::unsetenv("NO_COLOR");
    ::close(terminal);
    EXPECT_EQ(in_red("", Paint::colors), "");
}

}  // namespace
}  // namespace stormcellar::cli
