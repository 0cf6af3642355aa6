#include "web/doors/storms/storm_answers.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "stormcellar/export/cell_text.h"
#include "web/doors/api/call.h"
#include "web/doors/storms/rotation_json.h"

namespace stormcellar::web {
namespace {

struct StormTextFacts {
    std::string_view name, content_type;
    level2::Moment moment;
};
StormTextFacts storm_text_facts(StormText text) {
    switch (text) {
        case StormText::cells_geojson:
            return {"cells", geojson_type, level2::Moment::ref};
        case StormText::cells_placefile:
            return {"placefile", "text/plain; charset=utf-8", level2::Moment::ref};
        case StormText::rotation_geojson:
            return {"shear", geojson_type, level2::Moment::azsh};
    }
    return {};
}

ApiJson area_json(const StormArea& area) {
    const bool is_seen = !area.times.empty();
    return {{"area", area.name},
            {"time", is_seen ? ApiJson(format_utc(area.times.back())) : ApiJson()},
            {"from", is_seen ? ApiJson(format_utc(area.times.front())) : ApiJson()},
            {"grids", area.times.size()}};
}

ApiJson empty_collection() {
    return {
        {"type", "FeatureCollection"}, {"areas", ApiJson::array()}, {"features", ApiJson::array()}};
}

// Names of domains may hold any bytes.
std::string dumped_storms(const ApiJson& json) {
    return json.dump(-1, ' ', false, ApiJson::error_handler_t::replace) + "\n";
}

}  // namespace

Result<WantedStorms> StormAnswers::want(StormText text, StormQuery query, Coding coding) const {
    const StormTextFacts facts = storm_text_facts(text);
    query.moment = facts.moment;
    // If the area has grids, but none of shear, the answer says so instead of failing.
    const bool lacks_rotation = text == StormText::rotation_geojson && query.area &&
                                !scans_->grids()->newest(*query.area, facts.moment) &&
                                !scans_->grids()->moments(*query.area).empty();
    Result<std::vector<StormArea>> areas;
    if (!lacks_rotation) areas = storm_areas(*scans_->grids(), query);
    if (!areas) return pass_on(areas);
    std::string key = fmt::format("storms/{}/{}", facts.name, coding_name(coding));
    for (const StormArea& area : *areas) {
        key += fmt::format("/{}@{}", area.name, area.changes);
        if (!area.times.empty())
            key += fmt::format(":{}:{}", format_utc(area.times.back()), area.times.size());
    }
    return WantedStorms{text, std::move(*areas), coding, std::move(key)};
}

std::optional<Kept> StormAnswers::find(const WantedStorms& wanted) const {
    return kept_->find(wanted.key);
}

Result<Kept> StormAnswers::make(const WantedStorms& wanted) const {
    return kept_->find_or_make(wanted.key, [&]() -> Result<Kept> {
        const auto text = made(wanted);
        if (!text) return pass_on(text);
        return kept_compressed(*text, wanted.coding);
    });
}

Result<std::string> StormAnswers::made(const WantedStorms& wanted) const {
    switch (wanted.text) {
        case StormText::cells_geojson:
            return cells_geojson(wanted);
        case StormText::cells_placefile:
            return cells_placefile(wanted);
        case StormText::rotation_geojson:
            return rotation_geojson(wanted);
    }
    return std::string{};
}

Result<std::string> StormAnswers::cells_geojson(const WantedStorms& wanted) const {
    ApiJson all = empty_collection();
    for (const StormArea& area : wanted.areas) {
        const auto tracked = scans_->track(area);
        if (!tracked) return pass_on(tracked);
        all["areas"].push_back(area_json(area));
        ApiJson of_area = ApiJson::parse(cell_export::cells_geojson(*tracked), nullptr, false);
        // All areas have the levels of the configuration.
        for (const auto& [name, value] : of_area.items())
            if (!all.contains(name)) all[name] = value;
        for (ApiJson& feature : of_area["features"]) {
            feature["properties"]["area"] = area.name;
            all["features"].push_back(std::move(feature));
        }
    }
    return dumped_storms(all);
}

Result<std::string> StormAnswers::cells_placefile(const WantedStorms& wanted) const {
    std::vector<retrieve::TrackedCell> cells;
    for (const StormArea& area : wanted.areas) {
        auto tracked = scans_->track(area);
        if (!tracked) return pass_on(tracked);
        std::ranges::move(tracked->cells, std::back_inserter(cells));
    }
    return cell_export::cells_placefile(cells);
}

Result<std::string> StormAnswers::rotation_geojson(const WantedStorms& wanted) const {
    ApiJson all = empty_collection();
    Grids& grids = *scans_->grids();
    for (const StormArea& area : wanted.areas) {
        all["areas"].push_back(area_json(area));
        if (area.times.empty()) continue;
        const auto grid = grids.find(area.name, level2::Moment::azsh, area.times.back());
        // The grid was evicted since the times were listed.
        if (!grid && grid.error().code == ErrorCode::not_found) continue;
        if (!grid) return pass_on(grid);
        add_rotation(**grid, all["features"]);
        if (const Status whole = (*grid)->file.check_whole(); !whole) return pass_on(whole);
    }
    if (wanted.areas.empty()) all["reason"] = "there are no grids of AZSH";
    return dumped_storms(all);
}

Answer storm_answer(const Request& request, StormText text, const Kept& kept) {
    return answer_with(request, entity_of(kept, std::string(storm_text_facts(text).content_type)));
}

}  // namespace stormcellar::web
