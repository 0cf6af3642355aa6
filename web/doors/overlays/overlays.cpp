#include "web/doors/overlays/overlays.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "web/data/grids/text_answer.h"

namespace stormcellar::web {

Answer OverlaysDoor::answer(const Request& request) {
    constexpr std::string_view ending = ".geojson";
    const auto path = segments_of(request.path);
    if (path.size() == 1) {
        nlohmann::ordered_json names = nlohmann::ordered_json::array();
        for (const std::string& name : overlays_.names())
            names.push_back({{"name", name}});
        const nlohmann::ordered_json document = {{"overlays", std::move(names)}};
        return text_answer_to(request, "application/json", document.dump() + "\n");
    }
    std::string_view name = path[1];
    if (path.size() == 2 && name.ends_with(ending)) {
        name.remove_suffix(ending.size());
        if (const auto found = overlays_.geojson(name, coding_for(request))) {
            if (!*found) return json_error(found->error());
            Entity entity;
            entity.bytes = {(*found)->bytes};
            entity.content_type = "application/geo+json";
            entity.etag = (*found)->etag;
            entity.coding = coding_name((*found)->coding);
            entity.varies = true;
            return answer_with(request, std::move(entity));
        }
    }
    return sentence(404, "There are /overlays and /overlays/NAME.geojson here.");
}

}  // namespace stormcellar::web
