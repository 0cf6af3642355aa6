#include "web/doors/thredds/query.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "base/parse_number.h"
#include "base/printable.h"
#include "web/doors/thredds/w3c_times.h"

namespace stormcellar::web {
namespace {

// Returns the values of a parameter, each once. The parameter may be repeated and may hold lists.
// If a value has a slash, only the part before the slash counts.
std::vector<std::string> values_of(const Request& request, std::string_view name) {
    std::vector<std::string> values;
    std::unordered_set<std::string> seen;
    for (std::string_view list : request.parameters(name)) {
        while (!list.empty()) {
            const std::size_t end = std::min(list.find(','), list.size());
            std::string value{list.substr(0, std::min(end, list.find('/')))};
            list.remove_prefix(std::min(end + 1, list.size()));
            if (!value.empty() && seen.insert(value).second) values.push_back(std::move(value));
        }
    }
    return values;
}

// Returns the parameter. An empty value counts as absent, because the IDV's forms send empty
// values.
std::optional<std::string_view> given(const Request& request, std::string_view name) {
    const auto value = request.parameter(name);
    return value && !value->empty() ? value : std::nullopt;
}

Result<double> degrees_of(std::string_view name, std::string_view text, double most) {
    if (text.starts_with('+') || text.starts_with(' ')) text.remove_prefix(1);
    const auto value = parse_number<double>(text);
    if (value && std::isfinite(*value) && std::abs(*value) <= most) return *value;
    return fail(ErrorCode::bad_argument, "{} must be a number of degrees from -{} to {}.", name,
                most, most);
}

// Reads these parameters. Returns no values if none is given. Fails if only some are given.
Result<std::vector<double>> read_degrees(const Request& request,
                                         const std::vector<std::string_view>& names) {
    std::vector<double> values;
    for (const std::string_view name : names) {
        const auto text = given(request, name);
        if (!text) continue;
        const bool is_latitude = name == "latitude" || name == "north" || name == "south";
        const auto value = degrees_of(name, *text, is_latitude ? 90 : 360);
        if (!value) return pass_on(value);
        values.push_back(*value);
    }
    if (values.empty() || values.size() == names.size()) return values;
    return fail(ErrorCode::bad_argument, "Give all of {}.", fmt::join(names, ", "));
}

Status read_places(const Request& request, ThreddsQuery& query) {
    query.stations = values_of(request, "stn");
    if (query.stations.size() > most_query_stations) {
        return fail(ErrorCode::bad_argument, "A query may name at most {} stations.",
                    most_query_stations);
    }
    query.all_stations = std::ranges::count(query.stations, "all") > 0;
    if (query.all_stations) query.stations.clear();
    const auto point = read_degrees(request, {"latitude", "longitude"});
    if (!point) return pass_on(point);
    if (!point->empty()) query.near = {point->at(0), point->at(1)};
    const auto box = read_degrees(request, {"north", "south", "east", "west"});
    if (!box) return pass_on(box);
    if (!box->empty()) {
        query.box = {box->at(0), box->at(1), box->at(2), box->at(3)};
        if (query.box->north_deg < query.box->south_deg)
            return fail(ErrorCode::bad_argument, "north must not be less than south.");
    }
    // Names take precedence over a box, and a box over a point, as in the THREDDS server.
    if (!query.stations.empty() || query.all_stations) query.box.reset();
    if (!query.stations.empty() || query.all_stations || query.box) query.near.reset();
    if (!query.stations.empty() || query.all_stations || query.box || query.near) return {};
    return fail(ErrorCode::bad_argument,
                "One or more stations are required: stn=KTLX, or longitude and latitude, or north, "
                "south, east and west.");
}

Status read_lone_times(const Request& request, UtcTime now, ThreddsQuery& query) {
    for (const std::string& text : values_of(request, "time")) {
        const auto time = parse_w3c_time(text, now);
        if (!time) return pass_on(time);
        query.times.push_back(*time);
    }
    if (query.times.size() <= most_query_times) return {};
    return fail(ErrorCode::bad_argument, "A query may name at most {} times.", most_query_times);
}

Status read_range(const Request& request, UtcTime now, ThreddsQuery& query) {
    const auto start = given(request, "time_start"), end = given(request, "time_end"),
               length = given(request, "time_duration");
    std::optional<W3cDuration> duration;
    for (const auto& [text, bound] : {std::pair{start, &query.from}, std::pair{end, &query.to}}) {
        if (!text) continue;
        const auto time = parse_w3c_time(*text, now);
        if (!time) return pass_on(time);
        *bound = *time;
    }
    if (length) {
        const auto parsed = parse_w3c_duration(*length);
        if (!parsed) return pass_on(parsed);
        duration = *parsed;
    }
    if (start && !end && duration) query.to = later_by(*query.from, *duration);
    if (end && !start && duration) query.from = earlier_by(*query.to, *duration);
    if (!query.from || !query.to) {
        return fail(ErrorCode::bad_argument,
                    "A range of times takes two of time_start, time_end and time_duration.");
    }
    if (*query.from > *query.to)
        return fail(ErrorCode::bad_argument, "time_start must not be after time_end.");
    return {};
}

Status read_times(const Request& request, UtcTime now, ThreddsQuery& query) {
    const bool has_range = given(request, "time_start") || given(request, "time_end") ||
                           given(request, "time_duration");
    if (has_range) return read_range(request, now, query);
    if (given(request, "time")) return read_lone_times(request, now, query);
    if (given(request, "temporal") == "all") return {};
    return fail(ErrorCode::bad_argument,
                "A time is required: time=2022-03-17T00:08:00Z, or two of time_start, time_end and "
                "time_duration, or temporal=all.");
}

}  // namespace

Result<ThreddsQuery> read_thredds_query(const Request& request, UtcTime now) {
    ThreddsQuery query;
    if (Status read = read_places(request, query); !read) return pass_on(read);
    if (Status read = read_times(request, now, query); !read) return pass_on(read);
    query.variables = values_of(request, "var");
    return query;
}

bool is_inside(const ThreddsQuery::Box& box, double latitude_deg, double longitude_deg) {
    if (latitude_deg > box.north_deg || latitude_deg < box.south_deg) return false;
    const auto around = [](double degrees) {
        const double turned = std::fmod(degrees, 360.0);
        return turned < 0 ? turned + 360.0 : turned;
    };
    if (box.east_deg - box.west_deg >= 360) return true;
    return around(longitude_deg - box.west_deg) <= around(box.east_deg - box.west_deg);
}

}  // namespace stormcellar::web
