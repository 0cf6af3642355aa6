// Operations that return storms as GeoJSON (RFC 7946): cells and places of rotation.
#include "web/doors/api/operations.h"
#include "web/doors/storms/storm_answers.h"

namespace stormcellar::web {
namespace {

Answer storms_of(const ApiCall& call, StormText text) {
    const auto& storms = call.state.sources().storms;
    if (!storms) return json_error(404, "no cache is served");
    StormQuery query;
    if (const auto area = call.request.parameter("area")) query.area = std::string(*area);
    const auto at = time_parameter(call, "time");
    if (!at) return json_error(at.error());
    query.at = *at;
    const auto wanted = storms->want(text, std::move(query), coding_for(call.request));
    if (!wanted) return json_error(wanted.error());
    if (const auto kept = storms->find(*wanted)) return storm_answer(call.request, text, *kept);
    if (call.must_be_quick) return takes_long();
    const auto made = storms->make(*wanted);
    if (!made) return json_error(made.error());
    return storm_answer(call.request, text, *made);
}

}  // namespace

Answer api_cells(const ApiCall& call) {
    return storms_of(call, StormText::cells_geojson);
}

Answer api_rotation(const ApiCall& call) {
    return storms_of(call, StormText::rotation_geojson);
}

}  // namespace stormcellar::web
