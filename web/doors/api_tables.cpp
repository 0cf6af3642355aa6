// The color tables of the pictures.
#include "render/colour/built_in_tables.h"
#include "web/doors/api_operations.h"

namespace stormcellar::web {
namespace {

ApiJson table_json(const render::ColourTable& table) {
    ApiJson stops = ApiJson::array();
    for (const render::ColourStop& stop : table.stops)
        stops.push_back({{"from", stop.from}, {"color", stop.colour}, {"until", stop.until}});
    ApiJson extinction = ApiJson::array();
    for (const render::ExtinctionPoint& point : table.extinction)
        extinction.push_back({{"value", point.value}, {"per_km", point.per_km}});
    return {{"name", table.name},        {"moment", level2::moment_name(table.moment)},
            {"unit", table.unit},        {"bar_begin", table.bar_begin.value_or(table.lowest())},
            {"end", table.end},          {"range_folded", table.range_folded},
            {"stops", std::move(stops)}, {"extinction", std::move(extinction)}};
}

}  // namespace

Answer api_tables(const ApiCall& call) {
    ApiJson tables = ApiJson::array();
    for (const render::ColourTable& table : render::built_in_tables())
        tables.push_back(table_json(table));
    ApiJson usual = ApiJson::object();
    for (const level2::Moment moment : level2::all_moments)
        usual[std::string(level2::moment_name(moment))] = render::smooth_colour_table(moment).name;
    return json_answer(call.request, {{"tables", std::move(tables)}, {"usual", std::move(usual)}});
}

}  // namespace stormcellar::web
