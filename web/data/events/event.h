// web/data/events/event.h -- numbered events, which say what happens in the cache and in the
// catalog.
//
// Threads   Plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/moment.h"
#include "web/http/answer.h"

namespace stormcellar::web {

enum class EventType : std::uint8_t {
    volume_begun,     // the first part of a volume appeared in the catalog or in the cache
    sweep_gridded,    // a site's grid was made from a growing volume with a new sweep
    volume_complete,  // a site's grid was made from a volume that has ended
    mosaic,           // a grid of a configured domain was made, or made again
    cells,            // the storm cells of a new grid of reflectivity were found
    grid_evicted,     // grids of a domain and moment are gone
    station_silent,   // nothing came from a station for some time
    station_spoke,    // something came from a station that was silent
    reset,            // events were lost; clients must request their lists again
};

struct EventTypeFacts {
    EventType type;
    std::string_view name;  // in the stream, in JSON and in the filter
};
inline constexpr auto event_types = std::to_array<EventTypeFacts>({
    {EventType::volume_begun, "volume_begun"},
    {EventType::sweep_gridded, "sweep_gridded"},
    {EventType::volume_complete, "volume_complete"},
    {EventType::mosaic, "mosaic"},
    {EventType::cells, "cells"},
    {EventType::grid_evicted, "grid_evicted"},
    {EventType::station_silent, "station_silent"},
    {EventType::station_spoke, "station_spoke"},
    {EventType::reset, "reset"},
});
[[nodiscard]] constexpr std::string_view event_name(EventType type) {
    return event_types[static_cast<std::size_t>(type)].name;
}
[[nodiscard]] std::optional<EventType> event_type_from_name(std::string_view name);

struct Event {
    EventType type = EventType::reset;
    std::string station;  // ICAO; empty: not about a single station
    std::string domain;   // of the grid; for an event of a station, the station's own
    std::optional<level2::Moment> moment;
    std::string json;  // one object on one line
};

// Selects the events that a client wants. An event fits if it is about one of the filter's stations
// or domains, or if the filter names neither. If the filter names moments or types, these must fit,
// too. An event without a moment fits every list of moments, so that a client that wants only REF
// hears of silent stations. A reset fits every filter.
struct EventFilter {
    std::vector<std::string> stations = {}, domains = {};
    std::vector<level2::Moment> moments = {};
    std::vector<EventType> types = {};
    [[nodiscard]] bool fits(const Event& event) const;
};

// The last event that a client has: the run of the server that sent it, and its number in that run.
struct EventId {
    std::string run;
    std::uint64_t number = 0;
};
// Reads an id such as "5f3a09c1-1024", the form in the `id` line. Returns none for any other text.
[[nodiscard]] std::optional<EventId> parse_event_id(std::string_view text);
[[nodiscard]] std::string event_id_text(std::string_view run, std::uint64_t number);

// Returns the lines that send an event in the stream, with the empty line at the end.
[[nodiscard]] std::string event_frame(const Event& event, std::string_view run,
                                      std::uint64_t number);
// Returns the event that tells clients that events were lost, with the reason.
[[nodiscard]] Event reset_event(std::string_view reason);

}  // namespace stormcellar::web
