#include "tests/fault/hostile_cases.h"

#include <chrono>
#include <cstdio>
#include <set>
#include <sstream>

#include "tests/daemon/write_file.h"
#include "tests/fault/hostile_watch.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

std::string configuration(const More& more) {
    return "[watch]\nrescan_seconds = 2\n" + more.watch + "[cache]\npercent = 0\n" + more.cache +
           "[ingest]\nquiet_seconds = " + std::to_string(more.quiet_s) +
           "\nreread_seconds = 0.05\nworkers = 2\nspacing_km = 10\n"
           "extent_km = [200, 200]\nlevels_km = [1, 3, 6]\n" +
           more.ingest + "[log]\nlevel = \"debug\"\n" + more.rest;
}

std::string_view text_of(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

double HostileCases::start(const More& more) {
    return start_until_ready(daemon_, configuration(more));
}

void HostileCases::put(const fs::path& name, const Bytes& bytes) {
    const fs::path path = daemon_.drop() / name;
    fs::create_directories(path.parent_path());
    const fs::path hidden = path.parent_path() / ("." + path.filename().native());
    daemon::write_file(hidden, text_of(bytes));
    fs::rename(hidden, path);
}

void HostileCases::append(const fs::path& name, const Bytes& bytes) {
    daemon::append_to_file(daemon_.drop() / name, text_of(bytes));
}

UtcTime HostileCases::put_good(const std::string& station, int plus_s, unsigned gates) {
    const UtcTime time = std::chrono::floor<seconds>(now_utc()) + seconds{plus_s};
    Claims claims = claims_of(station, time);
    claims.sweeps = 2;
    claims.gates = gates;
    claims.is_varied = true;
    put(station + format_compact(time), volume_bytes(claims));
    return time;
}

double HostileCases::expect_gridded(const std::string& station, UtcTime time, double most_s) {
    const auto begin = std::chrono::steady_clock::now();
    const bool came =
        comes_true(most_s, [&] { return has_whole_grid(daemon_.cache(), station, time); });
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_TRUE(came) << station << " has no grid after " << took.count() << " s\n" << log_end();
    if (came) std::printf("%s was gridded after %.2f s\n", station.c_str(), took.count());
    return took.count();
}

void HostileCases::expect_no_invented_database() {
    const auto databases = databases_in(daemon_.catalog());
    EXPECT_EQ(invented_among(databases), std::set<std::string>{});
    EXPECT_TRUE(databases.contains("KTLX"));
    EXPECT_TRUE(databases.contains("_unknown"));
}

bool HostileCases::rests(double most_s) {
    return comes_to_rest(daemon_, most_s);
}

std::string HostileCases::not_rejected(const std::vector<fs::path>& names) const {
    const auto rows = catalog_rows(daemon_.catalog());
    std::string missing;
    for (const fs::path& name : names) {
        const auto [begin, end] = rows.equal_range(daemon_.drop() / name);
        const bool is_rejected = std::distance(begin, end) == 1 &&
                                 begin->second.state == "rejected" && !begin->second.reason.empty();
        if (!is_rejected)
            missing +=
                name.native() + (begin == end ? ": no row\n" : ": " + begin->second.state + "\n");
    }
    return missing.substr(0, 500);
}

std::size_t HostileCases::lines_with(const std::string& text, const std::string& severity) const {
    std::istringstream log(daemon_.log());
    std::size_t lines = 0;
    for (std::string line; std::getline(log, line);) {
        const bool counts = severity.empty() || line.find(" " + severity + ": ") < 30;
        lines += counts && line.find(text) != std::string::npos ? 1 : 0;
    }
    return lines;
}

std::size_t HostileCases::complaints_about(const std::string& text) const {
    return lines_with(text, "error") + lines_with(text, "warning");
}

std::string HostileCases::log_end() const {
    const std::string log = daemon_.log();
    return log.size() > 2500 ? log.substr(log.size() - 2500) : log;
}

Bytes small_claim(const std::string& station, std::size_t number) {
    Claims claims;
    claims.station = station;
    claims.time = nexrad_from_time(now_utc() - std::chrono::hours{1});
    claims.time.milliseconds += static_cast<std::uint32_t>(number);
    claims.radials = 4;
    claims.gates = 20;
    return volume_bytes(claims);
}

}  // namespace stormcellar::fault
