#include "web/doors/raw/volumes.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
#include "web/doors/pictures/link_list.h"
#include "web/doors/raw/raw_answers.h"

namespace stormcellar::web {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t usual_limit = 1000, highest_limit = 10'000;

Result<RawRange> range_of_query(const Request& request) {
    RawRange range;
    // A program that follows links never asks for another list, so its list is longer.
    range.most = request.prefers_html() ? highest_limit : usual_limit;
    range.newest_first = true;
    range.with_sizes = true;
    const UtcTime now = now_utc();
    for (const auto& [name, bound] : {std::pair{"from", &range.from}, std::pair{"to", &range.to}}) {
        const auto text = request.parameter(name);
        if (!text) continue;
        const auto time = time_of_parameter(*text, now);
        if (!time) return fail(ErrorCode::bad_argument, "{}: {}", name, time.error().message);
        *bound = *time;
    }
    if (const auto text = request.parameter("limit")) {
        const auto limit = parse_number<decltype(range.most)>(*text);
        if (!limit || *limit < 1 || *limit > highest_limit)
            return fail(ErrorCode::bad_argument, "limit: give a number from 1 to {}",
                        highest_limit);
        range.most = *limit;
    }
    return range;
}

ordered_json json_of_volume(const RawVolume& volume, const std::string& base) {
    return {{"name", volume.name},
            {"start", format_utc(volume.start)},
            {"size_bytes", volume.size_bytes},
            {"modified", format_utc(volume.modified)},
            {"complete", volume.is_complete},
            {"growing", volume.grows},
            {"href", base + "/volumes/" + volume.station + "/" + volume.name}};
}

}  // namespace

std::optional<Answer> VolumesDoor::answer_at_once(const Request& request) {
    return named_volume_at_once(request, *files_);
}

Answer VolumesDoor::answer(const Request& request) {
    const auto segments = segments_of(request.path);
    const bool is_folder = request.path.ends_with('/');
    if (segments.size() < 3 && !is_folder) return moved_to(request, request.path + "/");
    if (segments.size() == 1) return stations_answer(request);
    if (segments.size() == 2) return list_answer(request, segments[1]);
    if (segments.size() > 3 || is_folder) return sentence(404, "There is no such volume.");
    return volume_answer(request, *files_, segments[1], segments[2]);
}

Answer VolumesDoor::stations_answer(const Request& request) const {
    const auto stations = files_->stations();
    if (!stations) return json_error(stations.error());
    ordered_json list = ordered_json::array();
    for (const RawStation& station : *stations) {
        ordered_json one = {{"station", station.icao}};
        if (station.has_place) {
            one["name"] = station.name;
            one["state"] = station.state;
            one["latitude_deg"] = station.latitude_deg;
            one["longitude_deg"] = station.longitude_deg;
            one["altitude_m"] = station.altitude_m;
        }
        list.push_back(std::move(one));
    }
    return list_answer_to(request, ordered_json{{"stations", std::move(list)}}.dump() + "\n", [&] {
        LinkList page{"Stations", {}};
        for (const RawStation& station : *stations)
            page.links.push_back({station.icao + "/", station.icao + "/", {}, {}});
        return page;
    });
}

Answer VolumesDoor::list_answer(const Request& request, std::string_view station) const {
    auto range = range_of_query(request);
    if (!range) return json_error(range.error());
    const std::size_t limit = range->most;
    range->most = limit + 1;
    auto volumes = files_->list(station, *range);
    if (!volumes) return json_error(volumes.error());
    if (volumes->empty()) {
        const auto stations = files_->stations();
        if (!stations) return json_error(stations.error());
        const bool is_known = std::ranges::any_of(
            *stations, [&](const RawStation& one) { return one.icao == station; });
        if (!is_known) return json_error(404, "there are no volumes of this station");
    }
    const bool is_cut = volumes->size() > limit;
    if (is_cut) volumes->resize(limit);
    ordered_json list = ordered_json::array();
    for (const RawVolume& volume : *volumes)
        list.push_back(json_of_volume(volume, request.base));
    const ordered_json document{
        {"station", station}, {"is_cut", is_cut}, {"volumes", std::move(list)}};
    return list_answer_to(request, document.dump() + "\n", [&] {
        LinkList page{fmt::format("Volumes of {}", station), {}};
        for (const RawVolume& volume : *volumes)
            page.links.push_back({volume.name, volume.name, volume.size_bytes, volume.modified});
        return page;
    });
}

}  // namespace stormcellar::web
