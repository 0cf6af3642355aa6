#include "daemon/status/metrics_text.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"
#include "tests/daemon/metrics_reader.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using std::chrono::milliseconds;
using std::chrono::seconds;

const UtcTime asked_at = *parse_utc("2022-03-17T00:20:00Z", UtcTime{});

Finished finished(const std::string& station, IngestResult result, int latency_ms) {
    Finished made{.job = {}, .taken = Taken{{}, outcome_of(result)}, .started = {}, .ended = {}};
    made.taken->ingest.station = station;
    made.ended = SteadyTime{} + seconds{1000};
    if (latency_ms >= 0) made.job.closed_at = made.ended - milliseconds{latency_ms};
    return made;
}

double value_of(const std::string& text, const std::string& family, const std::string& series) {
    const auto families = read_metrics(text);
    const auto found = families.find(family);
    if (found == families.end() || !found->second.samples.contains(series)) {
        ADD_FAILURE() << "no " << series << " in\n" << text;
        return -1;
    }
    return found->second.samples.at(series);
}

TEST(MetricsWriter, NumbersAreReadBackAsTheyWere) {
    for (const double value : {0.1, 1e300, -2.5, 1e-9, 123456789.125}) {
        MetricsWriter out;
        out.family("x_seconds", MetricsWriter::Type::gauge, "Help.");
        out.sample(value);
        EXPECT_EQ(read_metrics(out.take()).at("x_seconds").samples.at("x_seconds"), value);
    }
    MetricsWriter out;
    out.family("x", MetricsWriter::Type::gauge, "Help.");
    out.sample(std::numeric_limits<double>::infinity(), {{"l", "a"}});
    out.sample(-std::numeric_limits<double>::infinity(), {{"l", "b"}});
    out.sample(std::numeric_limits<double>::quiet_NaN(), {{"l", "c"}});
    out.sample(std::numeric_limits<std::uint64_t>::max(), {{"l", "d"}});
    EXPECT_EQ(out.take(),
              "# HELP x Help.\n# TYPE x gauge\nx{l=\"a\"} +Inf\nx{l=\"b\"} -Inf\nx{l=\"c\"} NaN\n"
              "x{l=\"d\"} 18446744073709551615\n");
}

TEST(MetricsWriter, WhatNamesMayHoldBreaksNoLine) {
    MetricsWriter out;
    out.family("x", MetricsWriter::Type::gauge, "Help.");
    out.sample(1.0, {{"l", "quote \" slash \\ line\nend \xFF,}"}, {"m", ""}});
    const std::string text = out.take();
    EXPECT_EQ(text,
              "# HELP x Help.\n# TYPE x gauge\n"
              "x{l=\"quote \\\" slash \\\\ line\\\\x0aend \\\\xff,}\",m=\"\"} 1\n");
    EXPECT_EQ(read_metrics(text).at("x").samples.size(), 1U);
}

TEST(MetricsWriter, SummariesHaveQuantilesOnlyOfWhatWasMeasured) {
    Timings timings(4);
    MetricsWriter out;
    out.family("x_seconds", MetricsWriter::Type::summary, "Help.");
    out.sample(timings);
    for (const double value : {100.0, 1.0, 2.0, 3.0, 4.0})
        timings.add(value);
    out.sample(timings, {{"station", "KTLX"}});
    EXPECT_EQ(out.take(),
              "# HELP x_seconds Help.\n# TYPE x_seconds summary\nx_seconds_sum 0\n"
              "x_seconds_count 0\n"
              "x_seconds{station=\"KTLX\",quantile=\"0.5\"} 2\n"
              "x_seconds{station=\"KTLX\",quantile=\"0.95\"} 4\n"
              "x_seconds{station=\"KTLX\",quantile=\"1\"} 4\n"
              "x_seconds_sum{station=\"KTLX\"} 110\nx_seconds_count{station=\"KTLX\"} 5\n");
}

TEST(MetricsReader, RefusesWhatTheFormatDoesNotAllow) {
    const std::string head = "# HELP x Help.\n# TYPE x gauge\n";
    for (const std::string& wrong :
         {std::string{"x 1\n"}, head + "x 1", head + "y 1\n", head + "x one\n", head + "x{l=a} 1\n",
          head + "x{l=\"a\\q\"} 1\n", head + "x 1\nx 2\n",
          head + "x{b=\"1\",a=\"2\"} 1\n" + "x{a=\"2\",b=\"1\"} 1\n", head + head,
          head + "x_sum 1\n", std::string{"# HELP x Help.\n# TYPE x counter\n"}, head + "\n"}) {
        EXPECT_THROW((void)read_metrics(wrong), std::runtime_error) << wrong;
    }
    EXPECT_EQ(read_metrics(head + "x{b=\"1\",a=\"2\"} 1.5\n").at("x").samples,
              (std::map<std::string, double>{{R"(x{a="2",b="1"})", 1.5}}));
}

TEST(Metrics, AreValidWhenNothingHasHappenedYet) {
    const StatusBook book("/d", "/c");
    const auto families = read_metrics(metrics_text(book.facts(), {}, asked_at));
    EXPECT_EQ(families.at("stormcellar_state").samples.at("stormcellar_state{state=\"starting\"}"),
              1);
    EXPECT_FALSE(families.contains("stormcellar_cache_bytes")) << "the cache was not examined yet";
    for (const auto& [name, family] : families) {
        EXPECT_TRUE(name.starts_with("stormcellar_")) << name;
        EXPECT_FALSE(family.help.empty());
    }
}

TEST(Metrics, SayWhatTheBookCounted) {
    StatusBook book("/d", "/c");
    book.set_state("running");
    for (const int latency_ms : {100, 200, 400}) {
        Finished one = finished("KTLX", IngestResult::gridded, latency_ms);
        one.taken->ingest.newest_radial = asked_at - seconds{30};
        one.taken->ingest.partial = latency_ms == 400;
        book.add(one, asked_at - seconds{10});
    }
    Finished rejected = finished("KOUN", IngestResult::rejected, 1);
    rejected.taken->ingest.ending = pipeline::ended::Rejected{ErrorCode::corrupt};
    book.add(rejected, asked_at - seconds{5});
    Finished sweep = finished("KTLX", IngestResult::incomplete, 600);
    sweep.taken->ingest.living = {"/c/living.scg"};
    book.add(sweep, asked_at - seconds{10});
    Finished failed = finished("KTLX", IngestResult::gridded, 1);
    failed.taken = fail(ErrorCode::no_space, "full");
    book.add(failed, asked_at);
    book.stations().add_missing_chunks("KTLX", {asked_at, 17, {3, 4}, 2});
    book.set_usage({.grids = 9,
                    .pinned = 2,
                    .bytes = 1000,
                    .budget_bytes = 5000,
                    .evicted = 3,
                    .evicted_bytes = 300,
                    .not_kept = 1});
    book.set_loops({{"a", true, 2, 10, asked_at, 24, ""}});
    // left out, because this process runs loops
    book.set_others_loops({{"b", false, 0, 0, std::nullopt, 0, ""}});
    book.count_overflow();
    const std::string text = metrics_text(book.facts(), {4, 2, 1}, asked_at);
    const auto expect = [&](const std::string& family, const std::string& labels, double value) {
        EXPECT_DOUBLE_EQ(value_of(text, family, family + labels), value);
    };
    expect("stormcellar_state", R"({state="running"})", 1);
    expect("stormcellar_queue_files", R"({state="waiting"})", 4);
    expect("stormcellar_event_overflows_total", "", 1);
    expect("stormcellar_files_total", R"({result="gridded"})", 3);
    expect("stormcellar_partial_volumes_total", "", 1);
    expect("stormcellar_rejected_files_total", R"({reason="corrupt"})", 1);
    expect("stormcellar_store_failures_total", R"({reason="no_space"})", 1);
    expect("stormcellar_close_to_cache_seconds", R"({quantile="0.5"})", 0.2);
    expect("stormcellar_close_to_cache_seconds", R"({quantile="1"})", 0.4);
    expect("stormcellar_antenna_to_cache_seconds", R"({quantile="0.95"})", 20);
    expect("stormcellar_living_grids_total", "", 1);
    expect("stormcellar_close_to_living_seconds", R"({quantile="0.95"})", 0.6);
    expect("stormcellar_station_living_grids_total", R"({station="KTLX"})", 1);
    expect("stormcellar_station_close_to_living_seconds", R"({quantile="1",station="KTLX"})", 0.6);
    expect("stormcellar_cache_bytes", "", 1000);
    expect("stormcellar_cache_budget_bytes", "", 5000);
    expect("stormcellar_cache_evicted_grids_total", "", 3);
    expect("stormcellar_stations", "", 2);
    expect("stormcellar_last_data_age_seconds", "", 5);
    expect("stormcellar_station_last_volume_age_seconds", R"({station="KTLX"})", 20 * 60 - 522);
    expect("stormcellar_station_last_radial_age_seconds", R"({station="KTLX"})", 30);
    expect("stormcellar_station_last_ingest_age_seconds", R"({station="KTLX"})", 10);
    expect("stormcellar_station_last_data_age_seconds", R"({station="KOUN"})", 5);
    expect("stormcellar_station_files_total", R"({result="rejected",station="KOUN"})", 1);
    expect("stormcellar_station_missing_chunks_total", R"({station="KTLX"})", 2);
    expect("stormcellar_station_antenna_to_cache_seconds", R"({quantile="0.5",station="KTLX"})",
           20);
    expect("stormcellar_loop_made_total", R"({loop="a"})", 10);
    EXPECT_FALSE(
        read_metrics(text)
            .at("stormcellar_station_last_ingest_age_seconds")
            .samples.contains(R"(stormcellar_station_last_ingest_age_seconds{station="KOUN"})"));
}

// 2026-11-22: if no file had come since the start, no metric showed the silence.
TEST(Metrics, TheFeedsAgeCountsFromTheStartWhereNothingHasCome) {
    StatusBook book("/d", "/c");
    book.stations().add_known("KTLX", asked_at, asked_at);
    StatusFacts facts = book.facts();
    facts.started = asked_at - std::chrono::seconds{1000};
    EXPECT_DOUBLE_EQ(
        value_of(metrics_text(facts, {}, asked_at), "stormcellar_last_data_age_seconds",
                 "stormcellar_last_data_age_seconds"),
        1000);
}

// Every line must be valid and the number of series limited, whatever files claim.
TEST(Metrics, StayWholeWhateverFilesClaim) {
    StatusBook book("/d", "/c");
    for (int i = 0; i < 2000; ++i)
        book.add(finished("K\n\"\\" + std::to_string(i), IngestResult::gridded, 1), asked_at);
    const auto families = read_metrics(metrics_text(book.facts(), {}, asked_at));
    EXPECT_EQ(families.at("stormcellar_station_last_ingest_age_seconds").samples.size(), 512U);
    EXPECT_EQ(families.at("stormcellar_stations_left_out_total")
                  .samples.at("stormcellar_stations_left_out_total"),
              2000 - 512);
}

}  // namespace
}  // namespace stormcellar::daemon
