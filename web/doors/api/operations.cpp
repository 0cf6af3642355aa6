#include "web/doors/api/operations.h"

#include <array>

namespace stormcellar::web {
namespace {

constexpr ApiParameter from_time{"from", "earliest time, inclusive: ISO 8601 in UTC, or -2h"};
constexpr ApiParameter to_time{"to", "latest time, inclusive"};
constexpr ApiParameter one_moment{"moment", "short name of a moment, in capitals; default: all"};

constexpr std::array stations_parameters{
    ApiParameter{"station", "ICAO of one station"},
    ApiParameter{"known", "1: also the stations of the table that have no data", ApiKind::whole}};
constexpr std::array volumes_parameters{
    from_time, to_time,
    ApiParameter{"limit", "the newest so many, 1 to 10000; default 100", ApiKind::whole}};
constexpr std::array gates_parameters{
    ApiParameter{"kind", "which kind of gates, if a sweep has several of a moment; default 0",
                 ApiKind::whole},
    ApiParameter{"quality",
                 "leave out echo whose probability of weather is less, 0 to 1; default 0",
                 ApiKind::number}};
constexpr std::array grids_parameters{
    ApiParameter{"domain", "name of one domain; default: all"}, one_moment, from_time, to_time,
    ApiParameter{"limit", "the newest so many, 1 to 10000; default 100", ApiKind::whole}};
constexpr std::array packed_parameters{
    ApiParameter{"id", "the grid's id: the answer never changes, and is 410 if the grid did"},
    ApiParameter{"part", "whole (default) or table"},
    ApiParameter{"most",
                 "bytes: the whole if it has no more before it is compressed, else the table",
                 ApiKind::whole},
    ApiParameter{"codes", "all (default), or values: those of values alone, which are fewer bytes"},
    ApiParameter{"bricks", "FIRST-LAST: the codes of these bricks of the table alone"},
    ApiParameter{"window",
                 "FIRST-LAST,FIRST-LAST: these columns of bricks, to the east and to the north, as "
                 "a whole grid"},
    ApiParameter{"half", "how often columns and rows are halved, 0 to 6", ApiKind::whole},
    ApiParameter{"by", "how cells are halved: maximum or mean; required with half"}};
constexpr std::array probe_parameters{
    ApiParameter{"at", "LATITUDE,LONGITUDE in degrees", ApiKind::text, true}};
constexpr std::array profile_parameters{
    ApiParameter{"from", "LATITUDE,LONGITUDE of the first point", ApiKind::text, true},
    ApiParameter{"to", "LATITUDE,LONGITUDE of the last point", ApiKind::text, true},
    ApiParameter{"count", "how many points, 2 to 1024; default 101", ApiKind::whole}};
constexpr std::array netcdf_parameters{
    ApiParameter{"deflate", "compression of the file, 0 to 9; default 1", ApiKind::whole}};
constexpr std::array view_parameters{
    ApiParameter{"width", "of the picture in pixels, 16 to 8192; default 796", ApiKind::whole},
    ApiParameter{"height", "of the picture in pixels, 16 to 8192; default 532", ApiKind::whole}};
constexpr std::array map_parameters{
    ApiParameter{"west", "degrees", ApiKind::number, true},
    ApiParameter{"south", "degrees", ApiKind::number, true},
    ApiParameter{"east", "degrees", ApiKind::number, true},
    ApiParameter{"north", "degrees", ApiKind::number, true},
    ApiParameter{"detail", "0 (fine) to 2 (coarse); default 1", ApiKind::whole},
    ApiParameter{"kinds",
                 "county, state, lake, country, coast, interstate, highway, city, with commas; "
                 "default: all but county, interstate and highway"}};

constexpr std::array regions_parameters{
    ApiParameter{"west", "degrees", ApiKind::number, true},
    ApiParameter{"south", "degrees", ApiKind::number, true},
    ApiParameter{"east", "degrees, greater than west", ApiKind::number, true},
    ApiParameter{"north", "degrees", ApiKind::number, true}};

constexpr std::array storms_parameters{
    ApiParameter{"area", "a station or domain; default: all domains, or else all stations"},
    ApiParameter{"time", "the newest grids at most 30 minutes before this; default: the newest"}};

constexpr std::array events_parameters{
    ApiParameter{"station", "hear of these stations: ICAOs with commas"},
    ApiParameter{"domain", "hear of the grids of these domains, too"},
    ApiParameter{"moment", "of these moments, and of what has none"},
    ApiParameter{"kind",
                 "volume_begun, sweep_gridded, volume_complete, mosaic, cells, grid_evicted, "
                 "station_silent, station_spoke, with commas"},
    ApiParameter{"last_event_id",
                 "go on after this event; the header Last-Event-ID counts before"}};

constexpr std::array<unsigned, 0> no_errors{};
constexpr std::array bad_request{400U};
constexpr std::array catalog_errors{400U, 404U};
constexpr std::array volume_errors{400U, 404U, 503U};
constexpr std::array grid_errors{400U, 404U, 410U};
constexpr std::array events_errors{400U, 404U, 503U};
constexpr std::array computed_errors{400U, 404U, 410U, 503U};

constexpr std::string_view json_type = "application/json";
constexpr std::string_view bytes_type = "application/octet-stream";
constexpr std::string_view events_type = "text/event-stream";

constexpr auto operations_table = std::to_array<ApiOperation>({
    {"index", "/api/v1", "What the API does: this table.", {}, json_type, no_errors, api_index},
    {"openapi",
     "/api/v1/openapi.json",
     "This table as OpenAPI 3.1.",
     {},
     json_type,
     no_errors,
     api_openapi},
    {"stations", "/api/v1/stations",
     "The stations that have volumes or grids: place, newest volume, newest grid, ages, silence.",
     stations_parameters, json_type, bad_request, api_stations},
    {"volumes", "/api/v1/stations/{station}/volumes", "The raw volumes of a station, oldest first.",
     volumes_parameters, json_type, catalog_errors, api_volumes},
    {"sweeps",
     "/api/v1/stations/{station}/volumes/{time}/sweeps",
     "The sweeps of a volume and their moments.",
     {},
     json_type,
     volume_errors,
     api_sweeps},
    {"gates", "/api/v1/stations/{station}/volumes/{time}/sweeps/{sweep}/{moment}",
     "The gates of a moment of a sweep, packed.", gates_parameters, bytes_type, volume_errors,
     api_gates},
    {"wind",
     "/api/v1/stations/{station}/volumes/{time}/wind",
     "The wind above the radar by height, and the motions of storms.",
     {},
     json_type,
     volume_errors,
     api_wind},
    {"domains",
     "/api/v1/domains",
     "The domains of the cache: moments, counts, newest grids.",
     {},
     json_type,
     no_errors,
     api_domains},
    {"grids", "/api/v1/grids", "The grids of the cache, oldest first.", grids_parameters, json_type,
     bad_request, api_grids},
    {"grid",
     "/api/v1/grids/{domain}/{moment}/{time}",
     "What a grid is and how it was made: cells, provenance, predicted error, audit.",
     {},
     json_type,
     grid_errors,
     api_grid},
    {"packed", "/api/v1/grids/{domain}/{moment}/{time}/packed",
     "The grid in its packed form, whole or in parts.", packed_parameters, bytes_type,
     computed_errors, api_packed, api_packed_at_once},
    {"probe", "/api/v1/grids/{domain}/{moment}/{time}/probe",
     "State, value and height of each cell of the column at a place.", probe_parameters, json_type,
     grid_errors, api_probe},
    {"profile", "/api/v1/grids/{domain}/{moment}/{time}/profile",
     "States and values of the columns along the shortest way between two places.",
     profile_parameters, json_type, grid_errors, api_profile},
    {"netcdf", "/api/v1/grids/{domain}/{moment}/{time}/netcdf",
     "The grid as CF netCDF, as stormcellar grid writes it.", netcdf_parameters,
     "application/x-netcdf", computed_errors, api_netcdf},
    {"file",
     "/api/v1/grids/{domain}/{moment}/{time}/file",
     "The grid's own file (.scg), with ranges.",
     {},
     bytes_type,
     grid_errors,
     api_grid_file},
    {"view", "/api/v1/grids/{domain}/{moment}/{time}/view",
     "The camera, exaggeration and opacity with which stormcellar frame draws the grid.",
     view_parameters, json_type, grid_errors, api_view},
    {"between",
     "/api/v1/between/{domain}/{moment}/{time}",
     "A grid for an instant between volumes, made when it is asked for, in the packed form.",
     {},
     bytes_type,
     computed_errors,
     api_between},
    {"regions", "/api/v1/regions",
     "A box over several sites as a domain: its sites, cells, moments and times.",
     regions_parameters, json_type, catalog_errors, api_regions},
    {"region_sites",
     "/api/v1/regions/{region}/{moment}/{time}/sites",
     "Of which volumes each site of a region is made at an instant, and how far these are from it.",
     {},
     json_type,
     catalog_errors,
     api_region_sites},
    {"region_packed",
     "/api/v1/regions/{region}/{moment}/{time}/packed",
     "The grids of a region's sites as one, at one instant, made when it is asked for.",
     {},
     bytes_type,
     volume_errors,
     api_region_packed},
    {"events", "/api/v1/events", "What happens, as it happens: server-sent events.",
     events_parameters, events_type, events_errors, api_no_events},
    {"cells", "/api/v1/cells", "Storm cells with attributes, tracks and forecasts, as GeoJSON.",
     storms_parameters, geojson_type, volume_errors, api_cells},
    {"strongest_rotation", "/api/v1/rotation",
     "Places of the strongest azimuthal shear, as GeoJSON.", storms_parameters, geojson_type,
     volume_errors, api_rotation},
    {"map", "/api/v1/map", "Coasts, borders, lakes and cities of an area.", map_parameters,
     json_type, bad_request, api_map},
    {"tables",
     "/api/v1/tables",
     "The color tables of pictures, and which one each moment usually has.",
     {},
     json_type,
     no_errors,
     api_tables},
});

struct PathParameter {
    std::string_view name, what;
};
constexpr auto path_parameters = std::to_array<PathParameter>({
    {"domain", "name of a domain: a station's ICAO, or that of a mosaic"},
    {"moment", "short name of a moment, in capitals"},
    {"time", "ISO 8601 in UTC with milliseconds where they are not 0, or latest"},
    {"region", "WEST,SOUTH,EAST,NORTH in degrees, as /api/v1/regions names it"},
    {"station", "ICAO of a station"},
    {"sweep", "number of a sweep in its volume, from 0"},
});

std::string_view status_text(unsigned status) {
    switch (status) {
        case 400:
            return "A parameter makes no sense; error says which and why.";
        case 404:
            return "There is no such thing.";
        case 410:
            return "The grid was evicted, or made again under another id.";
        default:
            return "Too much is being computed; ask again after Retry-After seconds.";
    }
}

std::string_view schema_type(ApiKind kind) {
    return kind == ApiKind::number ? "number" : kind == ApiKind::whole ? "integer" : "string";
}

// Returns the names in braces, in the order of their appearance.
std::vector<std::string_view> names_in_braces(std::string_view path) {
    std::vector<std::string_view> names;
    for (const std::string_view segment : segments_of(path)) {
        if (segment.starts_with('{')) names.push_back(segment.substr(1, segment.size() - 2));
    }
    return names;
}

ApiJson parameters_json(const ApiOperation& operation) {
    ApiJson list = ApiJson::array();
    for (const std::string_view name : names_in_braces(operation.path)) {
        list.push_back({{"name", name},
                        {"in", "path"},
                        {"required", true},
                        {"description", api_path_parameter(name)},
                        {"schema", {{"type", name == "sweep" ? "integer" : "string"}}}});
    }
    for (const ApiParameter& parameter : operation.parameters) {
        list.push_back({{"name", parameter.name},
                        {"in", "query"},
                        {"required", parameter.required},
                        {"description", parameter.what},
                        {"schema", {{"type", schema_type(parameter.kind)}}}});
    }
    return list;
}

ApiJson responses_json(const ApiOperation& operation) {
    const bool is_json =
        operation.content_type == json_type || operation.content_type == geojson_type;
    ApiJson schema = is_json ? ApiJson::object({{"type", "object"}})
                             : ApiJson::object({{"type", "string"}, {"format", "binary"}});
    if (operation.content_type == events_type) schema = {{"type", "string"}};
    ApiJson all;
    all["200"] = {{"description", operation.what},
                  {"content", {{operation.content_type, {{"schema", schema}}}}}};
    for (const unsigned status : operation.errors) {
        all[std::to_string(status)] = {
            {"description", status_text(status)},
            {"content", {{json_type, {{"schema", {{"$ref", "#/components/schemas/Error"}}}}}}}};
    }
    all["4XX"] = {{"description", "The request is refused before the API reads it; a sentence."},
                  {"content", {{"text/plain", {{"schema", {{"type", "string"}}}}}}}};
    return all;
}

}  // namespace

std::span<const ApiOperation> api_operations() {
    return operations_table;
}

std::string_view api_path_parameter(std::string_view name) {
    for (const PathParameter& parameter : path_parameters) {
        if (parameter.name == name) return parameter.what;
    }
    return "";
}

ApiJson openapi_document(std::string_view base) {
    ApiJson document;
    document["openapi"] = "3.1.0";
    document["info"] = {{"title", "stormcellar"},
                        {"version", "1"},
                        {"description", "Gridded weather radar data: docs/web/grids.md."},
                        {"license", {{"name", "BSD 3-Clause"}, {"identifier", "BSD-3-Clause"}}}};
    document["security"] = ApiJson::array();
    document["servers"] = ApiJson::array({{{"url", base}}});
    for (const ApiOperation& operation : api_operations()) {
        document["paths"][std::string(operation.path)]["get"] = {
            {"operationId", operation.name},
            {"summary", operation.what},
            {"parameters", parameters_json(operation)},
            {"responses", responses_json(operation)}};
    }
    document["components"]["schemas"]["Error"] = {
        {"type", "object"},
        {"required", {"error"}},
        {"properties", {{"error", {{"type", "string"}}}}}};
    return document;
}

Answer api_index(const ApiCall& call) {
    ApiJson list = ApiJson::array();
    for (const ApiOperation& operation : api_operations()) {
        ApiJson names = ApiJson::array();
        for (const ApiParameter& parameter : operation.parameters)
            names.push_back(parameter.name);
        list.push_back({{"name", operation.name},
                        {"path", operation.path},
                        {"parameters", names},
                        {"what", operation.what}});
    }
    return json_answer(call.request, {{"operations", list}});
}

// Answers that no events are served. If events are served, the door of web/doors/events/events.h
// answers this path instead.
Answer api_no_events(const ApiCall& /*call*/) {
    return json_error(404, "this server serves no events");
}

Answer api_openapi(const ApiCall& call) {
    return json_answer(call.request, openapi_document(call.request.base));
}

}  // namespace stormcellar::web
