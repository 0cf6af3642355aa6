// Operations on stations and their raw volumes.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "stormcellar/base/station_table.h"
#include "web/data/events/event_feed.h"
#include "web/data/events/station_place.h"
#include "web/data/raw/raw_files.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

ApiJson age_json(UtcTime time, UtcTime now) {
    return std::floor(seconds_between(time, now));
}

// Returns the time of the newest volume or grid, and its age; JSON null if there is none.
ApiJson newest_json(std::optional<UtcTime> time, UtcTime now) {
    if (!time) return nullptr;
    return {{"time", format_utc(*time)}, {"age_s", age_json(*time, now)}};
}

ApiJson station_place_json(const ApiCall& call, const std::string& icao) {
    ApiJson json{{"station", icao}};
    const auto station = place_of_station(call.state.sources().grids.get(), icao);
    if (!station) return json;
    if (!station->name.empty()) json["name"] = station->name;
    if (!station->state.empty()) json["state"] = station->state;
    if (station->kind) json["kind"] = station->kind == RadarKind::nexrad ? "nexrad" : "tdwr";
    json["latitude_deg"] = station->latitude_deg;
    json["longitude_deg"] = station->longitude_deg;
    json["antenna_altitude_m"] = station->antenna_altitude_m;
    return json;
}

using Catalog = decltype(std::declval<ApiState>().catalog());

// Returns the stations that have volumes or grids of their own. If `known`, returns all known
// stations.
std::set<std::string> station_names(const ApiCall& call, const Catalog& catalog, bool known) {
    std::set<std::string> names;
    if (catalog) {
        if (const auto stations = (*catalog)->station_names()) {
            std::copy_if(stations->begin(), stations->end(), std::inserter(names, names.end()),
                         [](const std::string& name) { return !name.empty(); });
        }
    }
    if (call.state.sources().grids) {
        for (const std::string& domain : call.grids().domains()) {
            if (is_icao(domain)) names.insert(domain);
        }
    }
    if (known) {
        for (const Station& station : all_stations())
            names.emplace(station.icao);
    }
    return names;
}

// Returns, for each silent station, how many seconds ago something came from it last.
std::map<std::string, double> silences_s(const ApiCall& call, UtcTime now) {
    std::map<std::string, double> silences;
    const auto& feed = call.state.sources().feed;
    if (!feed) return silences;
    for (const StationNews::Page& page : feed->stations()) {
        if (page.is_silent && page.spoke())
            silences[page.station] = std::floor(seconds_between(*page.spoke(), now));
    }
    return silences;
}

// Returns JSON null if the station has no volume, and none if its database cannot be read now.
std::optional<ApiJson> newest_volume_json(const Catalog& catalog, const std::string& icao,
                                          UtcTime now) {
    const auto of_failure = [](const Error& error) {
        return error.code == ErrorCode::not_found ? std::optional{ApiJson()} : std::nullopt;
    };
    if (!catalog) return of_failure(catalog.error());
    const auto latest = (*catalog)->latest(icao);
    if (!latest) return of_failure(latest.error());
    return *latest ? newest_json((*latest)->volume.start_time, now) : ApiJson();
}

ApiJson station_json(const ApiCall& call, const Catalog& catalog, const std::string& icao,
                     UtcTime now) {
    ApiJson json = station_place_json(call, icao);
    if (auto volume = newest_volume_json(catalog, icao, now))
        json["newest_volume"] = std::move(*volume);
    std::optional<UtcTime> newest;
    ApiJson moments = ApiJson::array();
    if (call.state.sources().grids) {
        for (const level2::Moment moment : call.grids().moments(icao)) {
            const auto time = call.grids().newest(icao, moment);
            if (!time) continue;
            newest = newest ? std::max(*newest, *time) : *time;
            moments.push_back(level2::moment_name(moment));
        }
    }
    json["newest_grid"] = newest_json(newest, now);
    json["moments"] = moments;
    return json;
}

}  // namespace

Answer api_stations(const ApiCall& call) {
    const auto known = whole_parameter(call, "known", 0, 1, 0);
    if (!known) return json_error(known.error());
    const auto catalog = call.state.catalog();
    std::set<std::string> names = station_names(call, catalog, *known == 1);
    if (const auto one = call.request.parameter("station")) {
        const auto icao = icao_of(*one);
        if (!icao) return json_error(400, "station: four letters or digits, like KTLX");
        std::erase_if(names, [&](const std::string& name) { return name != *icao; });
    }
    const UtcTime now = now_utc();
    const auto silences = silences_s(call, now);
    ApiJson list = ApiJson::array();
    for (const std::string& name : names) {
        ApiJson& station = list.emplace_back(station_json(call, catalog, name, now));
        const auto silence = silences.find(name);
        const bool is_known = station.contains("newest_volume");
        if (!is_known) continue;
        station["silent_s"] = silence == silences.end() ? ApiJson() : ApiJson(silence->second);
    }
    return json_answer(call.request, {{"time", format_utc(now)}, {"stations", list}});
}

Answer api_volumes(const ApiCall& call) {
    const auto range = range_parameters(call);
    if (!range) return json_error(range.error());
    const auto icao = icao_of(call.path_value("station"));
    if (!icao) return json_error(404, "there is no such station");
    const auto catalog = call.state.catalog();
    if (!catalog) return json_error(catalog.error());
    const std::size_t count = range->limit;
    // Request one entry more than wanted, to see whether there are more.
    const auto entries = (*catalog)->list(*icao, {range->from, range->to, false, count + 1});
    if (!entries) return json_error(entries.error());
    const std::size_t skipped = entries->size() > count ? entries->size() - count : 0;
    ApiJson list = ApiJson::array();
    for (std::size_t i = skipped; i < entries->size(); ++i) {
        const catalog::CatalogEntry& entry = (*entries)[i];
        const catalog::VolumeFacts& volume = entry.volume;
        const auto time_json = [](std::optional<UtcTime> time) {
            return time ? ApiJson(format_utc(*time)) : ApiJson();
        };
        const auto raw =
            call.state.sources().gives_volumes ? given_name(entry) : std::optional<std::string>{};
        list.push_back({{"name", entry.path.filename().string()},
                        {"raw", raw ? ApiJson(*raw) : ApiJson()},
                        {"number_in_file", entry.number_in_file},
                        {"time", time_json(volume.start_time)},
                        {"end_time", time_json(volume.end_time)},
                        {"state", catalog::file_state_name(entry.state)},
                        {"bytes", entry.size_bytes},
                        {"vcp", volume.vcp ? ApiJson(*volume.vcp) : ApiJson()},
                        {"sweeps", volume.sweep_count},
                        {"complete", volume.complete},
                        {"generation", entry.generation}});
    }
    return json_answer(call.request,
                       {{"station", *icao}, {"volumes", list}, {"more", skipped > 0}});
}

}  // namespace stormcellar::web
