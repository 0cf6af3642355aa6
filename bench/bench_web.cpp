// bench_web: what the data server serves a second, beside nginx with the same bytes.
//
// usage: bench_web [--data DIR] [--seconds N] [--clients "1 64"] [--json] [FILE ...]
//   (bench/request.h; one busy volume, unless files are named; 5 seconds a row)
// `stormcellar serve` and nginx run on one processor, wrk on another, by turns. There is a row for
// each thing that is asked for and number of clients:
//   what            what is asked for, and from whom
//   clients         connections that are kept open
//   requests_per_s  answers a second
//   mb_per_s        their bytes with headers
//   p50_ms, p99_ms  from the request to the end of the answer
//   cpu_cores       of the server
//   peak_mib        resident memory of the server since its start
//   failed          requests that got no answer or an error
//   of_nginx        requests_per_s divided by nginx's in the row before; "-" where nginx has none
// "first" rows have one client and one request of each kind: p50_ms is their median, p99_ms the
// longest of them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bench/web_load.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> gzip = {"Accept-Encoding: gzip"};

struct Asked {
    std::string what, path;
    std::vector<std::string> headers;
};

class WebBench {
  public:
    WebBench(WebServer ours, fs::path scratch, Table& table)
        : ours_(std::move(ours)), scratch_(std::move(scratch)), table_(table) {}

    // Asks once for each, and keeps the time of each.
    Status ask_first(const std::string& what, const std::vector<std::string>& paths,
                     const std::vector<std::string>& headers) {
        std::vector<double> times;
        for (const std::string& path : paths) {
            const auto fetched = get(ours_.address() + path, headers, scratch_);
            if (!fetched) return pass_on(fetched);
            if (fetched->status != 200)
                return fail(ErrorCode::internal, "{} answered {}", path, fetched->status);
            times.push_back(fetched->ms);
        }
        if (times.empty()) return {};
        std::sort(times.begin(), times.end());
        Load figures;
        figures.p50_ms = times[times.size() / 2];
        figures.p99_ms = times.back();
        figures.requests_per_s = figures.mb_per_s = figures.cpu_cores = none;
        add(what + ", first", 1, ours_, figures, none);
        return {};
    }

    // Loads nginx with the same bytes as a file, then us.
    Status compare(const Asked& asked, const std::vector<int>& clients, std::chrono::seconds time) {
        const auto fetched = get(ours_.address() + asked.path, asked.headers, scratch_);
        if (!fetched) return pass_on(fetched);
        if (fetched->status != 200)
            return fail(ErrorCode::internal, "{} answered {}", asked.path, fetched->status);
        const fs::path files = scratch_ / "files";
        fs::create_directories(files);
        std::ofstream(files / "same", std::ios::binary) << fetched->body;
        auto nginx = serve_with_nginx(files, scratch_);
        if (!nginx) return pass_on(nginx);
        for (const int count : clients) {
            const auto theirs = load(*nginx, "/same", asked.headers, count, time, scratch_);
            if (!theirs) return pass_on(theirs);
            add(asked.what + ", nginx", count, *nginx, *theirs, none);
            const auto figures = load(ours_, asked.path, asked.headers, count, time, scratch_);
            if (!figures) return pass_on(figures);
            add(asked.what, count, ours_, *figures,
                figures->requests_per_s / theirs->requests_per_s);
        }
        return {};
    }

    Result<nlohmann::json> json_of(const std::string& path) {
        const auto fetched = get(ours_.address() + path, {}, scratch_);
        if (!fetched) return pass_on(fetched);
        auto parsed = nlohmann::json::parse(fetched->body, nullptr, false);
        if (fetched->status != 200 || parsed.is_discarded())
            return fail(ErrorCode::internal, "{} answered {}", path, fetched->status);
        return parsed;
    }

  private:
    void add(const std::string& what, int clients, const WebServer& server, const Load& figures,
             double of_nginx) {
        table_.add({{"what", what},
                    {"clients", clients},
                    {"requests_per_s", Cell{figures.requests_per_s, 0}},
                    {"mb_per_s", Cell{figures.mb_per_s, 1}},
                    {"p50_ms", Cell{figures.p50_ms, 2}},
                    {"p99_ms", Cell{figures.p99_ms, 2}},
                    {"cpu_cores", Cell{figures.cpu_cores, 2}},
                    {"peak_mib", Cell{server.process.peak_mib(), 0}},
                    {"failed", static_cast<int>(figures.failed)},
                    {"of_nginx", Cell{of_nginx, 2}}});
    }

    WebServer ours_;
    fs::path scratch_;
    Table& table_;
};

// The grids of the server, as "/api/v1/grids/DOMAIN/MOMENT/TIME".
Result<std::vector<std::string>> paths_of_grids(WebBench& bench) {
    const auto listed = bench.json_of("/api/v1/grids");
    if (!listed) return pass_on(listed);
    std::vector<std::string> paths;
    for (const auto& grid : (*listed)["grids"]) {
        paths.push_back(fmt::format("/api/v1/grids/{}/{}/{}", grid["domain"].get<std::string>(),
                                    grid["moment"].get<std::string>(),
                                    grid["time"].get<std::string>()));
    }
    return paths;
}

std::vector<std::string> paths_of_volumes(const std::vector<fs::path>& files) {
    std::vector<std::string> paths;
    for (const fs::path& file : files) {
        const std::string name = file.filename();
        paths.push_back(fmt::format("/volumes/{}/{}", name.substr(0, 4), name));
    }
    return paths;
}

Status measure(WebBench& bench, const std::vector<fs::path>& files, const std::vector<int>& clients,
               std::chrono::seconds time) {
    const auto grids = paths_of_grids(bench);
    if (!grids) return pass_on(grids);
    std::vector<std::string> packed;
    for (const std::string& path : *grids)
        packed.push_back(path + "/packed");
    if (Status first = bench.ask_first("packed grid, gzip", packed, gzip); !first) return first;
    if (Status first = bench.ask_first("packed grid, plain", packed, {}); !first) return first;
    const auto volumes = paths_of_volumes(files);
    const auto reflectivity = std::find_if(packed.begin(), packed.end(), [](const auto& path) {
        return path.find("/REF/") != std::string::npos;
    });
    if (reflectivity == packed.end())
        return fail(ErrorCode::not_found, "no grid of reflectivity could be made of the files");
    const std::vector<Asked> kept = {
        {"packed grid, gzip", *reflectivity, gzip},
        {"packed grid, plain", *reflectivity, {}},
        {"raw volume", volumes.front(), {}},
        {"list of stations", "/api/v1/stations", {}},
    };
    for (const Asked& asked : kept)
        if (Status compared = bench.compare(asked, clients, time); !compared) return compared;
    return {};
}

std::vector<int> numbers_in(const std::string& text) {
    std::istringstream words(text);
    std::vector<int> numbers;
    for (int number = 0; words >> number;)
        numbers.push_back(number);
    return numbers;
}

std::vector<fs::path> files_of(const Request& request) {
    if (!request.files.empty()) return request.files;
    for (const fs::path& file : request.volumes()) {
        if (file.filename().native().starts_with("KLBB2016")) return {file};
    }
    return {};
}

int run(const Request& request) {
    const auto files = files_of(request);
    if (files.empty()) {
        fmt::print(stderr, "bench_web: there are no volumes; name one, or set STORMCELLAR_DATA\n");
        return 3;
    }
    std::string pattern = (fs::temp_directory_path() / "bench_web.XXXXXX").native();
    if (::mkdtemp(pattern.data()) == nullptr) return 1;
    const fs::path scratch = pattern;
    const std::chrono::seconds time{std::stoi(request.value("--seconds").value_or("5"))};
    const auto clients = numbers_in(request.value("--clients").value_or("1 64"));
    Table table(request.json);
    Status status = {};
    {
        auto ours = serve_files(files, scratch);
        if (!ours) {
            status = pass_on(ours);
        } else {
            WebBench bench(std::move(*ours), scratch, table);
            status = measure(bench, files, clients, time);
        }
    }
    table.finish();
    if (!status) {
        fmt::print(stderr, "bench_web: {}\n", status.error().message);
        return 1;
    }
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    namespace bench = stormcellar::bench;
    const bench::Program program{.name = "bench_web",
                                 .files = "[FILE ...]",
                                 .purpose =
                                     "what the data server serves a second, beside nginx; "
                                     "--seconds N, --clients \"1 64\"",
                                 .values = {"--seconds", "--clients"}};
    const auto read = bench::read_request(program, std::span(argv, static_cast<std::size_t>(argc)));
    return read.request ? bench::run(*read.request) : read.status;
}
