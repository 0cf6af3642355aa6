#include "batch/recipe.h"

#include <span>

#include <nlohmann/json.hpp>

#include "base/checksum.h"
#include "pipeline/drop/archive_volumes.h"
#include "stormcellar/base/version.h"

namespace stormcellar::batch {
namespace {

using Json = nlohmann::ordered_json;
using grid::GridSpec;

Json json_of_spec(const GridSpec& spec) {
    return {{"projection", grid::projection_name(spec.projection)},
            {"center_deg", {spec.center_latitude_deg, spec.center_longitude_deg}},
            {"spacing_m", spec.spacing_m},
            {"spacing_deg", spec.spacing_deg},
            {"parallels_deg", spec.parallels_deg},
            {"nx", spec.nx},
            {"ny", spec.ny},
            {"levels_m", spec.levels_m}};
}

// The readers below throw the exceptions of nlohmann::json, which recipe_of() catches.
GridSpec spec_of(const Json& json) {
    GridSpec spec;
    const auto projection = grid::projection_from_name(json.at("projection").get<std::string>());
    if (!projection) throw std::domain_error("its projection is not known");
    spec.projection = *projection;
    spec.center_latitude_deg = json.at("center_deg").at(0);
    spec.center_longitude_deg = json.at("center_deg").at(1);
    spec.spacing_m = json.at("spacing_m");
    spec.spacing_deg = json.at("spacing_deg");
    json.at("parallels_deg").get_to(spec.parallels_deg);
    spec.nx = json.at("nx");
    spec.ny = json.at("ny");
    json.at("levels_m").get_to(spec.levels_m);
    return spec;
}

Json json_of_domain(const pipeline::Domain& domain) {
    Json json{{"name", domain.name},
              {"grid", json_of_spec(domain.spec)},
              {"stations", domain.stations},
              {"interval_s", domain.interval.count()},
              {"overlap_length_m", domain.overlap_length_m},
              {"time", grid::time_method_name(domain.time)}};
    if (domain.overlap) json["overlap"] = grid::overlap_name(*domain.overlap);
    return json;
}

pipeline::Domain domain_of(const Json& json, const std::vector<level2::Moment>& moments) {
    pipeline::Domain domain;
    domain.name = json.at("name");
    domain.spec = spec_of(json.at("grid"));
    domain.moments = moments;
    json.at("stations").get_to(domain.stations);
    domain.interval = std::chrono::seconds{json.at("interval_s").get<long>()};
    domain.overlap_length_m = json.at("overlap_length_m");
    const auto time = grid::time_method_from_name(json.at("time").get<std::string>());
    if (!time || domain.interval.count() < 1) throw std::domain_error("its times make no sense");
    domain.time = *time;
    if (json.contains("overlap")) {
        domain.overlap = grid::overlap_from_name(json.at("overlap").get<std::string>());
        if (!domain.overlap) throw std::domain_error("its overlap is not known");
    }
    return domain;
}

UtcTime time_of(const Json& json) {
    const auto time = parse_utc(json.get<std::string>(), UtcTime{});
    if (!time) throw std::domain_error(time.error().message);
    return *time;
}

// Reads how moments are derived. A plan of an older version lacks these keys, so the defaults
// apply.
retrieve::DerivedOptions derived_of(const Json& json) {
    retrieve::DerivedOptions derived;
    derived.quality = json.value("quality", derived.quality);
    if (!(derived.quality >= 0 && derived.quality <= 1))
        throw std::domain_error("its quality is not from 0 to 1");
    if (json.contains("storm_motion")) {
        const auto motion =
            retrieve::motion_choice_from(json.at("storm_motion").get<std::string>());
        if (!motion) throw std::domain_error(motion.error().message);
        derived.motion = *motion;
    }
    if (!json.contains("dealias")) return derived;
    const auto rung = retrieve::dealiasing_from_name(json.at("dealias").get<std::string>());
    if (!rung) throw std::domain_error("its dealiasing is not known");
    derived.dealiasing = *rung;
    return derived;
}

Recipe read_recipe(const Json& json) {
    Recipe recipe;
    recipe.source = json.at("source");
    recipe.cache = json.at("cache").get<std::string>();
    recipe.from = time_of(json.at("from"));
    recipe.to = time_of(json.at("to"));
    recipe.moments.clear();
    for (const Json& name : json.at("moments")) {
        const auto moment = level2::moment_from_name(name.get<std::string>());
        if (!moment) throw std::domain_error("one of its moments is not known");
        recipe.moments.push_back(*moment);
    }
    if (recipe.moments.empty()) throw std::domain_error("it has no moment");
    recipe.derived = derived_of(json);
    if (json.contains("domain")) {
        recipe.domain = domain_of(json.at("domain"), recipe.moments);
        if (json.at("statistics")) {
            recipe.statistics = json.at("cell_statistics") ? grid::Tallied::columns_and_cells
                                                           : grid::Tallied::columns;
        }
        return recipe;
    }
    const Json& own = json.at("own_grids");
    recipe.spacing_m = own.at("spacing_m");
    recipe.nx = own.at("nx");
    recipe.ny = own.at("ny");
    own.at("levels_m").get_to(recipe.levels_m);
    return recipe;
}

}  // namespace

std::string Recipe::domain_of(const std::string& station) const {
    return domain ? domain->name + "." + station : station;
}

std::chrono::milliseconds Recipe::margin() const {
    return domain ? std::chrono::milliseconds{pipeline::farthest_neighbour}
                  : std::chrono::milliseconds{0};
}

pipeline::ArchiveOptions Recipe::archive_options(int threads) const {
    return {.moment = moments.front(),
            .derived = derived,
            .domain = domain,
            .spacing_m = spacing_m,
            .nx = nx,
            .ny = ny,
            .levels_m = levels_m,
            .threads = threads};
}

bool is_address(const std::string& source) {
    return source.starts_with("http://") || source.starts_with("https://");
}

Json json_of(const Recipe& recipe) {
    Json moments = Json::array();
    for (const level2::Moment moment : recipe.moments)
        moments.push_back(level2::moment_name(moment));
    Json json{{"source", recipe.source},
              {"cache", recipe.cache.native()},
              {"from", format_utc(recipe.from)},
              {"to", format_utc(recipe.to)},
              {"moments", moments},
              {"dealias", retrieve::dealiasing_name(recipe.derived.dealiasing)},
              {"quality", recipe.derived.quality}};
    // Plans with the default keep their hash.
    if (recipe.derived.motion.rule != retrieve::MotionChoice{}.rule)
        json["storm_motion"] = retrieve::motion_choice_text(recipe.derived.motion);
    if (recipe.domain) {
        json["domain"] = json_of_domain(*recipe.domain);
        json["statistics"] = recipe.statistics.has_value();
        json["cell_statistics"] = recipe.statistics == grid::Tallied::columns_and_cells;
    } else {
        json["own_grids"] = {{"spacing_m", recipe.spacing_m},
                             {"nx", recipe.nx},
                             {"ny", recipe.ny},
                             {"levels_m", recipe.levels_m}};
    }
    return json;
}

Result<Recipe> recipe_of(const Json& json) {
    try {
        return read_recipe(json);
    } catch (const std::exception& error) {
        return fail(ErrorCode::corrupt, "the recipe of the plan is damaged: {}", error.what());
    }
}

std::string hash_of(const Recipe& recipe) {
    const std::string text = json_of(recipe).dump() + std::string(software_version);
    return fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(text))));
}

}  // namespace stormcellar::batch
