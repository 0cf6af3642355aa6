#include "web/doors/raw/polling.h"

#include <algorithm>

#include "web/data/grids/text_answer.h"
#include "web/doors/raw/raw_answers.h"

namespace stormcellar::web {
namespace {

Answer polled_text(const Request& request, std::string text) {
    return text_answer_to(request, "text/plain; charset=utf-8", std::move(text));
}

}  // namespace

std::optional<Answer> PollingDoor::answer_at_once(const Request& request) {
    return named_volume_at_once(request, *files_);
}

Answer PollingDoor::answer(const Request& request) {
    const auto segments = segments_of(request.path);
    if (request.path.ends_with('/') || segments.size() < 2 || segments.size() > 3) {
        return sentence(404, "There are config.cfg, grlevel2.cfg and STATION/dir.list here.");
    }
    if (segments.size() == 2) {
        if (segments[1] == "config.cfg" || segments[1] == "grlevel2.cfg")
            return configuration(request);
        return sentence(404, "There are config.cfg and grlevel2.cfg here.");
    }
    if (segments[2] == "dir.list") return list_of(request, segments[1]);
    return volume_answer(request, *files_, segments[1], segments[2]);
}

Answer PollingDoor::configuration(const Request& request) const {
    const auto stations = files_->stations();
    if (!stations) return sentence(status_of(stations.error()), "The catalog cannot be read now.");
    std::string text = "ListFile: dir.list\n";
    for (const RawStation& station : *stations)
        text += fmt::format("Site: {}\n", station.icao);
    return polled_text(request, std::move(text));
}

Answer PollingDoor::list_of(const Request& request, std::string_view station) const {
    RawRange newest;
    newest.to = now_utc() + tolerated_future;
    newest.most = options_.most_listed;
    newest.newest_first = true;
    newest.with_sizes = true;
    auto volumes = files_->list(station, newest);
    if (!volumes) return sentence(status_of(volumes.error()), "The catalog cannot be read now.");
    if (volumes->empty()) {
        const auto stations = files_->stations();
        const bool is_known = stations && std::ranges::any_of(*stations, [&](const auto& one) {
                                  return one.icao == station;
                              });
        if (!is_known) return sentence(404, "There are no volumes of this station.");
    }
    std::ranges::reverse(*volumes);
    std::string text;
    for (const RawVolume& volume : *volumes)
        text += fmt::format("{} {}\n", volume.size_bytes, volume.name);
    return polled_text(request, std::move(text));
}

}  // namespace stormcellar::web
