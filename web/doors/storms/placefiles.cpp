#include "web/doors/storms/placefiles.h"

#include <string>

#include <fmt/format.h>

namespace stormcellar::web {
namespace {

// Refuses unknown and repeated parameters, because a misspelled parameter would have no effect.
// Programs for placefiles add the place of their radar to each request: lat, lon and dist.
Result<StormQuery> placefile_query(const Request& request) {
    StormQuery query;
    for (const auto& [name, value] : request.query) {
        if (name == "lat" || name == "lon" || name == "dist" || name == "version") continue;
        if (name != "area") {
            return fail(ErrorCode::bad_argument, "there is no parameter '{}' of placefiles",
                        name.substr(0, 40));
        }
        if (query.area) return fail(ErrorCode::bad_argument, "area: the parameter comes twice");
        query.area = value;
    }
    return query;
}

}  // namespace

std::optional<Answer> PlacefilesDoor::answer_soon(const Request& request) {
    return answer_of(request, true);
}

Answer PlacefilesDoor::answer(const Request& request) {
    return *answer_of(request, false);
}

std::optional<Answer> PlacefilesDoor::answer_of(const Request& request, bool must_be_quick) {
    if (request.path != "/placefiles/cells.txt") return sentence(404, "There is cells.txt here.");
    const auto query = placefile_query(request);
    if (!query) return sentence(status_of(query.error()), query.error().message);
    const auto wanted = storms_->want(StormText::cells_placefile, *query, coding_for(request));
    if (!wanted) return sentence(status_of(wanted.error()), wanted.error().message);
    if (const auto kept = storms_->find(*wanted))
        return storm_answer(request, StormText::cells_placefile, *kept);
    if (must_be_quick) return std::nullopt;
    const auto made = storms_->make(*wanted);
    if (!made) return json_error(made.error());
    return storm_answer(request, StormText::cells_placefile, *made);
}

}  // namespace stormcellar::web
