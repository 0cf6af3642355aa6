// Operations on a region: a box over several sites, which is treated like a domain.
#include <algorithm>
#include <cmath>
#include <set>

#include "stormcellar/base/station_table.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

// Returns the name of a region, with its box. Three decimal places, some 100 m, keep the name
// short.
std::string region_text(const RegionBox& box) {
    const auto side = [](double degrees) { return std::round(degrees * 1e3) / 1e3; };
    return fmt::format("{},{},{},{}", side(box.west_deg), side(box.south_deg), side(box.east_deg),
                       side(box.north_deg));
}

ApiJson region_moment_json(const ApiCall& call, const RegionPlan& plan, const std::string& path) {
    ApiJson times = ApiJson::array();
    const auto instants = region_times(call.grids(), plan);
    const UtcTime newest = newest_believed(instants);
    for (const UtcTime time : instants)
        times.push_back(format_utc(time));
    ApiJson left_out = ApiJson::array(), reasons = ApiJson::object();
    for (const LeftOutSite& one : plan.left_out) {
        left_out.push_back(one.site);
        reasons[one.site] = one.reason;
    }
    return {{"moment", level2::moment_name(plan.moment)},
            {"units", level2::moment_units(plan.moment)},
            {"grids", instants.size()},
            {"newest", format_utc(newest)},
            {"age_s", std::floor(seconds_between(newest, now_utc()))},
            {"sites", plan.sites},
            {"left_out", std::move(left_out)},
            {"left_out_because", std::move(reasons)},
            {"nx", plan.spec.nx},
            {"ny", plan.spec.ny},
            {"spacing_m", plan.spec.spacing_m},
            {"halved", plan.halvings},
            {"path", fmt::format("{}/{}", path, level2::moment_name(plan.moment))},
            {"times", std::move(times)}};
}

}  // namespace

Answered<AskedRegion> asked_region(const ApiCall& call) {
    if (!call.state.sources().grids) return refuse(json_error(404, "this server serves no grids"));
    const auto box = region_box_of(call.path_value("region"));
    if (!box) return refuse(box.error());
    const auto moment = level2::moment_from_name(call.path_value("moment"));
    if (!moment) return refuse(json_error(404, "there is no such moment"));
    auto plan = plan_region(call.grids(), *box, *moment);
    if (!plan) return refuse(plan.error());
    return AskedRegion{region_text(*box), std::move(*plan)};
}

Answer api_regions(const ApiCall& call) {
    const auto sides = box_parameters(call);
    if (!sides) return json_error(sides.error());
    const auto box = region_box_of(region_text(*sides));
    if (!box) return json_error(box.error());
    if (!call.state.sources().grids) return json_error(404, "this server serves no grids");
    std::set<level2::Moment> known;
    for (const std::string& domain : call.grids().domains()) {
        if (!is_icao(domain)) continue;
        for (const level2::Moment moment : call.grids().moments(domain))
            known.insert(moment);
    }
    const std::string name = region_text(*box);
    ApiJson moments = ApiJson::array();
    std::optional<Error> why_not;
    for (const level2::Moment moment : known) {
        const auto plan = plan_region(call.grids(), *box, moment);
        if (plan && !region_times(call.grids(), *plan).empty())
            moments.push_back(region_moment_json(call, *plan, "/api/v1/regions/" + name));
        else if (!plan && (!why_not || plan.error().code == ErrorCode::bad_argument))
            why_not = plan.error();
    }
    if (moments.empty()) {
        return why_not ? json_error(*why_not)
                       : json_error(404, "no site with grids reaches this region");
    }
    return json_answer(call.request,
                       {{"domain", "region:" + name}, {"region", name}, {"moments", moments}});
}

Answer api_region_sites(const ApiCall& call) {
    const auto asked = asked_region(call);
    if (!asked) return asked.error();
    const auto time = parse_utc(call.path_value("time"), now_utc());
    if (!time) return json_error(404, time.error().message);
    const auto found = region_sites(call.grids(), asked->plan, *time);
    if (!found) return json_error(found.error());
    ApiJson sites = ApiJson::array(), left_out = ApiJson::object();
    for (const LeftOutSite& one : asked->plan.left_out)
        left_out[one.site] = one.reason;
    for (const RegionSite& site : *found) {
        if (!site.left_out_because.empty()) {
            left_out[site.site] = site.left_out_because;
            continue;
        }
        ApiJson volumes = ApiJson::array();
        for (const auto& volume : {site.before, site.after}) {
            if (!volume) continue;
            volumes.push_back({{"time", format_utc(volume->time)},
                               {"middle_s", std::round(RegionSite::seconds_to(*volume, *time))}});
        }
        sites.push_back({{"site", site.site}, {"volumes", std::move(volumes)}});
    }
    return json_answer(call.request, {{"domain", "region:" + asked->name},
                                      {"time", format_utc(*time)},
                                      {"sites", std::move(sites)},
                                      {"left_out_because", std::move(left_out)}});
}

}  // namespace stormcellar::web
