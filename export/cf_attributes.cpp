#include "export/cf_attributes.h"

#include <fmt/format.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::netcdf {
namespace {

// The CF names of a projection, and of the attribute that holds the longitude of its origin
// (CF-1.8, appendix F).
struct MappingNames {
    const char* mapping;
    const char* origin_longitude;
};
MappingNames names_of(grid::Projection projection) {
    switch (projection) {
        case grid::Projection::azimuthal_equidistant:
            return {"azimuthal_equidistant", "longitude_of_projection_origin"};
        case grid::Projection::latitude_longitude:
            return {"latitude_longitude", ""};
        case grid::Projection::lambert_conformal:
            return {"lambert_conformal_conic", "longitude_of_central_meridian"};
    }
    return {"", ""};
}

CfAttributes coordinate(const char* standard_name, const char* units, const char* axis) {
    return {{"standard_name", standard_name}, {"units", units}, {"axis", axis}};
}

CfAttributes map_axis(const char* standard_name, const char* units, const char* axis,
                      const char* long_name) {
    CfAttributes attributes = coordinate(standard_name, units, axis);
    attributes.emplace_back("long_name", long_name);
    return attributes;
}

void add_origin(CfAttributes& attributes, const grid::GridSpec& spec) {
    attributes.emplace_back("latitude_of_projection_origin", spec.center_latitude_deg);
    attributes.emplace_back(names_of(spec.projection).origin_longitude, spec.center_longitude_deg);
    attributes.emplace_back("false_easting", 0.0);
    attributes.emplace_back("false_northing", 0.0);
    if (!grid::facts_of(spec.projection).takes_parallels) return;
    const auto [first_deg, second_deg] = spec.parallels_deg;
    if (first_deg == second_deg) {
        attributes.emplace_back("standard_parallel", first_deg);
    } else {
        attributes.emplace_back("standard_parallel", std::vector<double>{first_deg, second_deg});
    }
}

template <class Place>
std::vector<double> places_of(int count, const Place& place) {
    std::vector<double> places;
    for (int i = 0; i < count; ++i)
        places.push_back(place(i));
    return places;
}

}  // namespace

MapNames map_names(const grid::GridSpec& spec) {
    return spec.in_degrees() ? MapNames{"lat", "lon"} : MapNames{"y", "x"};
}

const char* mapping_name(grid::Projection projection) {
    return names_of(projection).mapping;
}

CfAttributes time_attributes(std::string_view long_name) {
    CfAttributes attributes = coordinate("time", "seconds since 1970-01-01T00:00:00Z", "T");
    attributes.emplace_back("calendar", "standard");
    attributes.emplace_back("long_name", std::string(long_name));
    return attributes;
}

CfAttributes height_attributes() {
    CfAttributes attributes = coordinate("altitude", "m", "Z");
    attributes.emplace_back("positive", "up");
    attributes.emplace_back("long_name", "height above mean sea level");
    return attributes;
}

CfAttributes row_attributes(const grid::GridSpec& spec) {
    if (spec.in_degrees()) return map_axis("latitude", "degrees_north", "Y", "latitude");
    return map_axis("projection_y_coordinate", "m", "Y", "distance north of the centre");
}

CfAttributes column_attributes(const grid::GridSpec& spec) {
    if (spec.in_degrees()) return map_axis("longitude", "degrees_east", "X", "longitude");
    return map_axis("projection_x_coordinate", "m", "X", "distance east of the centre");
}

CfAttributes latitude_attributes() {
    return {{"standard_name", "latitude"}, {"units", "degrees_north"}};
}

CfAttributes longitude_attributes() {
    return {{"standard_name", "longitude"}, {"units", "degrees_east"}};
}

CfAttributes mapping_attributes(const grid::GridSpec& spec) {
    CfAttributes attributes = {{"grid_mapping_name", mapping_name(spec.projection)}};
    if (!spec.in_degrees()) add_origin(attributes, spec);
    attributes.emplace_back("semi_major_axis", grid::wgs84_semi_major_m);
    attributes.emplace_back("inverse_flattening", 1 / grid::wgs84_flattening);
    attributes.emplace_back("longitude_of_prime_meridian", 0.0);
    attributes.emplace_back(
        "comment",
        "WGS84; heights above mean sea level are used as heights above the ellipsoid (about "
        "1 m at 230 km)");
    return attributes;
}

std::string well_known_text(const grid::GridSpec& spec) {
    const std::string degrees = fmt::format(
        R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",{},{}]],PRIMEM["Greenwich",0],)"
        R"(UNIT["degree",0.0174532925199433]])",
        grid::wgs84_semi_major_m, 1 / grid::wgs84_flattening);
    const auto plane = [&](std::string_view projection, std::string_view parameters) {
        return fmt::format(R"(PROJCS["{0}",{1},PROJECTION["{0}"],{2},PARAMETER["false_easting",0],)"
                           R"(PARAMETER["false_northing",0],UNIT["metre",1],AXIS["Easting",EAST],)"
                           R"(AXIS["Northing",NORTH]])",
                           projection, degrees, parameters);
    };
    switch (spec.projection) {
        case grid::Projection::azimuthal_equidistant:
            return plane(
                "Azimuthal_Equidistant",
                fmt::format(
                    R"(PARAMETER["latitude_of_center",{}],PARAMETER["longitude_of_center",{}])",
                    spec.center_latitude_deg, spec.center_longitude_deg));
        case grid::Projection::latitude_longitude:
            return degrees;
        case grid::Projection::lambert_conformal:
            return plane(
                "Lambert_Conformal_Conic_2SP",
                fmt::format(
                    R"(PARAMETER["latitude_of_origin",{}],PARAMETER["central_meridian",{}],)"
                    R"(PARAMETER["standard_parallel_1",{}],PARAMETER["standard_parallel_2",{}])",
                    spec.center_latitude_deg, spec.center_longitude_deg, spec.parallels_deg[0],
                    spec.parallels_deg[1]));
    }
    return {};
}

CfAttributes reference_to_map(const grid::GridSpec& spec) {
    CfAttributes attributes;
    if (!spec.in_degrees()) attributes.emplace_back("coordinates", "lat lon");
    attributes.emplace_back("grid_mapping", mapping_name(spec.projection));
    return attributes;
}

CfAttributes field_attributes(level2::Moment moment, std::string_view method) {
    const level2::MomentFacts& facts = level2::facts_of(moment);
    CfAttributes attributes = {{"long_name", std::string(facts.netcdf.long_name)}};
    if (!facts.netcdf.cf.empty())
        attributes.emplace_back("standard_name", std::string(facts.netcdf.cf));
    attributes.emplace_back("units", std::string(facts.units));
    const bool is_area = grid::cell_extent_of(method) == grid::CellExtent::area;
    attributes.emplace_back("cell_methods", is_area ? "area: mean" : "area: point");
    return attributes;
}

CfAttributes status_attributes(level2::Moment moment) {
    std::string comment =
        "not_seen: blind region, beyond range, missing radials or sweeps; no_echo: seen, below the "
        "radar's threshold; range_folded: echo from beyond the unambiguous range";
    if (level2::facts_of(moment).is_derived)
        comment += "; ambiguous: echo whose value cannot be derived";
    return {{"long_name", "what a cell holds"},
            {"standard_name", "status_flag"},
            {"comment", std::move(comment)}};
}

std::vector<double> row_places(const grid::GridSpec& spec) {
    const grid::GridProjection projection(spec);
    return places_of(spec.ny, [&](int iy) {
        return spec.in_degrees() ? projection.row_latitude_deg(iy) : spec.y_m(iy);
    });
}

std::vector<double> column_places(const grid::GridSpec& spec) {
    const grid::GridProjection projection(spec);
    return places_of(spec.nx, [&](int ix) {
        return spec.in_degrees() ? projection.column_longitude_deg(ix) : spec.x_m(ix);
    });
}

}  // namespace stormcellar::netcdf
