#include "web/data/events/event.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace stormcellar::web {
namespace {

constexpr bool names_stand_in_order() {
    for (std::size_t i = 0; i < event_types.size(); ++i)
        if (event_types[i].type != static_cast<EventType>(i)) return false;
    return true;
}
static_assert(names_stand_in_order());

template <class Values, class Value>
bool has_value(const Values& values, const Value& value) {
    return std::find(values.begin(), values.end(), value) != values.end();
}

// Returns true for 1 to 32 hexadecimal letters and digits.
bool is_run(std::string_view text) {
    return !text.empty() && text.size() <= 32 &&
           text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

std::optional<EventType> event_type_from_name(std::string_view name) {
    for (const EventTypeFacts& facts : event_types)
        if (facts.name == name) return facts.type;
    return std::nullopt;
}

bool EventFilter::fits(const Event& event) const {
    if (event.type == EventType::reset) return true;
    const bool is_of_a_place = (stations.empty() && domains.empty()) ||
                               has_value(stations, event.station) ||
                               has_value(domains, event.domain);
    return is_of_a_place && (types.empty() || has_value(types, event.type)) &&
           (moments.empty() || !event.moment || has_value(moments, *event.moment));
}

std::optional<EventId> parse_event_id(std::string_view text) {
    const std::size_t dash = text.find('-');
    if (dash == std::string_view::npos || !is_run(text.substr(0, dash))) return std::nullopt;
    EventId id{std::string(text.substr(0, dash)), 0};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + dash + 1, end, id.number);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return id;
}

std::string event_id_text(std::string_view run, std::uint64_t number) {
    return fmt::format("{}-{}", run, number);
}

std::string event_frame(const Event& event, std::string_view run, std::uint64_t number) {
    return fmt::format("id: {}-{}\nevent: {}\ndata: {}\n\n", run, number, event_name(event.type),
                       event.json);
}

Event reset_event(std::string_view reason) {
    Event event;
    event.type = EventType::reset;
    event.json = nlohmann::ordered_json{{"type", "reset"}, {"reason", reason}}.dump();
    return event;
}

}  // namespace stormcellar::web
