#include "batch/totals.h"

#include <algorithm>
#include <functional>

#include <nlohmann/json.hpp>

namespace stormcellar::batch {
namespace {

using Json = nlohmann::ordered_json;

// Calls the function with the name and the member of each total that is a plain sum of records.
template <class Visit>
void for_each_sum(const Visit& visit) {
    visit("grid_tasks", &Totals::grid_tasks);
    visit("frame_tasks", &Totals::frame_tasks);
    visit("statistics_tasks", &Totals::statistics_tasks);
    visit("files", &Totals::files);
    visit("left_out", &Totals::left_out);
    visit("grids", &Totals::grids);
    visit("frames", &Totals::frames);
    visit("cpu_s", &Totals::cpu_s);
    visit("cost_s", &Totals::cost_s);
    visit("bytes_read", &Totals::bytes_read);
    visit("bytes_written", &Totals::bytes_written);
}

void add_hours(const HourCounts& more, HourCounts& all) {
    std::ranges::transform(more, all, all.begin(), std::plus<>{});
}

void widen(std::optional<UtcTime> started, std::optional<UtcTime> ended, Totals& totals) {
    if (started && (!totals.started || *started < *totals.started)) totals.started = started;
    if (ended && (!totals.ended || *ended > *totals.ended)) totals.ended = ended;
}

}  // namespace

void add(const Record& record, double cost_s, Totals& totals) {
    if (record.kind == TaskKind::statistics) {
        ++totals.statistics_tasks;
    } else if (record.kind == TaskKind::frames) {
        ++totals.frame_tasks;
        totals.frames += record.grids;
    } else {
        ++totals.grid_tasks;
        totals.grids += record.grids;
        totals.files += record.files;
        StationHours& hours = totals.stations[record.station];
        add_hours(record.taken_by_hour, hours.taken);
        add_hours(record.left_out_by_hour, hours.left_out);
    }
    totals.left_out += record.left_out.size();
    if (!record.left_out.empty()) totals.with_left_out.push_back(record.number);
    totals.cpu_s += record.cpu_s;
    totals.cost_s += cost_s;
    totals.bytes_read += record.bytes_read;
    totals.bytes_written += record.bytes_written;
    totals.most_memory_bytes = std::max(totals.most_memory_bytes, record.memory_bytes);
    widen(record.started, record.ended, totals);
}

void add(const Totals& more, Totals& all) {
    for_each_sum([&](const char*, auto member) { all.*member += more.*member; });
    all.most_memory_bytes = std::max(all.most_memory_bytes, more.most_memory_bytes);
    widen(more.started, more.ended, all);
    for (const auto& [station, hours] : more.stations) {
        StationHours& known = all.stations[station];
        add_hours(hours.taken, known.taken);
        add_hours(hours.left_out, known.left_out);
    }
    all.with_left_out.insert(all.with_left_out.end(), more.with_left_out.begin(),
                             more.with_left_out.end());
}

Json json_of(const Totals& totals) {
    Json json;
    for_each_sum([&](const char* name, auto member) { json[name] = totals.*member; });
    json["most_memory_bytes"] = totals.most_memory_bytes;
    json["started"] = format_utc(*totals.started);
    json["ended"] = format_utc(*totals.ended);
    json["stations"] = Json::object();
    for (const auto& [station, hours] : totals.stations)
        json["stations"][station] = {{"taken", hours.taken}, {"left_out", hours.left_out}};
    json["with_left_out"] = totals.with_left_out;
    return json;
}

Totals totals_of(const Json& json) {
    Totals totals;
    for_each_sum([&](const char* name, auto member) { json.at(name).get_to(totals.*member); });
    json.at("most_memory_bytes").get_to(totals.most_memory_bytes);
    totals.started = parse_utc(json.at("started").get<std::string>(), {}).value();
    totals.ended = parse_utc(json.at("ended").get<std::string>(), {}).value();
    for (const auto& [station, hours] : json.at("stations").items()) {
        hours.at("taken").get_to(totals.stations[station].taken);
        hours.at("left_out").get_to(totals.stations[station].left_out);
    }
    json.at("with_left_out").get_to(totals.with_left_out);
    return totals;
}

}  // namespace stormcellar::batch
