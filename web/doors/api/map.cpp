// The operation that returns the built-in base map: the lines and cities in an area.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/checksum.h"
#include "render/map/base_map.h"
#include "web/data/grids/compressed.h"
#include "web/data/grids/region.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t most_map_points = 300'000;
constexpr std::size_t most_cities = 2000;

constexpr std::string_view city_kind = "city";
constexpr std::string_view usual_kinds = "state,lake,country,coast,city";

struct MapRequest {
    RegionBox box;
    int detail = 1;
    std::vector<render::MapKind> kinds;
    bool cities = false;
    [[nodiscard]] std::string text() const {
        std::string all = fmt::format("{}/{}/{}/{}/{}/{}", box.west_deg, box.south_deg,
                                      box.east_deg, box.north_deg, detail, cities);
        for (const render::MapKind kind : kinds)
            all += fmt::format("/{}", static_cast<int>(kind));
        return all;
    }
};

Status read_kinds(std::string_view text, MapRequest& wanted) {
    while (!text.empty()) {
        const std::string_view name = text.substr(0, text.find(','));
        text.remove_prefix(std::min(name.size() + 1, text.size()));
        if (name == city_kind) {
            wanted.cities = true;
            continue;
        }
        const auto known = std::ranges::find(render::map_kinds, name, &render::MapKindFacts::name);
        if (known == render::map_kinds.end()) {
            return fail(ErrorCode::bad_argument,
                        "kinds: county, state, lake, country, coast, interstate, highway or city, "
                        "not '{}'",
                        name.substr(0, 40));
        }
        if (std::ranges::find(wanted.kinds, known->kind) == wanted.kinds.end()) {
            wanted.kinds.push_back(known->kind);
        }
    }
    return {};
}

Result<MapRequest> read_map_request(const ApiCall& call) {
    MapRequest wanted;
    const auto sides = box_parameters(call);
    if (!sides) return pass_on(sides);
    const RegionBox box = wanted.box = turned(*sides);
    const double wide = box.east_deg - box.west_deg;
    if (!(wide > 0) || wide > 360 || box.south_deg >= box.north_deg) {
        return fail(ErrorCode::bad_argument,
                    "west must not be east nor over 360 degrees from it, and south must be less "
                    "than north");
    }
    const auto detail = whole_parameter(call, "detail", 0, render::map_detail_count - 1, 1);
    if (!detail) return pass_on(detail);
    wanted.detail = static_cast<int>(*detail);
    const auto kinds = call.request.parameter("kinds");
    if (Status read = read_kinds(kinds.value_or(usual_kinds), wanted); !read) return pass_on(read);
    return wanted;
}

double five_places(double degrees) {
    return std::round(degrees * 1e5) / 1e5;
}

// The longitudes of the map are from -180 to 180. If a box crosses the antimeridian, lines and
// cities beyond it must get a full turn more.
constexpr std::array<double, 2> turns_deg{0, 360};

bool is_seen(const render::MapLine& line, const RegionBox& box, double turn_deg) {
    if (turn_deg > 0 && box.east_deg <= 180) return false;
    return line.west_deg + turn_deg <= box.east_deg && line.east_deg + turn_deg >= box.west_deg &&
           line.south_deg <= box.north_deg && line.north_deg >= box.south_deg;
}

ApiJson places_json(std::span<const grid::GeoPoint> points, double turn_deg) {
    ApiJson places = ApiJson::array();
    for (const grid::GeoPoint& point : points) {
        places.push_back(
            {five_places(point.longitude_deg + turn_deg), five_places(point.latitude_deg)});
    }
    return places;
}

Status add_lines(const render::BaseMap& map, const MapRequest& wanted, ApiJson& lines) {
    std::size_t count = 0;
    for (const render::MapSet& set : map.sets()) {
        if (set.detail != wanted.detail ||
            std::ranges::find(wanted.kinds, set.kind) == wanted.kinds.end()) {
            continue;
        }
        const auto named =
            std::ranges::find(render::map_kinds, set.kind, &render::MapKindFacts::kind);
        for (const render::MapLine& line : set.lines) {
            for (const double turn_deg : turns_deg) {
                if (!is_seen(line, wanted.box, turn_deg)) continue;
                count += line.point_count;
                if (count > most_map_points) {
                    return fail(ErrorCode::bad_argument,
                                "the area holds more than {} points: ask for a smaller one, a "
                                "coarser detail or fewer kinds",
                                most_map_points);
                }
                const auto points = map.points_of(line);
                if (!points) return pass_on(points);
                lines.push_back({{"kind", named->name},
                                 {"is_area", render::is_area(set.kind)},
                                 {"points", places_json(*points, turn_deg)}});
            }
        }
    }
    return {};
}

ApiJson cities_json(const render::BaseMap& map, const MapRequest& wanted) {
    ApiJson cities = ApiJson::array();
    for (const render::MapCity& city : map.cities()) {
        const RegionBox& box = wanted.box;
        const double latitude = city.place.latitude_deg;
        double longitude = city.place.longitude_deg;
        if (longitude < box.west_deg) longitude += 360;
        const bool inside =
            longitude <= box.east_deg && latitude >= box.south_deg && latitude <= box.north_deg;
        if (!inside) continue;
        if (cities.size() >= most_cities) break;  // the largest cities come first
        cities.push_back({{"name", city.name},
                          {"population", city.population},
                          {"place", {five_places(longitude), five_places(latitude)}}});
    }
    return cities;
}

Result<Kept> make_map(const MapRequest& wanted, Coding coding) {
    const auto map = render::BaseMap::built_in();
    if (!map) return pass_on(map);
    ApiJson json{{"credit", render::map_credit}, {"lines", ApiJson::array()}};
    if (Status added = add_lines(*map, wanted, json["lines"]); !added) return pass_on(added);
    json["cities"] = wanted.cities ? cities_json(*map, wanted) : ApiJson::array();
    const std::string text = json.dump() + "\n";
    return kept_compressed(text, coding);
}

}  // namespace

Answer api_map(const ApiCall& call) {
    const auto wanted = read_map_request(call);
    if (!wanted) return json_error(wanted.error());
    const Coding coding = coding_for(call.request);
    const auto kept = call.state.sources().kept->find_or_make(
        fmt::format("map/{}/{}", wanted->text(), coding_name(coding)),
        [&] { return make_map(*wanted, coding); });
    if (!kept) return json_error(kept.error());
    Entity entity = entity_of(*kept, "application/json");
    entity.max_age = std::chrono::hours{1};
    return answer_with(call.request, std::move(entity));
}

}  // namespace stormcellar::web
