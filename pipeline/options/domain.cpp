#include "pipeline/options/domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/name_list.h"
#include "base/printable.h"
#include "grid/cells/level_range.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::pipeline {
namespace {

using grid::GridSpec;
using grid::Projection;

constexpr int boundary_points = 64;  // along each side of the bounds

bool is_icao(std::string_view name) {
    const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
    return name.size() == 4 && is_capital(name[0]) &&
           std::all_of(name.begin(), name.end(),
                       [&](char c) { return is_capital(c) || (c >= '0' && c <= '9'); });
}

void read_name(TomlTable& table, Domain& domain) {
    domain.name = table.text("name").value_or("");
    if (domain.name.empty()) {
        table.complain("name", "must be given");
    } else if (!cache::is_domain_name(domain.name) || domain.name.find('.') != std::string::npos) {
        table.complain("name", fmt::format("\"{}\": a name is up to 64 letters, digits, _ and -, "
                                           "and begins with a letter or digit",
                                           printable(domain.name)));
    } else if (is_icao(domain.name)) {
        table.complain("name",
                       fmt::format("\"{}\" is the name of a station's own domain", domain.name));
    }
}

std::optional<std::array<double, 4>> read_numbers(TomlTable& table, std::string_view key,
                                                  std::size_t count, std::string_view takes) {
    const auto given = table.numbers(key);
    if (!given) return std::nullopt;
    if (given->size() != count) {
        table.complain(key, fmt::format("must be {}", takes));
        return std::nullopt;
    }
    std::array<double, 4> numbers{};
    std::copy(given->begin(), given->end(), numbers.begin());
    return numbers;
}

template <class Value>
std::optional<Value> read_choice(TomlTable& table, std::string_view key,
                                 std::optional<Value> (*from_name)(std::string_view),
                                 const std::string& known) {
    const auto name = table.text(key);
    if (!name) return std::nullopt;
    const auto value = from_name(*name);
    if (!value)
        table.complain(key, fmt::format("\"{}\" must be one of {}", printable(*name), known));
    return value;
}

void read_projection(TomlTable& table, GridSpec& spec) {
    const auto projection = read_choice(table, "projection", grid::projection_from_name,
                                        names_in(grid::projection_facts));
    spec.projection = projection.value_or(table.has("bounds") ? Projection::latitude_longitude
                                                              : Projection::azimuthal_equidistant);
    const auto parallels = read_numbers(table, "parallels_deg", 2, "[latitude, latitude]");
    if (!grid::facts_of(spec.projection).takes_parallels) {
        if (parallels) table.complain("parallels_deg", "can be given only for lambert_conformal");
        return;
    }
    spec.parallels_deg = {spec.center_latitude_deg, spec.center_latitude_deg};
    if (parallels) spec.parallels_deg = {(*parallels)[0], (*parallels)[1]};
}

void read_spacing(TomlTable& table, GridSpec& spec) {
    const auto km = table.number("spacing_km", {0.05, 500});
    const auto degrees = table.number("spacing_deg", {0.0005, 10});
    if (spec.in_degrees()) {
        if (km)
            table.complain("spacing_km", "a latitude_longitude domain needs spacing_deg instead");
        spec.spacing_m = 0;
        spec.spacing_deg = degrees.value_or(0.01);
        return;
    }
    if (degrees) table.complain("spacing_deg", "can be given only for latitude_longitude");
    spec.spacing_m = grid::metres_of_km(km.value_or(1));
}

// Returns the number of whole columns or rows that cover `cells` cells. An excess of a millionth of
// a cell counts as rounding.
int cells_over(TomlTable& table, std::string_view key, double cells) {
    const double whole = std::ceil(cells - 1e-6);
    if (whole >= 1 && whole <= GridSpec::greatest_side) return static_cast<int>(whole);
    table.complain(key, fmt::format("makes {:.0f} cells along a side, which must be 1 to {}", cells,
                                    GridSpec::greatest_side));
    return 1;
}

// Sets the size so that the grid contains the bounds. The grid has equally many columns on both
// sides of the center.
void size_by_bounds(TomlTable& table, const std::array<double, 4>& bounds, GridSpec& spec) {
    if (spec.in_degrees()) {
        spec.nx = cells_over(table, "bounds", width_deg(bounds) / spec.spacing_deg);
        spec.ny = cells_over(table, "bounds", (bounds[3] - bounds[1]) / spec.spacing_deg);
        return;
    }
    const auto half = half_columns_of(spec, bounds);
    if (!half) {
        table.complain("bounds", half.error().message);
        return;
    }
    spec.nx = cells_over(table, "bounds", 2 * half->x);
    spec.ny = cells_over(table, "bounds", 2 * half->y);
}

void size_by_extent(TomlTable& table, GridSpec& spec) {
    const auto km = read_numbers(table, "extent_km", 2, "[width, height]");
    const auto degrees = read_numbers(table, "extent_deg", 2, "[width, height]");
    const bool in_degrees = spec.in_degrees();
    if (in_degrees && km)
        table.complain("extent_km", "a latitude_longitude domain needs extent_deg instead");
    if (!in_degrees && degrees)
        table.complain("extent_deg", "can be given only for latitude_longitude");
    const auto& extent = in_degrees ? degrees : km;
    if (!extent) {
        if (!km && !degrees) {
            table.complain("center", in_degrees ? "needs extent_deg" : "needs extent_km");
        }
        return;
    }
    const std::string_view key = in_degrees ? "extent_deg" : "extent_km";
    const double spacing = in_degrees ? spec.spacing_deg : spec.spacing_m / 1000;
    spec.nx = cells_over(table, key, (*extent)[0] / spacing);
    spec.ny = cells_over(table, key, (*extent)[1] / spacing);
}

// Reads the center, the projection, the spacing and the size.
void read_place(TomlTable& table, GridSpec& spec) {
    const auto center = read_numbers(table, "center", 2, "[latitude, longitude]");
    const auto bounds = read_numbers(table, "bounds", 4, "[west, south, east, north]");
    if (center.has_value() == bounds.has_value()) {
        if (table.has("center") == table.has("bounds")) {
            table.complain("name", "give either center or bounds");
        }
        return;
    }
    if (center) {
        spec.center_latitude_deg = (*center)[0];
        spec.center_longitude_deg = (*center)[1];
    } else {
        if (!is_bounds(*bounds)) {
            table.complain("bounds", "must be [west, south, east, north] in degrees");
            return;
        }
        const grid::GeoPoint middle = middle_of(*bounds);
        spec.center_latitude_deg = middle.latitude_deg;
        spec.center_longitude_deg = middle.longitude_deg;
    }
    read_projection(table, spec);
    read_spacing(table, spec);
    if (bounds) {
        for (const std::string_view key : {"extent_km", "extent_deg"}) {
            if (table.numbers(key))
                table.complain(key, "can be given only with center, not with bounds");
        }
        size_by_bounds(table, *bounds, spec);
    } else {
        size_by_extent(table, spec);
    }
}

void read_stations(TomlTable& table, Domain& domain) {
    const auto names = table.texts("stations");
    if (!names) return;
    domain.stations = *names;
    for (const std::string& name : *names) {
        if (is_icao(name)) continue;
        table.complain(
            "stations",
            fmt::format("\"{}\" is not a station: give four capital letters, as in \"KTLX\"",
                        printable(name)));
    }
    if (names->empty()) table.complain("stations", "must name a station, or be left out");
}

void read_frames(TomlTable& table, Domain& domain) {
    if (const auto seconds = table.whole_number("interval_seconds", {10, 86'400})) {
        domain.interval = std::chrono::seconds{*seconds};
    }
    domain.overlap =
        read_choice(table, "overlap", grid::overlap_from_name, names_in(grid::overlap_facts));
    if (const auto km = table.number("overlap_km", {1, 10'000})) {
        domain.overlap_length_m = *km * 1000;
    }
    domain.time = read_choice(table, "time_method", grid::time_method_from_name,
                              names_in(grid::time_method_facts))
                      .value_or(domain.time);
}

Domain read_domain(TomlTable& table) {
    Domain domain;
    read_name(table, domain);
    domain.spec = grid::default_spec(0, 0);
    read_place(table, domain.spec);
    if (const auto levels_m = read_levels_m(table)) domain.spec.levels_m = *levels_m;
    if (auto moments = read_moments(table, "moments")) domain.moments = std::move(*moments);
    for (const level2::Moment moment : domain.moments) {
        if (level2::facts_of(moment).is_derived)
            table.complain("moments", fmt::format("{} is made for single stations, not for mosaics",
                                                  level2::moment_name(moment)));
    }
    read_stations(table, domain);
    read_frames(table, domain);
    if (const Status valid = grid::validate(domain.spec); !valid) {
        table.complain("name", valid.error().message);
    }
    return domain;
}

}  // namespace

double width_deg(const Bounds& bounds) {
    const auto [west, south, east, north] = bounds;
    return east > west ? east - west : east - west + 360;
}

grid::GeoPoint middle_of(const Bounds& bounds) {
    const auto [west, south, east, north] = bounds;
    return {(south + north) / 2, std::remainder(west + width_deg(bounds) / 2, 360.0)};
}

Result<grid::ColumnPoint> half_columns_of(const GridSpec& spec, const Bounds& bounds) {
    GridSpec one = spec;
    one.nx = one.ny = 1;
    if (const Status valid = grid::validate(one); !valid) return pass_on(valid);
    const auto [west, south, east, north] = bounds;
    const grid::GridProjection projection(one);
    grid::ColumnPoint half{0, 0};
    for (int i = 0; i <= boundary_points; ++i) {
        const double share = static_cast<double>(i) / boundary_points;
        const double latitude = south + share * (north - south);
        const double longitude = west + share * width_deg(bounds);
        for (const grid::GeoPoint& point :
             {grid::GeoPoint{latitude, west}, grid::GeoPoint{latitude, east},
              grid::GeoPoint{south, longitude}, grid::GeoPoint{north, longitude}}) {
            const grid::ColumnPoint column = projection.to_column(point);
            half.x = std::max(half.x, std::abs(column.x));
            half.y = std::max(half.y, std::abs(column.y));
        }
    }
    return half;
}

bool is_bounds(const Bounds& bounds) {
    const auto [west, south, east, north] = bounds;
    return std::abs(west) <= 180 && std::abs(east) <= 180 && south < north && west != east &&
           std::abs(south) <= 90 && std::abs(north) <= 90;
}

bool Domain::takes(std::string_view station) const {
    return stations.empty() ||
           std::find(stations.begin(), stations.end(), station) != stations.end();
}

std::optional<std::vector<double>> read_levels_m(TomlTable& table) {
    if (table.is_array("levels_km")) {
        const auto levels_km = table.numbers("levels_km");
        if (!levels_km) return std::nullopt;
        if (levels_km->empty()) table.complain("levels_km", "must name at least one level");
        std::vector<double> levels_m;
        for (const double level : *levels_km)
            levels_m.push_back(grid::metres_of_km(level));
        return levels_m;
    }
    const auto text = table.text("levels_km");
    if (!text) return std::nullopt;
    auto levels_m = grid::parse_level_range(*text);
    if (!levels_m) {
        table.complain("levels_km", fmt::format("\"{}\" is not BOTTOM:TOP:STEP, as in "
                                                "\"0.5:16:0.5\"",
                                                printable(*text)));
    }
    return levels_m;
}

std::optional<level2::Moment> read_moment(TomlTable& table, std::string_view key,
                                          const std::string& name) {
    const auto moment = level2::moment_from_name(name);
    if (!moment) {
        table.complain(key, fmt::format("\"{}\" is not a moment: give one of {}", printable(name),
                                        level2::moment_names(" ", " ")));
    } else if (level2::facts_of(*moment).is_categorical) {
        table.complain(key, fmt::format("{} has classes, which have no mean: the service does not "
                                        "grid it, but `stormcellar grid` does",
                                        level2::moment_name(*moment)));
    }
    return moment;
}

std::optional<std::vector<level2::Moment>> read_moments(TomlTable& table, std::string_view key) {
    const auto names = table.texts(key);
    if (!names) return std::nullopt;
    std::vector<level2::Moment> moments;
    for (const std::string& name : *names) {
        const auto moment = read_moment(table, key, name);
        const bool is_new = moment && std::ranges::find(moments, *moment) == moments.end();
        if (is_new) moments.push_back(*moment);
    }
    if (names->empty()) table.complain(key, "must name at least one moment");
    return moments;
}

std::vector<Domain> read_domains(TomlTable& root) {
    std::vector<Domain> domains;
    std::set<std::string> names;
    for (TomlTable& table : root.tables("domain")) {
        Domain domain = read_domain(table);
        if (!names.insert(domain.name).second && !domain.name.empty()) {
            table.complain("name", fmt::format("another domain has the name \"{}\" too",
                                               printable(domain.name)));
        }
        domains.push_back(std::move(domain));
    }
    return domains;
}

}  // namespace stormcellar::pipeline
