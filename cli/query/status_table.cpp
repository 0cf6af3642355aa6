#include "cli/query/status_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/byte_size.h"
#include "cli/shared/commands.h"
#include "cli/shared/short_duration.h"

namespace stormcellar::cli {
namespace {

using nlohmann::json;

constexpr std::size_t most_rejected_shown = 10;

// Returns the member of the object, or null if it is missing.
const json& at(const json& object, const char* key) {
    static const json nothing;
    if (!object.is_object()) return nothing;
    const auto found = object.find(key);
    return found == object.end() ? nothing : *found;
}

std::optional<double> number(const json& object, const char* key) {
    const json& value = at(object, key);
    if (!value.is_number()) return std::nullopt;
    return value.get<double>();
}

std::uint64_t count(const json& object, const char* key) {
    const json& value = at(object, key);
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
}

std::string text(const json& object, const char* key) {
    const json& value = at(object, key);
    return value.is_string() ? printable(value.get<std::string>()) : "-";
}

std::optional<double> age(const json& object, const char* key, UtcTime now) {
    const json& value = at(object, key);
    if (!value.is_string()) return std::nullopt;
    const auto time = parse_utc(value.get<std::string>(), now);
    if (!time) return std::nullopt;
    return std::chrono::duration<double>(now - *time).count();
}

std::string counted(std::uint64_t number_of, std::string_view thing) {
    return fmt::format("{} {}", number_of, plural(number_of, thing));
}

std::string size_of(const json& object, const char* key) {
    return format_byte_size(count(object, key));
}

// Returns a text such as "p50 85 ms, p95 120 ms, max 0.2 s".
std::string summary(const json& latency) {
    return fmt::format("p50 {}, p95 {}, max {}", short_duration(number(latency, "median")),
                       short_duration(number(latency, "p95")),
                       short_duration(number(latency, "max")));
}

std::string heading(const json& status, UtcTime now, Paint paint) {
    std::string state = text(status, "state");
    if (state != "running") state = in_red(state, paint);
    return fmt::format("stormcellard {} (process {}): {}, started {}, {} ago\n",
                       text(status, "version"), count(status, "pid"), state,
                       text(status, "started"), short_duration(age(status, "started", now)));
}

std::string drop_line(const json& status, Paint paint) {
    const std::uint64_t directories = count(status, "directories");
    const bool is_lost = at(status, "drop_lost").is_string();
    return fmt::format("drop     {}: {} {}{}\n", text(status, "drop"), directories,
                       directories == 1 ? "directory" : "directories",
                       is_lost ? "; " + in_red("LOST: " + text(status, "drop_lost"), paint) : "");
}

std::string unreadable_lines(const json& status, Paint paint) {
    const json& unreadable = at(status, "unreadable");
    const json& directories = at(unreadable, "directories");
    if (!directories.is_array()) return {};
    std::string lines;
    for (const json& one : directories) {
        lines += "unread   " +
                 in_red(fmt::format("{}: {}", text(one, "directory"), text(one, "reason")), paint) +
                 "\n";
    }
    if (const auto all = count(unreadable, "count"); all > directories.size())
        lines += fmt::format("unread   and {} more\n", all - directories.size());
    return lines;
}

std::string cache_line(const json& status) {
    const json& rolling = at(status, "rolling");
    std::string line = "cache    " + text(status, "cache");
    if (!rolling.is_object()) return line + "\n";
    const auto budget = number(rolling, "budget_bytes");
    line += fmt::format(": {}, {}", counted(count(rolling, "grids"), "grid"),
                        size_of(rolling, "bytes"));
    if (budget && *budget > 0) {
        line += fmt::format(" of {} ({:.0f} %)", size_of(rolling, "budget_bytes"),
                            100 * number(rolling, "bytes").value_or(0) / *budget);
    }
    return line + fmt::format(", {} pinned; {} evicted ({})\n", count(rolling, "pinned"),
                              count(rolling, "evicted"), size_of(rolling, "evicted_bytes"));
}

// Returns a text such as "3 rejected (2 corrupt, 1 empty)".
std::string with_kinds(const json& status, const char* key, const char* by, Paint paint) {
    std::string line = fmt::format("{} {}", count(status, key), key);
    const json& kinds = at(status, by);
    if (count(status, key) == 0) paint = Paint::plain;
    if (!kinds.is_object() || kinds.empty()) return in_yellow(line, paint);
    std::vector<std::string> each;
    for (const auto& [name, value] : kinds.items())
        each.push_back(fmt::format(
            "{} {}", value.is_number_unsigned() ? value.get<std::uint64_t>() : 0, printable(name)));
    return in_yellow(line + fmt::format(" ({})", fmt::join(each, ", ")), paint);
}

// Returns a text about how long the next pending file must still wait, or an empty text if the wait
// is short.
std::string wait_of(const json& pending) {
    const double wait_s = number(pending, "longest_wait_s").value_or(0);
    return wait_s < 1 ? std::string{} : fmt::format(" (for up to {:.0f} s)", wait_s);
}

// Returns a text with the number of files that are retried, or an empty text if there are none.
std::string retrying_of(const json& pending, Paint paint) {
    const auto retrying = count(pending, "retrying");
    if (retrying == 0) return {};
    return ", " + in_yellow(fmt::format("{} to be tried again", retrying), paint);
}

std::string lone_chunks_line(const json& status) {
    const auto files = count(status, "lone_chunks");
    if (files == 0) return {};
    return fmt::format(
        "chunks   {} {} like one chunk of a volume; chunks are joined only if their names hold "
        "YYYYMMDD-HHMMSS-NUMBER-KIND or LDM's key\n",
        counted(files, "file"), files == 1 ? "looks" : "look");
}

std::string not_kept_of(const json& status) {
    const auto files = count(status, "not_kept");
    return files == 0 ? std::string{}
                      : fmt::format(", {} not kept because of the cache's limits", files);
}

std::string counts_lines(const json& status, Paint paint) {
    const json& pending = at(status, "pending");
    std::string lines = fmt::format(
        "queue    {} waiting{}, {} running, {} growing{}; {} of the kernel's event queue, {}\n",
        count(pending, "waiting"), wait_of(pending), count(pending, "running"),
        count(pending, "growing"), retrying_of(pending, paint),
        counted(count(status, "overflows"), "overflow"), counted(count(status, "scans"), "scan"));
    for (const json& file : at(pending, "waiting_files")) {
        lines += fmt::format(
            "waits    {}: its volume has not ended; it is gridded with what it has in {:.0f} s, "
            "unless more comes\n",
            text(file, "file"), number(file, "left_s").value_or(0));
    }
    lines += fmt::format(
        "files    {} gridded ({} partial){}, {}, {} with nothing to grid, {}\n",
        count(status, "ingested"), count(status, "partial"), not_kept_of(status),
        with_kinds(status, "rejected", "rejected_by", paint),
        count(status, "no_moment") + count(status, "no_position") + count(status, "other_station"),
        with_kinds(status, "failures", "failures_by", paint));
    lines += lone_chunks_line(status);
    const json& latency = at(status, "latency_s");
    lines += fmt::format("close to cache    {} ({})\n", summary(latency),
                         counted(count(latency, "count"), "file"));
    const json& sweeps = at(status, "sweep_latency_s");
    lines += fmt::format("close to sweep    {} ({})\n", summary(sweeps),
                         counted(count(status, "living_grids"), "living grid"));
    const json& antenna = at(status, "antenna_to_cache_s");
    lines += fmt::format("antenna to cache  {} ({}", summary(antenna),
                         counted(count(antenna, "count"), "volume"));
    if (const std::uint64_t old = count(antenna, "not_live"); old > 0)
        lines += fmt::format("; {} more were over an hour old", old);
    return lines + ")\n";
}

using Row = std::vector<std::string>;

// Pads the cells of a column to its widest cell. The first column is aligned left, all other
// columns right.
std::string aligned(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string lines;
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            lines += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                            : fmt::format("  {:>{}}", row[i], widths[i]);
        }
        lines += '\n';
    }
    return lines;
}

// Returns a text with the present values of the antenna. If there are none, returns the last
// values, marked as old.
std::string antenna_of(const json& antenna) {
    if (number(antenna, "median")) return short_duration(number(antenna, "median"));
    const auto last = number(antenna, "last");
    return last ? "old: " + short_duration(last) : "-";
}

std::vector<const json*> sorted_stations(const json& status) {
    std::vector<const json*> stations;
    const json& all = at(status, "stations");
    if (!all.is_array()) return stations;
    for (const json& station : all)
        stations.push_back(&station);
    std::stable_sort(stations.begin(), stations.end(), [](const json* a, const json* b) {
        return text(*a, "station") < text(*b, "station");
    });
    return stations;
}

std::string stations_table(const std::vector<const json*>& stations, UtcTime now) {
    if (stations.empty()) return "no station has data yet\n";
    std::vector<Row> rows = {{"station", "volume", "cached", "data", "p50", "p95", "max",
                              "sweep p50", "sweep p95", "sweep max", "antenna p50", "antenna p95",
                              "gridded", "partial", "rejected", "missing"}};
    for (const json* station : stations) {
        const json& latency = at(*station, "latency_s");
        const json& sweeps = at(*station, "sweep_latency_s");
        const json& antenna = at(*station, "antenna_to_cache_s");
        rows.push_back(
            {text(*station, "station"), short_duration(age(*station, "volume_time", now)),
             short_duration(age(*station, "ingested_at", now)),
             short_duration(age(*station, "data_at", now)),
             short_duration(number(latency, "median")), short_duration(number(latency, "p95")),
             short_duration(number(latency, "max")), short_duration(number(sweeps, "median")),
             short_duration(number(sweeps, "p95")), short_duration(number(sweeps, "max")),
             antenna_of(antenna), short_duration(number(antenna, "p95")),
             fmt::format("{}", count(*station, "gridded")),
             fmt::format("{}", count(*station, "partial")),
             fmt::format("{}", count(*station, "rejected")),
             fmt::format("{}", count(*station, "missing_chunks"))});
    }
    return aligned(rows);
}

std::string missing_lines(const std::vector<const json*>& stations, Paint paint) {
    std::string lines;
    for (const json* station : stations) {
        const json& missing = at(*station, "missing");
        if (!missing.is_array() || missing.empty()) continue;
        const json& last = missing.back();
        std::vector<std::string> numbers;
        const json& chunks = at(last, "numbers");
        for (const json& chunk : chunks.is_array() ? chunks : json::array())
            if (chunk.is_number_integer()) numbers.push_back(fmt::format("{}", chunk.get<int>()));
        const bool more = count(last, "count") > numbers.size();
        const std::string line =
            fmt::format("missing chunks of {}, volume {}: {}{}", text(*station, "station"),
                        text(last, "volume_time"), fmt::join(numbers, ", "), more ? ", ..." : "");
        lines += in_yellow(line, paint) + "\n";
    }
    return lines;
}

std::string rejected_lines(const json& status, Paint paint) {
    const json& files = at(status, "rejected_files");
    if (!files.is_array() || files.empty()) return "";
    const std::size_t shown = std::min(files.size(), most_rejected_shown);
    std::string lines = in_yellow("rejected last:", paint) + "\n";
    for (std::size_t i = files.size() - shown; i < files.size(); ++i) {
        lines += fmt::format("  {}  {}: {} ({})\n", text(files[i], "at"), text(files[i], "file"),
                             text(files[i], "by"), text(files[i], "reason"));
    }
    return lines;
}

// Returns a text such as "; run by process 17: running" if another process than the daemon runs the
// loops.
std::string loops_keeper(const json& status, Paint paint) {
    const json& service = at(status, "loops_service");
    if (!service.is_object()) {
        const json& elsewhere = at(at(status, "loops"), "elsewhere");
        const bool runs_nowhere = elsewhere.is_boolean() && elsewhere.get<bool>();
        return runs_nowhere ? "; " + in_red("no process runs them", paint) : "";
    }
    const json& alive = at(service, "alive");
    const bool is_alive = alive.is_boolean() && alive.get<bool>();
    if (text(service, "state") == "stopped" || is_alive) {
        return fmt::format("; run by process {}: {}", count(service, "pid"),
                           text(service, "state"));
    }
    return "; " +
           in_red(fmt::format("process {}, which ran them, is gone", count(service, "pid")), paint);
}

std::string loops_line(const json& status, Paint paint) {
    const json& loops = at(status, "loops");
    const json& each = at(loops, "each");
    if (!each.is_array() || each.empty()) return "";
    return fmt::format("loops    {} of {} running, {} made, {}{}\n", count(loops, "running"),
                       each.size(), count(loops, "made"),
                       counted(count(loops, "restarts"), "restart"), loops_keeper(status, paint));
}

std::string loops_table(const json& status, UtcTime now, Paint paint) {
    const json& each = at(at(status, "loops"), "each");
    if (!each.is_array() || each.empty()) return "";
    std::vector<Row> rows = {{"loop", "running", "last made", "frames", "made", "restarts"}};
    std::string problems;
    for (const json& loop : each) {
        const json& running = at(loop, "running");
        const bool runs = running.is_boolean() && running.get<bool>();
        rows.push_back(
            {text(loop, "name"), runs ? "yes" : "no", short_duration(age(loop, "last_made", now)),
             fmt::format("{}", count(loop, "frames")), fmt::format("{}", count(loop, "made")),
             fmt::format("{}", count(loop, "restarts"))});
        if (at(loop, "last_problem").is_string())
            problems +=
                in_red(fmt::format("loop {}: {}", text(loop, "name"), text(loop, "last_problem")),
                       paint) +
                "\n";
    }
    return "\n" + aligned(rows) + problems;
}

std::string machines_lines(const json& status, UtcTime now, Paint paint) {
    const json& machines = at(status, "machines");
    if (!machines.is_array() || machines.empty()) return "";
    std::vector<Row> rows = {{"machine", "volume", "arrived", "taken", "refused"}};
    std::string problems;
    for (const json& machine : machines) {
        rows.push_back({text(machine, "name"), short_duration(age(machine, "newest", now)),
                        short_duration(age(machine, "arrived", now)),
                        fmt::format("{}", count(machine, "taken")),
                        fmt::format("{}", count(machine, "refused"))});
        if (at(machine, "why").is_string()) {
            problems += in_red(fmt::format("machine {} is late: {}", text(machine, "name"),
                                           text(machine, "why")),
                               paint) +
                        "\n";
        }
        if (at(machine, "last_problem").is_string()) {
            problems += in_yellow(fmt::format("machine {}: {}", text(machine, "name"),
                                              text(machine, "last_problem")),
                                  paint) +
                        "\n";
        }
    }
    return "\n" + aligned(rows) + problems;
}

}  // namespace

std::string status_table(const json& status, UtcTime now, Paint paint) {
    const std::vector<const json*> stations = sorted_stations(status);
    std::string page = heading(status, now, paint);
    page += drop_line(status, paint);
    page += unreadable_lines(status, paint);
    page += cache_line(status) + counts_lines(status, paint) + loops_line(status, paint) + "\n";
    page += stations_table(stations, now);
    if (const std::uint64_t more = count(status, "stations_left_out"); more > 0)
        page += fmt::format("and {} of further stations, which the daemon does not list\n",
                            counted(more, "file"));
    return page + missing_lines(stations, paint) + rejected_lines(status, paint) +
           machines_lines(status, now, paint) + loops_table(status, now, paint);
}

}  // namespace stormcellar::cli
