// Tests the options of every benchmark, and the rows that it prints as a table and as JSON.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar {
namespace {

using testing::run_program;
namespace fs = std::filesystem;

fs::path bench(const std::string& name) {
    return fs::path(BENCH_DIRECTORY) / name;
}
std::string smallest_volume() {
    return *testing::data_directory() / "volumes/KIWX20160429_194300_V06.gz";
}
std::set<std::string> keys_of(const nlohmann::json& row) {
    std::set<std::string> keys;
    for (const auto& [key, value] : row.items())
        keys.insert(key);
    return keys;
}

std::vector<std::string> all_programs() {
    std::istringstream words(BENCH_PROGRAMS);
    return {std::istream_iterator<std::string>(words), {}};
}

class EachBenchmark : public ::testing::TestWithParam<std::string> {};

TEST_P(EachBenchmark, SaysItsUsage) {
    const auto said = run_program(bench(GetParam()), {"--help"});
    EXPECT_EQ(said.status, 0);
    EXPECT_NE(said.out.find("--threads N"), std::string::npos);
}

TEST_P(EachBenchmark, RefusesWhatItDoesNotKnow) {
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"--jsn"},
                                               {"--threads"},
                                               {"--threads", "0"},
                                               {"--threads", "two"},
                                               {"--runs", "-1"}}) {
        const auto said = run_program(bench(GetParam()), words);
        EXPECT_EQ(said.status, 2) << words.front();
        EXPECT_NE(said.err.find("usage:"), std::string::npos);
        EXPECT_EQ(said.out, "");
    }
}

TEST_P(EachBenchmark, SaysThatADirectoryIsMissing) {
    const auto said = run_program(bench(GetParam()), {"--data", "/no/such/directory"});
    EXPECT_EQ(said.status, 2);
    EXPECT_NE(said.err.find("/no/such/directory"), std::string::npos) << said.err;
}

INSTANTIATE_TEST_SUITE_P(All, EachBenchmark, ::testing::ValuesIn(all_programs()),
                         [](const auto& program) { return program.param; });

TEST(Benchmark, WithoutVolumesThereIsNothingToMeasure) {
    const testing::TemporaryDirectory empty;
    EXPECT_EQ(run_program(bench("bench_grid"), {"--data", empty.path().string()}).status, 3);
    EXPECT_EQ(run_program(bench("bench_plan"), {"--data", empty.path().string()}).status, 3);
}

TEST(BenchGrid, JsonHasARowForEachSpecAndNumberOfThreads) {
    STORMCELLAR_NEED_DATA();
    const auto said =
        run_program(bench("bench_grid"), {"--json", "--runs", "1", smallest_volume()});
    ASSERT_EQ(said.status, 0) << said.err;
    const auto document = nlohmann::json::parse(said.out);
    EXPECT_EQ(keys_of(document), (std::set<std::string>{"machine", "rows"}));
    EXPECT_GE(document["machine"]["cores"], 1);
    ASSERT_EQ(document["rows"].size(), 6U);
    for (const auto& row : document["rows"]) {
        const auto keys = keys_of(row);
        for (const char* key : {"file", "spec", "threads", "first_grid_s", "grid_s", "whole_s",
                                "libbz2_s", "ratio", "peak_mib"}) {
            EXPECT_TRUE(keys.contains(key)) << key;
        }
        EXPECT_EQ(row["file"], "KIWX20160429_194300_V06.gz");
        EXPECT_GT(row["grid_s"], 0.0);
        EXPECT_GT(row["peak_mib"], 1.0);
    }
}

TEST(BenchGrid, TheTableHasTheKeysOfTheJson) {
    STORMCELLAR_NEED_DATA();
    const std::vector<std::string> words = {"--threads", "1", "--runs", "1", smallest_volume()};
    const auto text = run_program(bench("bench_grid"), words);
    std::vector<std::string> with_json = words;
    with_json.emplace_back("--json");
    const auto json = run_program(bench("bench_grid"), with_json);
    ASSERT_EQ(text.status, 0) << text.err;
    ASSERT_EQ(json.status, 0) << json.err;
    EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 4);
    const auto rows = nlohmann::ordered_json::parse(json.out)["rows"];
    ASSERT_EQ(rows.size(), 3U);
    std::string head;
    for (const auto& [key, value] : rows[0].items())
        head += (head.empty() ? "" : "\t") + key;
    EXPECT_EQ(text.out.substr(0, text.out.find('\n')), head);
    EXPECT_EQ(rows[0]["threads"], 1);
}

// bench_kernels is built only with Google Benchmark. The program ends with status 1 if a way of
// unpacking gives other bytes than libbz2.
TEST(BenchKernels, RowsAreRatiosToLibbz2) {
    STORMCELLAR_NEED_DATA();
    if (!fs::exists(bench("bench_kernels"))) GTEST_SKIP() << "bench_kernels was not built";
    const std::string file =
        *testing::data_directory() / "volumes/example_nexrad_archive_msg31_compressed.ar2v";
    const auto said =
        run_program(bench("bench_kernels"), {"--json", "--threads", "1", "--runs", "2", file});
    ASSERT_EQ(said.status, 0) << said.err;
    const auto rows = nlohmann::json::parse(said.out)["rows"];
    ASSERT_GE(rows.size(), 5U);
    EXPECT_EQ(keys_of(rows[0]), (std::set<std::string>{"group", "way", "ms", "ratio"}));
    EXPECT_EQ(rows[0]["way"], "libbz2");
    EXPECT_EQ(rows[0]["ratio"], 1.0);
    EXPECT_EQ(rows.back()["way"], "decode, threads 1");
    for (const auto& row : rows) {
        EXPECT_EQ(row["group"], rows[0]["group"]);
        EXPECT_GT(row["ms"], 0.0);
    }
    EXPECT_EQ(run_program(bench("bench_kernels"), {"--benchmark_filter=nothing", file}).status, 3);
    EXPECT_EQ(run_program(bench("bench_kernels"), {"--benchmark_fliter=x", file}).status, 2);
}

// The benchmark makes the frames of one site and one hour twice: by tasks, and in one process.
TEST(BenchMosaic, TasksMakeTheFramesOfAnHourBesideOneProcess) {
    STORMCELLAR_NEED_DATA();
    EXPECT_EQ(run_program(bench("bench_mosaic"), {"--batch", "condor"}).status, 2);
    EXPECT_EQ(run_program(bench("bench_mosaic"), {"--only", "101"}).status, 2);
    const testing::TemporaryDirectory work;
    const auto said = run_program(
        bench("bench_mosaic"),
        {"--json", "--batch", "local", "--threads", "2", "--runs", "1", "--only", "1", "--hours",
         "1", "--data", testing::data_directory()->string(), "--work", work.path().string()});
    ASSERT_EQ(said.status, 0) << said.err;
    const auto rows = nlohmann::json::parse(said.out)["rows"];
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0]["frames"], 10) << "a batch makes no frames after the last volume";
    EXPECT_EQ(rows[0]["tasks"], 3) << "a station's day and two hours of frames";
    EXPECT_GT(rows[0]["ratio"], 0.0);
    EXPECT_NE(said.err.find(", 12 frames"), std::string::npos) << said.err;
}

// The output of a run with one site and two threads has the keys of the paper's table.
TEST(BenchMosaic, RowsHaveTheKeysOfTheTable) {
    STORMCELLAR_NEED_DATA();
    EXPECT_EQ(run_program(bench("bench_mosaic"), {"--work"}).status, 2);
    for (const char* hours : {"0", "6", "few"})
        EXPECT_EQ(run_program(bench("bench_mosaic"), {"--hours", hours}).status, 2) << hours;
    const testing::TemporaryDirectory work;
    const auto said =
        run_program(bench("bench_mosaic"),
                    {"--json", "--threads", "2", "--only", "1", "--hours", "1", "--data",
                     testing::data_directory()->string(), "--work", work.path().string()});
    ASSERT_EQ(said.status, 0) << said.err;
    const auto rows = nlohmann::json::parse(said.out)["rows"];
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(keys_of(rows[0]),
              (std::set<std::string>{"sites", "threads", "total_s", "libbz2_s", "ratio",
                                     "expansion", "raw_gb", "peak_mib", "paper_min"}));
    EXPECT_GT(rows[0]["total_s"], 0.0);
    EXPECT_GT(rows[0]["expansion"], 1.0);
    EXPECT_TRUE(rows[0]["paper_min"].is_null());
    EXPECT_FALSE(rows[0]["ratio"].is_null());
    const auto alone =
        run_program(bench("bench_mosaic"),
                    {"--json", "--threads", "2", "--only", "1", "--hours", "1", "--alone", "--data",
                     testing::data_directory()->string(), "--work", work.path().string()});
    ASSERT_EQ(alone.status, 0) << alone.err;
    const auto row = nlohmann::json::parse(alone.out)["rows"][0];
    EXPECT_TRUE(row["libbz2_s"].is_null() && row["ratio"].is_null());
    EXPECT_EQ(row["raw_gb"], rows[0]["raw_gb"]);
    // Merged volumes are removed, raw volumes are kept.
    for (const auto& entry : fs::directory_iterator(work.path()))
        EXPECT_EQ(entry.path().filename(), "feed");
}

}  // namespace
}  // namespace stormcellar
