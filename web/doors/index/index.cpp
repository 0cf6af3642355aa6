#include "web/doors/index/index.h"

#include <algorithm>
#include <functional>
#include <map>

#include "stormcellar/base/station_table.h"
#include "web/data/grids/text_answer.h"

namespace stormcellar::web {
namespace {

std::string place_of(const std::string& icao) {
    const auto station = find_station(icao);
    if (!station) return {};
    std::string place(station->name);
    if (!station->state.empty()) place += ", " + std::string(station->state);
    return place;
}

// Returns the moments of a domain, and its newest grid of any moment.
IndexDomain domain_facts(const Grids& grids, const std::string& name) {
    IndexDomain domain{name, {}, std::nullopt};
    for (const level2::Moment moment : grids.moments(name)) {
        const auto newest = grids.newest(name, moment);
        if (!newest) continue;
        domain.moments.emplace_back(level2::moment_name(moment));
        domain.newest = std::max(domain.newest.value_or(*newest), *newest);
    }
    return domain;
}

Answer style_answer(const Request& request) {
    return text_answer_to(request, "text/css; charset=utf-8", std::string(index_style()));
}

}  // namespace

IndexFacts IndexDoor::facts(const Request& request) const {
    IndexFacts facts;
    facts.now = now_utc();
    facts.base = request.base;
    facts.doors = options_.doors;
    facts.bucket = options_.bucket;
    std::map<std::string, IndexStation> stations;
    if (options_.feed) {
        for (const StationNews::Page& page : options_.feed->stations()) {
            IndexStation& station = stations[page.station];
            station.newest_volume = page.newest_volume;
            station.heard = page.heard;
            station.is_silent = page.is_silent;
        }
    }
    if (options_.grids) {
        for (const std::string& name : options_.grids->domains()) {
            if (cache::is_part(name)) continue;
            IndexDomain domain = domain_facts(*options_.grids, name);
            if (domain.moments.empty()) continue;
            if (!is_icao(name)) {
                facts.domains.push_back(std::move(domain));
                continue;
            }
            stations[name].newest_grid = domain.newest;
            stations[name].moments = std::move(domain.moments);
        }
    }
    for (auto& [icao, station] : stations) {
        facts.is_cut = facts.stations.size() == options_.most_stations;
        if (facts.is_cut) break;
        station.icao = icao;
        station.place = place_of(icao);
        facts.stations.push_back(std::move(station));
    }
    return facts;
}

std::optional<Answer> IndexDoor::answer_at_once(const Request& request) {
    if (request.path == "/index.css") return style_answer(request);
    if (request.path != "/") return sentence(404, "There is nothing at this address.");
    return std::nullopt;
}

Answer IndexDoor::answer(const Request& request) {
    if (auto quick = answer_at_once(request)) return *std::move(quick);
    return text_answer_to(request, "text/html; charset=utf-8", index_html(facts(request)));
}

}  // namespace stormcellar::web
