// The operation that returns the color tables of pictures.
#include <span>

#include "base/checksum.h"
#include "render/color/built_in_tables.h"
#include "web/data/grids/compressed.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

ApiJson table_json(const render::ColorTable& table) {
    ApiJson stops = ApiJson::array();
    for (const render::ColorStop& stop : table.stops)
        stops.push_back({{"from", stop.from}, {"color", stop.color}, {"until", stop.until}});
    ApiJson extinction = ApiJson::array();
    for (const render::ExtinctionPoint& point : table.extinction)
        extinction.push_back({{"value", point.value}, {"per_km", point.per_km}});
    return {{"name", table.name},        {"moment", level2::moment_name(table.moment)},
            {"unit", table.unit},        {"bar_begin", table.bar_begin.value_or(table.lowest())},
            {"end", table.end},          {"range_folded", table.range_folded},
            {"stops", std::move(stops)}, {"extinction", std::move(extinction)}};
}

Result<Kept> make_tables(Coding coding) {
    ApiJson tables = ApiJson::array();
    for (const render::ColorTable& table : render::built_in_tables())
        tables.push_back(table_json(table));
    ApiJson usual = ApiJson::object();
    for (const level2::Moment moment : level2::all_moments)
        usual[std::string(level2::moment_name(moment))] = render::smooth_color_table(moment).name;
    const std::string text =
        ApiJson{{"tables", std::move(tables)}, {"usual", std::move(usual)}}.dump() + "\n";
    return kept_compressed(text, coding);
}

}  // namespace

// Answers with the tables. They are kept, because they never change while the program runs, and
// their JSON is as large as a small grid.
Answer api_tables(const ApiCall& call) {
    const Coding coding = coding_for(call.request);
    const auto kept = call.state.sources().kept->find_or_make(
        fmt::format("tables/{}", coding_name(coding)), [&] { return make_tables(coding); });
    if (!kept) return json_error(kept.error());
    return answer_with(call.request, entity_of(*kept, "application/json"));
}

}  // namespace stormcellar::web
