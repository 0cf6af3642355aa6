#include "bench/table.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/utsname.h>
#include <unistd.h>

#include "bench/measure.h"
#include "stormcellar/base/version.h"

namespace stormcellar::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        const auto colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    return "unknown";
}

Json machine() {
    utsname system{};
    const bool known = ::uname(&system) == 0;
    double load = -1;
    std::ifstream("/proc/loadavg") >> load;
    const double memory_bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                                static_cast<double>(::sysconf(_SC_PAGESIZE));
    return {
        {"processor", processor()},
        {"cores", std::thread::hardware_concurrency()},
        {"memory_mib", std::lround(memory_bytes / mebibyte)},
        {"system", known ? fmt::format("{} {} {}", system.sysname, system.release, system.machine)
                         : "unknown"},
        {"compiler", __VERSION__},
        {"stormcellar", software_version},
        {"load_1_minute", load},
        {"date",
         fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(
                                                  std::chrono::system_clock::now())))}};
}

bool same_keys(const Row& a, const Row& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& one, const auto& other) { return one.first == other.first; });
}

template <class Get>
void print_line(const Row& row, Get get) {
    std::string line;
    for (const auto& entry : row)
        line += (line.empty() ? "" : "\t") + get(entry);
    fmt::print("{}\n", line);
}

}  // namespace

Cell::Cell(double number, int places)
    : text_(std::isfinite(number) ? fmt::format("{:.{}f}", number, places) : "-"),
      is_number_(true) {}

void Table::add(Row row) {
    if (!json_) {
        if (rows_.empty() || !same_keys(rows_.back(), row)) {
            if (!rows_.empty()) fmt::print("\n");
            print_line(row, [](const auto& entry) { return entry.first; });
        }
        print_line(row, [](const auto& entry) { return entry.second.text(); });
        std::fflush(stdout);
    }
    rows_.push_back(std::move(row));
}

void Table::finish() const {
    if (!json_) return;
    Json rows = Json::array();
    for (const Row& row : rows_) {
        Json object = Json::object();
        for (const auto& [key, cell] : row) {
            if (!cell.is_number()) {
                object[key] = cell.text();
            } else {
                // the number as the table shows it
                object[key] = cell.text() == "-" ? Json() : Json::parse(cell.text());
            }
        }
        rows.push_back(std::move(object));
    }
    fmt::print("{}\n", Json{{"machine", machine()}, {"rows", rows}}.dump(2));
}

}  // namespace stormcellar::bench
