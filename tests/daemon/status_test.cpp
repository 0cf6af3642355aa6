#include "daemon/status/status.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/daemon/fake_sink.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using std::chrono::milliseconds;

Finished finished(const std::string& path, IngestResult result, int latency_ms) {
    Finished made{.job = {}, .taken = Taken{{}, outcome_of(result)}, .started = {}, .ended = {}};
    made.job.path = path;
    made.started = SteadyTime{} + milliseconds{1'000'000};
    made.ended = made.started + milliseconds{10};
    if (latency_ms >= 0) made.job.closed_at = made.ended - milliseconds{latency_ms};
    return made;
}

TEST(Latency, RunsFromTheCloseToTheEndOfTheJob) {
    EXPECT_DOUBLE_EQ(*latency_of(finished("a", IngestResult::gridded, 85)), 0.085);
    EXPECT_FALSE(latency_of(finished("a", IngestResult::gridded, -1)));
}

TEST(Latency, SummariesAreByNearestRank) {
    std::vector<double> values(100);
    std::iota(values.begin(), values.end(), 1);
    std::reverse(values.begin(), values.end());
    const LatencySummary hundred = summarise(values);
    EXPECT_EQ(hundred.count, 100U);
    EXPECT_EQ(hundred.median, 50);
    EXPECT_EQ(hundred.p95, 95);
    EXPECT_EQ(hundred.max, 100);
    const LatencySummary one = summarise({7});
    EXPECT_EQ(one.median, 7);
    EXPECT_EQ(one.p95, 7);
    EXPECT_EQ(summarise({3, 1, 2}).median, 2);
    EXPECT_EQ(summarise({}).count, 0U);
}

TEST(StatusBook, CountsEachEnd) {
    StatusBook book("/d", "/c");
    for (const int latency_ms : {100, 300, 200})
        book.add(finished("/d/a\nb", IngestResult::gridded, latency_ms));
    book.add(finished("/d/old", IngestResult::gridded, -1));
    Finished partial = finished("/d/p", IngestResult::gridded, -1);
    partial.taken->ingest.reason = "ends early";
    partial.taken->ingest.partial = true;
    book.add(partial);
    book.add(finished("/d/r", IngestResult::rejected, 1));
    book.add(finished("/d/n", IngestResult::no_moment, 1));
    book.add(finished("/d/u", IngestResult::unchanged, 1));
    book.add(finished("/d/v", IngestResult::vanished, 1));
    Finished failed = finished("/d/f", IngestResult::gridded, 1);
    failed.taken = fail(ErrorCode::io, "no");
    book.add(failed);
    book.count_overflow();
    book.count_scan();
    book.set_directories(3);
    book.count_unseen(2);
    book.set_longest_wait(7.5);
    Finished growing = finished("/d/g", IngestResult::incomplete, 1);
    growing.taken->ingest.living_left_out = true;
    growing.taken->ingest.given_up = 3;
    book.add(growing);
    book.set_state("running");

    const auto status = nlohmann::json::parse(book.json({4, 2, 1}, now_utc()));
    EXPECT_EQ(status["state"], "running");
    EXPECT_EQ(status["ingested"], 5);
    EXPECT_EQ(status["grids"], 5);
    EXPECT_EQ(status["partial"], 1);
    EXPECT_EQ(status["rejected"], 1);
    EXPECT_EQ(status["no_moment"], 1);
    EXPECT_EQ(status["unchanged"], 1);
    EXPECT_EQ(status["vanished"], 1);
    EXPECT_EQ(status["failures"], 1);
    EXPECT_EQ(status["overflows"], 1);
    EXPECT_EQ(status["scans"], 1);
    EXPECT_EQ(status["unseen"], 2);
    EXPECT_EQ(status["directories"], 3);
    EXPECT_EQ(status["pending"], nlohmann::json({{"waiting", 4},
                                                 {"running", 2},
                                                 {"growing", 1},
                                                 {"retrying", 0},
                                                 {"longest_wait_s", 7.5},
                                                 {"waiting_files", nlohmann::json::array()}}));
    EXPECT_EQ(status["living_left_out"], 1);
    EXPECT_EQ(status["growing_given_up"], 3);
    EXPECT_EQ(status["latency_s"]["count"], 3);
    EXPECT_NEAR(status["latency_s"]["median"], 0.2, 1e-9);
    EXPECT_NEAR(status["latency_s"]["max"], 0.3, 1e-9);
    ASSERT_EQ(status["volumes"].size(), 5U);
    EXPECT_EQ(status["volumes"][0]["file"], "/d/a\\x0ab");
    EXPECT_EQ(status["volumes"][0]["station"], "KTLX");
    EXPECT_EQ(status["volumes"][0]["time"], "2022-03-17T00:08:42Z");
    EXPECT_NEAR(status["volumes"][1]["latency_s"], 0.3, 1e-9);
    EXPECT_TRUE(status["volumes"][3]["latency_s"].is_null());
}

TEST(StatusBook, SaysWhatWasWrongWithTheLastRejectedFiles) {
    StatusBook book("/d", "/c");
    const UtcTime at = *parse_utc("2022-03-17T00:10:00Z", UtcTime{});
    for (int i = 0; i < 100; ++i) {
        Finished rejected = finished("/d/r\n" + std::to_string(i), IngestResult::rejected, 1);
        rejected.taken->ingest.reason = "bad\nmagic" + std::string(10'000, 'x');
        rejected.taken->ingest.ending =
            pipeline::ended::Rejected{i < 70 ? ErrorCode::corrupt : ErrorCode::empty};
        book.add(rejected, at);
    }
    Finished failed = finished("/d/f", IngestResult::gridded, 1);
    failed.taken = fail(ErrorCode::no_space, "no");
    book.add(failed, at);
    const auto status = nlohmann::json::parse(book.json({}, now_utc()));
    EXPECT_EQ(status["rejected_by"], nlohmann::json({{"corrupt", 70}, {"empty", 30}}));
    EXPECT_EQ(status["failures_by"], nlohmann::json({{"no_space", 1}}));
    const auto files = status["rejected_files"];
    ASSERT_EQ(files.size(), 64U);
    EXPECT_EQ(files.back()["file"], "/d/r\\x0a99");
    EXPECT_EQ(files.back()["station"], "KTLX");
    EXPECT_EQ(files.back()["by"], "empty");
    EXPECT_EQ(files.back()["at"], "2022-03-17T00:10:00Z");
    const auto reason = files.back()["reason"].get<std::string>();
    EXPECT_TRUE(reason.starts_with("bad\\x0amagicxx"));
    EXPECT_LT(reason.size(), 600U);
}

// 2026-11-22: each append to a file that is not a volume was counted and listed as a rejected file.
TEST(StatusBook, AFileThatIsRejectedAgainAndAgainCountsOnce) {
    StatusBook book("/d", "/c");
    const auto reject = [&](const std::string& path, const std::string& reason) {
        Finished rejected = finished(path, IngestResult::rejected, 1);
        rejected.taken->ingest.reason = reason;
        rejected.taken->ingest.ending = pipeline::ended::Rejected{ErrorCode::not_level2};
        return book.add(rejected);
    };
    EXPECT_TRUE(reject("/d/a", "not a Level II file"));
    for (int i = 0; i < 15; ++i)
        EXPECT_FALSE(reject("/d/a", "not a Level II file"));
    EXPECT_TRUE(reject("/d/b", "not a Level II file"));
    EXPECT_TRUE(reject("/d/a", "another reason"));
    const auto status = nlohmann::json::parse(book.json({}, now_utc()));
    EXPECT_EQ(status["rejected"], 3);
    EXPECT_EQ(status["rejected_by"], nlohmann::json({{"not_level2", 3}}));
    EXPECT_EQ(status["stations"][0]["rejected"], 3);
    const auto files = status["rejected_files"];
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0]["file"], "/d/b");
    EXPECT_EQ(files[1]["file"], "/d/a");
    EXPECT_EQ(files[1]["reason"], "another reason");
}

TEST(StatusBook, EachStationHasAgesLatenciesAndWhatIsMissing) {
    StatusBook book("/d", "/c");
    const UtcTime at = *parse_utc("2022-03-17T00:15:00Z", UtcTime{});
    Finished one = finished("/d/a", IngestResult::gridded, 250);
    one.taken->ingest.newest_radial = at - std::chrono::seconds{40};
    book.add(one, at);
    book.stations().add_missing_chunks("KTLX", {at, 17, {3, 9}, 2});
    Finished old = finished("/d/b", IngestResult::gridded, -1);
    old.taken->ingest.station = "KOUN";
    old.taken->ingest.newest_radial = at - std::chrono::hours{200};
    book.add(old, at);
    book.set_listening("/run/s", 9123);
    const auto status = nlohmann::json::parse(book.json({}, at + std::chrono::seconds{5}));
    EXPECT_EQ(status["listening"], nlohmann::json({{"socket", "/run/s"}, {"http_port", 9123}}));
    EXPECT_EQ(status["antenna_to_cache_s"]["count"], 1);
    EXPECT_EQ(status["antenna_to_cache_s"]["not_live"], 1);
    ASSERT_EQ(status["stations"].size(), 2U);
    const auto koun = status["stations"][0];
    EXPECT_EQ(koun["station"], "KOUN");
    EXPECT_EQ(koun["antenna_to_cache_s"]["last"], 720'000);
    EXPECT_EQ(koun["antenna_to_cache_s"]["last_is_live"], false);
    EXPECT_TRUE(koun["antenna_to_cache_s"]["median"].is_null());
    const auto ktlx = status["stations"][1];
    EXPECT_EQ(ktlx["volume_time"], "2022-03-17T00:08:42Z");
    EXPECT_EQ(ktlx["volume_age_s"], 383);
    EXPECT_EQ(ktlx["ingested_age_s"], 5);
    EXPECT_EQ(ktlx["data_age_s"], 5);
    EXPECT_EQ(ktlx["gridded"], 1);
    EXPECT_EQ(ktlx["latency_s"]["p95"], 0.25);
    EXPECT_EQ(ktlx["antenna_to_cache_s"]["max"], 40);
    EXPECT_EQ(ktlx["missing_chunks"], 2);
    EXPECT_EQ(ktlx["missing"][0]["volume_number"], 17);
    EXPECT_EQ(ktlx["missing"][0]["numbers"], nlohmann::json({3, 9}));
}

TEST(StatusBook, SweepsOfGrowingVolumesAreCountedApart) {
    StatusBook book("/d", "/c");
    for (const int latency_ms : {100, 300}) {
        Finished one = finished("/d/a", IngestResult::incomplete, latency_ms);
        one.taken->ingest.living = {"/c/living.scg"};
        book.add(one, now_utc());
    }
    const auto status = nlohmann::json::parse(book.json({}, now_utc()));
    EXPECT_EQ(status["ingested"], 0);
    EXPECT_EQ(status["latency_s"]["count"], 0);
    EXPECT_EQ(status["living_grids"], 2);
    EXPECT_EQ(status["sweep_latency_s"]["count"], 2);
    EXPECT_NEAR(status["sweep_latency_s"]["max"], 0.3, 1e-9);
    EXPECT_EQ(status["stations"][0]["living_grids"], 2);
    EXPECT_NEAR(status["stations"][0]["sweep_latency_s"]["median"], 0.1, 1e-9);
}

TEST(StatusBook, NothingYetIsNullAndNotZero) {
    const StatusBook book("/d", "/c");
    const auto status = nlohmann::json::parse(book.json({}, now_utc()));
    EXPECT_EQ(status["state"], "starting");
    EXPECT_EQ(status["latency_s"]["count"], 0);
    EXPECT_TRUE(status["latency_s"]["median"].is_null());
}

TEST(StatusBook, StaysBounded) {
    StatusBook book("/d", "/c");
    for (int i = 0; i < 10'000; ++i)
        book.add(finished("/d/" + std::to_string(i), IngestResult::gridded, i));
    const auto status = nlohmann::json::parse(book.json({}, now_utc()));
    EXPECT_EQ(status["ingested"], 10'000);
    EXPECT_EQ(status["latency_s"]["count"], 4096);
    EXPECT_EQ(status["volumes"].size(), 64U);
    EXPECT_EQ(status["volumes"].back()["file"], "/d/9999");
}

TEST(StatusBook, PairsOfSitesStandAsTheyWereComparedLast) {
    StatusBook book("/d", "/c");
    pipeline::PairReport report;
    report.domain = "plains";
    report.instant = *parse_utc("2024-06-01T22:05:00Z", UtcTime{});
    report.found.a = "KAAA";
    report.found.b = "KBBB";
    report.found.bias_db = {-2.25, 0.125, ""};
    report.found.time_s.untold = "the motion is not known";
    report.found.cells = 1234;
    report.faults = {"KBBB against KAAA: too weak by 2.25 +- 0.12 dB"};
    book.add(report);
    report.found.b = "KCCC";
    report.faults.clear();
    book.add(report);
    report.found.bias_db.value = 1;
    book.add(report);
    const auto sites = nlohmann::json::parse(book.json({}, now_utc()))["sites"];
    ASSERT_EQ(sites.size(), 2U);
    EXPECT_EQ(sites[0]["b"], "KBBB");
    EXPECT_EQ(sites[0]["time"], "2024-06-01T22:05:00Z");
    EXPECT_EQ(sites[0]["bias_db"], (nlohmann::json{{"value", -2.25}, {"standard_error", 0.125}}));
    EXPECT_EQ(sites[0]["time_s"], (nlohmann::json{{"untold", "the motion is not known"}}));
    EXPECT_EQ(sites[0]["cells"], 1234);
    EXPECT_EQ(sites[0]["faults"].size(), 1U);
    EXPECT_EQ(sites[1]["bias_db"]["value"], 1) << "the last report counts";
    EXPECT_TRUE(sites[1]["faults"].empty());
}

TEST(StatusBook, LoopsAreSummedAndListed) {
    StatusBook book("/d", "/c");
    const auto loops = [&] { return nlohmann::json::parse(book.json({}, now_utc()))["loops"]; };
    EXPECT_EQ(loops()["running"], 0);
    EXPECT_TRUE(loops()["last_made"].is_null());
    const auto early = parse_utc("2024-06-01T22:00:00Z", now_utc()).value();
    const auto late = parse_utc("2024-06-01T22:05:00Z", now_utc()).value();
    book.set_loops({{"a", true, 2, 10, late, 24, "status 1: why"},
                    {"b", true, 1, 5, early, 12, ""},
                    {"c", false, 0, 0, std::nullopt, 0, ""}});
    EXPECT_EQ(loops()["running"], 2);
    EXPECT_EQ(loops()["restarts"], 3);
    EXPECT_EQ(loops()["made"], 15);
    EXPECT_EQ(loops()["last_made"], "2024-06-01T22:05:00Z");
    const auto each = loops()["each"];
    ASSERT_EQ(each.size(), 3U);
    EXPECT_EQ(each[0]["name"], "a");
    EXPECT_EQ(each[0]["frames"], 24);
    EXPECT_EQ(each[0]["last_problem"], "status 1: why");
    EXPECT_EQ(each[1]["last_made"], "2024-06-01T22:00:00Z");
    EXPECT_EQ(each[2]["running"], false);
    EXPECT_TRUE(each[2]["last_problem"].is_null());
}

TEST(StatusBook, ADropDirectoryThatIsLostIsNamedFirst) {
    StatusBook book("/d", "/c");
    EXPECT_TRUE(nlohmann::json::parse(book.json({}, now_utc()))["drop_lost"].is_null());
    Unreadable unreadable;
    for (int i = 0; i < 20; ++i)
        unreadable.add(fmt::format("/d/{:02}", i), "Permission denied");
    unreadable.add("/d/00", "Permission denied");
    EXPECT_TRUE(book.set_unreadable(unreadable));
    EXPECT_FALSE(book.set_unreadable(unreadable)) << "the directories have not changed";
    EXPECT_TRUE(book.line({}).starts_with("cannot read 20 directories; ")) << book.line({});
    const auto named = nlohmann::json::parse(book.json({}, now_utc()))["unreadable"];
    EXPECT_EQ(named["count"], 20);
    EXPECT_EQ(named["directories"].size(), 16U);
    EXPECT_EQ(named["directories"][0]["directory"], "/d/00");
    book.set_drop_lost("/d: Permission denied");
    EXPECT_EQ(book.line({}),
              "waiting for the drop directory /d: Permission denied; ingested 0, rejected 0, "
              "waiting 0, running 0, growing 0");
    EXPECT_EQ(nlohmann::json::parse(book.json({}, now_utc()))["drop_lost"],
              "/d: Permission denied");
}

TEST(StatusBook, TheLineNamesTheLatestVolume) {
    StatusBook book("/d", "/c");
    EXPECT_EQ(book.line({}), "ingested 0, rejected 0, waiting 0, running 0, growing 0");
    book.add(finished("/d/a", IngestResult::gridded, 1));
    EXPECT_EQ(book.line({3, 2, 1}),
              "ingested 1 (latest KTLX 2022-03-17T00:08:42Z), rejected 0, waiting 3, running 2, "
              "growing 1");
}

// A name that is not UTF-8 must not break the document.
TEST(StatusBook, OddBytesInNamesAreEscaped) {
    StatusBook book("/d\xFF", "/c");
    book.add(finished("/d/\xC3\x28", IngestResult::gridded, 1));
    const auto status = nlohmann::json::parse(book.json({}, now_utc()));
    EXPECT_EQ(status["drop"], "/d\\xff");
    EXPECT_EQ(status["volumes"][0]["file"], "/d/\\xc3(");
}

// A process that only runs loops must report its loops as the daemon does, and must report nothing
// about ingest.
TEST(LoopsStatus, IsTheSameForLoopsAlone) {
    std::vector<LoopState> loops(3);
    loops[0].name = "a";
    loops[0].is_running = true;
    loops[0].made = 5;
    loops[2].is_running = true;
    loops[2].made = 7;
    EXPECT_EQ(loops_line({}), "0 of 0 loops run, made 0");
    EXPECT_EQ(loops_line(loops), "2 of 3 loops run, made 12");
    const auto status = nlohmann::json::parse(
        loops_json(loops, "running", *parse_utc("2024-06-01T22:00:00Z", now_utc()),
                   *parse_utc("2024-06-01T22:05:00Z", now_utc())));
    EXPECT_EQ(status["state"], "running");
    EXPECT_EQ(status["started"], "2024-06-01T22:00:00Z");
    EXPECT_EQ(status["updated"], "2024-06-01T22:05:00Z");
    StatusBook book("/d", "/c");
    book.set_loops(loops);
    EXPECT_EQ(status["loops"], nlohmann::json::parse(book.json({}, now_utc()))["loops"]);
    EXPECT_FALSE(status.contains("ingested"));
}

}  // namespace
}  // namespace stormcellar::daemon
