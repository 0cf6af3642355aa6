// bench_web_archive: how fast the data server starts over a large archive, and finds things in it.
//
// usage: bench_web_archive [--stations 10] [--rows 100000] [--grids 100000] [--runs 5]
//                          [--requests 300] [--work DIR] [--json]
//   (bench/request.h; --rows are those of a station's catalog, --grids all of the cache)
// It makes a catalog and a cache (bench/made_archive.h) in --work, where they stay and are used
// again, or in a temporary directory. Then it starts `stormcellar serve` and stormcellar-web --runs
// times each, and one client asks the latter --requests times for each thing, one request after
// another, each for another station and time. A row has:
//   what        what was started or asked for
//   count       how often
//   first_ms    the first time
//   p50_ms, p99_ms, longest_ms
//               of a start: from before fork() until it listens (`stormcellar serve` says so, of
//               stormcellar-web it is the first connection); of a request: until the last byte of
//               the answer, and with the connecting where the server closes after each answer, as
//               the THREDDS radar server does
//   kib         mean size of an answer
//   peak_mib    resident memory of the server, so far
//   reach_ms    the aim, of p50_ms; "-" where none is set
// All files are in the page cache, since they were just written.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/kept_client.h"
#include "bench/made_archive.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bench/web_load.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double no_reach = std::numeric_limits<double>::quiet_NaN();
constexpr double kibibyte = 1024;
constexpr double start_reach_ms = 1000, lone_time_reach_ms = 5, day_reach_ms = 10;

// What is asked for: a path for each number of a request.
struct AskedList {
    std::string what;
    std::function<std::string(std::size_t)> path;
    double reach_ms = no_reach;
};

void add_row(Table& table, const std::string& what, const std::vector<double>& times_ms, double kib,
             double peak_mib, double reach_ms) {
    table.add({{"what", what},
               {"count", static_cast<int>(times_ms.size())},
               {"first_ms", Cell{times_ms.front(), 2}},
               {"p50_ms", Cell{quantile(times_ms, 0.5), 2}},
               {"p99_ms", Cell{quantile(times_ms, 0.99), 2}},
               {"longest_ms", Cell{quantile(times_ms, 1), 2}},
               {"kib", Cell{kib, 1}},
               {"peak_mib", Cell{peak_mib, 0}},
               {"reach_ms", Cell{reach_ms, 0}}});
}

// The stations and times of an archive by the number of a request, scattered over all of it.
class ScatteredTimes {
  public:
    ScatteredTimes(const MadeArchive& archive, std::size_t volumes)
        : archive_(archive), volumes_(volumes) {}
    [[nodiscard]] const std::string& station(std::size_t i) const {
        return archive_.stations()[i % archive_.stations().size()];
    }
    [[nodiscard]] UtcTime time(std::size_t i) const {
        constexpr std::size_t scatter = 2'654'435'761;
        return archive_.start_of(i * scatter % volumes_);
    }
    [[nodiscard]] UtcTime day(std::size_t i) const {
        return std::chrono::floor<std::chrono::days>(time(i));
    }
    // "2024-07-05"
    [[nodiscard]] std::string date(std::size_t i) const { return format_utc(day(i)).substr(0, 10); }
    // "2024/07/05/"
    [[nodiscard]] std::string key_of_day(std::size_t i) const {
        std::string key = date(i) + '/';
        std::ranges::replace(key, '-', '/');
        return key;
    }
    // The grids are those of the newest volumes.
    [[nodiscard]] std::string date_of_grids(std::size_t i) const {
        const std::size_t back = i * 97 % archive_.grids_of_a_moment();
        return format_utc(archive_.start_of(volumes_ - 1 - back)).substr(0, 10);
    }

  private:
    const MadeArchive& archive_;
    std::size_t volumes_;
};

std::vector<AskedList> lists_of_volumes(const ScatteredTimes& times) {
    const std::string thredds = "/thredds/radarServer/nexrad/level2/IDD";
    const std::string s3 = "/s3/unidata-nexrad-level2?list-type=2";
    return {
        {"THREDDS, one time",
         [=](std::size_t i) {
             const UtcTime near = times.time(i) + std::chrono::seconds{71};
             return fmt::format("{}?stn={}&time={}", thredds, times.station(i), format_utc(near));
         },
         lone_time_reach_ms},
        {"THREDDS, a day's list",
         [=](std::size_t i) {
             return fmt::format("{0}?stn={1}&time_start={2}T00:00:00Z&time_end={2}T23:59:59Z",
                                thredds, times.station(i), times.date(i));
         },
         day_reach_ms},
        {"THREDDS, dataset.xml", [=](std::size_t) { return thredds + "/dataset.xml"; }},
        {"S3, a day of a station",
         [=](std::size_t i) {
             return fmt::format("{}&prefix={}{}/", s3, times.key_of_day(i), times.station(i));
         },
         day_reach_ms},
        {"S3, stations of a day",
         [=](std::size_t i) {
             return fmt::format("{}&delimiter=/&prefix={}", s3, times.key_of_day(i));
         },
         day_reach_ms},
        {"S3, years", [=](std::size_t) { return s3 + "&delimiter=/"; }},
        {"S3, months",
         [=](std::size_t i) {
             return fmt::format("{}&delimiter=/&prefix={}", s3, times.key_of_day(i).substr(0, 5));
         }},
        {"dir.list",
         [=](std::size_t i) { return fmt::format("/nexrd2/{}/dir.list", times.station(i)); }},
        {"list of a station's volumes",
         [=](std::size_t i) { return fmt::format("/volumes/{}/", times.station(i)); }},
        {"API, volumes, newest",
         [=](std::size_t i) {
             return fmt::format("/api/v1/stations/{}/volumes", times.station(i));
         }},
        {"API, volumes of a day",
         [=](std::size_t i) {
             return fmt::format(
                 "/api/v1/stations/{0}/volumes?from={1}T00:00:00Z&"
                 "to={1}T23:59:59Z&limit=1000",
                 times.station(i), times.date(i));
         }},
    };
}

// One request for each day, of which the server has seen none, and then again.
std::vector<AskedList> lists_of_chunks(const MadeArchive& archive) {
    const auto path = [&archive](std::size_t i) {
        std::string key = format_utc(archive.start_of(0) + std::chrono::days{i}).substr(0, 10);
        std::ranges::replace(key, '-', '/');
        return fmt::format("/s3/unidata-nexrad-level2?list-type=2&prefix={}/{}/", key,
                           archive.station_of_chunks());
    };
    return {{"S3, a day of chunks, first", path, day_reach_ms},
            {"S3, a day of chunks, again", path, day_reach_ms}};
}

std::vector<AskedList> lists_of_the_rest(const ScatteredTimes& times) {
    return {
        {"API, stations", [](std::size_t) { return "/api/v1/stations"; }},
        {"API, domains", [](std::size_t) { return "/api/v1/domains"; }},
        {"API, grids of a day, one moment",
         [=](std::size_t i) {
             return fmt::format(
                 "/api/v1/grids?domain={0}&moment=REF&from={1}T00:00:00Z&"
                 "to={1}T23:59:59Z&limit=1000",
                 times.station(i), times.date_of_grids(i));
         }},
        {"API, grids of a day, all",
         [=](std::size_t i) {
             return fmt::format("/api/v1/grids?from={0}T00:00:00Z&to={0}T23:59:59Z&limit=10000",
                                times.date_of_grids(i));
         }},
        {"API, newest grids", [](std::size_t) { return "/api/v1/grids"; }},
        {"index page", [](std::size_t) { return "/"; }},
    };
}

Status measure_list(const AskedList& asked, std::size_t count, KeptClient& client,
                    const WebServer& server, Table& table) {
    std::vector<double> times_ms;
    double bytes = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string path = asked.path(i);
        const auto answer = client.get(path);
        if (!answer) return pass_on(answer);
        if (answer->status != 200)
            return fail(ErrorCode::internal, "{} answered {}: {}", path, answer->status,
                        answer->body);
        times_ms.push_back(answer->ms);
        bytes += static_cast<double>(answer->body.size());
    }
    add_row(table, asked.what, times_ms, bytes / kibibyte / static_cast<double>(count),
            server.process.peak_mib(), asked.reach_ms);
    return {};
}

// Starts a server several times. Returns the last, which still runs.
using Start = std::function<Result<WebServer>()>;
Result<WebServer> measure_starts(const std::string& what, int runs, const Start& start,
                                 Table& table) {
    std::vector<double> times_ms;
    for (int run = 0;; ++run) {
        auto server = Result<WebServer>{fail(ErrorCode::internal, "not started")};
        times_ms.push_back(1000 * seconds_of([&] { server = start(); }));
        if (!server) return server;
        if (run + 1 < runs) {
            (void)server->process.stop();
            continue;
        }
        add_row(table, what, times_ms, no_reach, server->process.peak_mib(), start_reach_ms);
        return server;
    }
}

Status measure_archive(const MadeArchive& archive, std::size_t volumes, const Request& request,
                       const fs::path& directory, Table& table) {
    const auto count = static_cast<std::size_t>(
        std::max(1, std::atoi(request.value("--requests").value_or("300").c_str())));
    const int port = free_port();
    const fs::path configuration = directory / "stormcellard.toml";
    std::ofstream(configuration) << fmt::format(
        "[paths]\ndrop = \"{0}/drop\"\nstate = \"{0}/state\"\ncache = \"{0}/cache\"\n"
        "[web]\nlisten = [\"127.0.0.1:{1}\"]\n",
        directory.native(), port);
    {
        auto own = measure_starts(
            "stormcellar serve, start", request.runs,
            [&] { return serve_archive(archive.catalog(), archive.cache(), directory); }, table);
        if (!own) return pass_on(own);
    }
    auto server = measure_starts(
        "stormcellar-web, start", request.runs,
        [&] { return serve_configured(configuration, port, directory); }, table);
    if (!server) return pass_on(server);
    constexpr std::size_t volumes_of_a_day = 288;
    const std::size_t days = archive.volumes_of_chunks() / volumes_of_a_day;
    for (const AskedList& asked : lists_of_chunks(archive)) {
        KeptClient client(server->port);
        if (days == 0) break;
        if (Status measured = measure_list(asked, days, client, *server, table); !measured)
            return measured;
    }
    const ScatteredTimes times(archive, volumes);
    for (const auto& lists : {lists_of_volumes(times), lists_of_the_rest(times)}) {
        for (const AskedList& asked : lists) {
            KeptClient client(server->port);
            if (Status measured = measure_list(asked, count, client, *server, table); !measured)
                return measured;
        }
    }
    return {};
}

std::size_t number_of(const Request& request, std::string_view option, std::size_t usual) {
    const auto text = request.value(option);
    return text ? static_cast<std::size_t>(std::max(0, std::atoi(text->c_str()))) : usual;
}

int run(const Request& request) {
    ArchiveSize size;
    size.stations = number_of(request, "--stations", size.stations);
    size.volumes_of_a_station = number_of(request, "--rows", size.volumes_of_a_station);
    size.grids = number_of(request, "--grids", size.grids);
    if (size.stations < 1 || size.stations > 100 || size.volumes_of_a_station < 1 ||
        size.grids < 2 * size.stations) {
        fmt::print(stderr,
                   "bench_web_archive: --stations 1 to 100, --rows at least 1, --grids at least 2 "
                   "for each station\n");
        return 2;
    }
    std::string pattern = (fs::temp_directory_path() / "bench_web_archive.XXXXXX").native();
    const auto work = request.value("--work");
    if (!work && ::mkdtemp(pattern.data()) == nullptr) return 1;
    const fs::path directory = fs::absolute(work.value_or(pattern));
    std::error_code ignored;
    fs::create_directories(directory, ignored);
    Table table(request.json);
    const auto archive = MadeArchive::make(directory, size);
    const Status status =
        archive ? measure_archive(*archive, size.volumes_of_a_station, request, directory, table)
                : pass_on(archive);
    table.finish();
    if (!work) fs::remove_all(directory, ignored);
    if (status) return 0;
    fmt::print(stderr, "bench_web_archive: {}\n", status.error().message);
    return status.error().code == ErrorCode::not_found ? 3 : 1;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    namespace bench = stormcellar::bench;
    const bench::Program program{
        .name = "bench_web_archive",
        .files = "",
        .purpose =
            "how fast the data server starts over a large archive, and lists it;\n"
            "--stations N, --rows N, --grids N, --requests N, --work DIR",
        .values = {"--stations", "--rows", "--grids", "--requests", "--work"}};
    const auto read = bench::read_request(program, std::span(argv, static_cast<std::size_t>(argc)));
    return read.request ? bench::run(*read.request) : read.status;
}
