#include "grid/frame/named_place.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/ranges.h>

#include "base/nearest_name.h"
#include "base/number_list.h"
#include "base/place_table.h"
#include "base/printable.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::grid {
namespace {

constexpr int large_town_thousands = 100;
constexpr std::size_t most_candidates = 12;

using Candidates = std::vector<NamedPlace>;

std::string_view without_outer_spaces(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0)
        text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0)
        text.remove_suffix(1);
    return text;
}

// The two parts of a text such as "Moore, OK", prepared for comparison. The region is empty if
// there is no comma.
struct Asked {
    std::string name, region;
};
Asked parts_of(std::string_view text) {
    const std::size_t comma = text.rfind(',');
    if (comma == std::string_view::npos) return {compared_name(text), {}};
    return {compared_name(text.substr(0, comma)), compared_name(text.substr(comma + 1))};
}

bool is_asked(const Asked& asked, std::string_view name, std::string_view region) {
    return compared_name(name) == asked.name &&
           (asked.region.empty() || compared_name(region) == asked.region);
}

Candidates towns_called(const Asked& asked) {
    Candidates found;
    for (const NamedPlace& place : all_places()) {
        if (is_asked(asked, place.name, place.region)) found.push_back(place);
    }
    if (found.size() < 2) return found;
    Candidates large;
    std::ranges::copy_if(found, std::back_inserter(large), [](const NamedPlace& place) {
        return place.population_thousands >= large_town_thousands;
    });
    return large.size() == 1 ? large : found;
}

Candidates radars_called(const Asked& asked) {
    Candidates found;
    for (const Station& station : all_stations()) {
        if (is_asked(asked, station.name, station.state))
            found.push_back(
                {station.icao, station.state, station.latitude_deg, station.longitude_deg, 0});
    }
    return found;
}

std::string full_name(const NamedPlace& place) {
    return fmt::format("{}, {}", place.name, place.region);
}

std::string list_of(const Candidates& found) {
    std::vector<std::string> names;
    for (const NamedPlace& place : found) {
        std::string name = full_name(place);
        // If several places have the same name and state, add their coordinates.
        if (std::ranges::count(found, place.region, &NamedPlace::region) > 1)
            name += fmt::format(" ({:.2f},{:.2f})", place.latitude_deg, place.longitude_deg);
        names.push_back(std::move(name));
    }
    std::string more;
    if (names.size() > most_candidates) {
        more = fmt::format(" and {} more", names.size() - most_candidates);
        names.resize(most_candidates);
    }
    return fmt::format("{}{}", fmt::join(names, "; "), more);
}

Error ambiguous(std::string_view text, const Candidates& found) {
    return {ErrorCode::bad_argument,
            fmt::format("'{}' may be {}; name one of them with its state, or give LAT,LON",
                        printable(text), list_of(found))};
}

Error unknown(std::string_view text, const Asked& asked) {
    const auto said = [&](const std::string& meant) {
        return Error{ErrorCode::bad_argument,
                     fmt::format("there is no place '{}'{}", printable(text), meant)};
    };
    // A town of this name elsewhere means that the state is wrong, or is not written with two
    // letters.
    if (!asked.region.empty()) {
        const Candidates elsewhere = towns_called({asked.name, {}});
        if (!elsewhere.empty()) return said("; there is " + list_of(elsewhere));
    }
    std::vector<std::string> names;
    // Suggest a similar name: first from the given state, and then from all states.
    for (const bool in_state : {true, false}) {
        if (in_state && asked.region.empty()) continue;
        names.clear();
        for (const NamedPlace& place : all_places()) {
            if (asked.region.empty()) {
                names.emplace_back(place.name);
            } else if (!in_state || compared_name(place.region) == asked.region) {
                names.push_back(full_name(place));
            }
        }
        if (in_state && nearest_name(text, names)) break;
    }
    for (const Station& station : all_stations())
        names.emplace_back(station.icao);
    return said(did_you_mean(text, names));
}

std::optional<GeoPoint> position_in(std::string_view text) {
    const auto numbers = parse_numbers(std::string(text), ',');
    if (!numbers || numbers->size() != 2) return std::nullopt;
    return GeoPoint{(*numbers)[0], (*numbers)[1]};
}

}  // namespace

Result<GeoPoint> place_named(const std::string& text) {
    const std::string_view given = without_outer_spaces(text);
    if (const auto position = position_in(given)) return *position;
    const bool has_letters = std::ranges::any_of(
        given, [](unsigned char c) { return std::isalpha(c) != 0 || c >= 0x80; });
    if (!has_letters) {
        return fail(ErrorCode::bad_argument, "must be {}, not '{}'", place_for_help,
                    printable(text));
    }
    if (const auto icao = icao_of(given)) {
        if (const auto station = find_station(*icao))
            return GeoPoint{station->latitude_deg, station->longitude_deg};
    }
    const Asked asked = parts_of(given);
    Candidates found = towns_called(asked);
    if (found.empty()) found = radars_called(asked);
    if (found.empty()) return tl::unexpected(unknown(given, asked));
    if (found.size() > 1) return tl::unexpected(ambiguous(given, found));
    return GeoPoint{found.front().latitude_deg, found.front().longitude_deg};
}

Result<GeoPoint> parse_place(std::string_view option, const std::string& text) {
    auto place = place_named(text);
    if (!place) return fail(place.error().code, "{}: {}", option, place.error().message);
    return place;
}

Result<std::vector<GeoPoint>> parse_two_places(std::string_view option, const std::string& text) {
    const auto numbers = parse_numbers(text, ',');
    if (numbers && numbers->size() == 4) {
        return std::vector<GeoPoint>{{(*numbers)[0], (*numbers)[1]},
                                     {(*numbers)[2], (*numbers)[3]}};
    }
    const std::size_t middle = text.find(';');
    if (middle == std::string::npos || text.find(';', middle + 1) != std::string::npos) {
        return fail(ErrorCode::bad_argument,
                    "{} takes two places, as in 35,-98.5,35.6,-96.5 or \"Moore, OK; KINX\", not "
                    "'{}'",
                    option, printable(text));
    }
    std::vector<GeoPoint> places;
    for (const std::string& one : {text.substr(0, middle), text.substr(middle + 1)}) {
        const auto place = parse_place(option, one);
        if (!place) return pass_on(place);
        places.push_back(*place);
    }
    return places;
}

}  // namespace stormcellar::grid
