#include "pipeline/care/archive_plan.h"

#include <cstdlib>
#include <span>
#include <system_error>

#include <fmt/ranges.h>

#include "base/checksum.h"
#include "pipeline/drop/station_place.h"
#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/base/version.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;

std::string recipe_of(const grid::GridSpec& spec) {
    return fmt::format("{} {} {} {} {} {} {} {} {} {}", static_cast<int>(spec.projection),
                       spec.center_latitude_deg, spec.center_longitude_deg, spec.spacing_m,
                       spec.spacing_deg, spec.parallels_deg[0], spec.parallels_deg[1], spec.nx,
                       spec.ny, fmt::join(spec.levels_m, " "));
}

// Leaves out what has its default or does not change the moment.
std::string recipe_of(const retrieve::DerivedOptions& options, level2::Moment moment) {
    const retrieve::DerivedOptions usual;
    std::string text =
        fmt::format("{} {}\n", retrieve::dealiasing_name(options.dealiasing), options.quality);
    const std::string motion = retrieve::motion_choice_text(options.motion);
    if (moment == level2::Moment::srv && motion != retrieve::motion_choice_text(usual.motion))
        text += motion + "\n";
    if (moment == level2::Moment::hca && options.zero_c_m != usual.zero_c_m)
        text += fmt::format("{}\n", options.zero_c_m);
    return text;
}

}  // namespace

std::vector<grid::SitePosition> sites_of(const catalog::CatalogReader& catalog,
                                         const std::vector<std::string>& stations,
                                         std::vector<LeftOut>& left_out) {
    std::vector<grid::SitePosition> sites;
    for (const std::string& icao : stations) {
        if (icao.empty()) continue;  // files of no known station
        if (auto site = place_of_station(catalog, icao)) {
            sites.push_back(std::move(*site));
        } else {
            left_out.push_back(
                {{},
                 fmt::format("{}: neither its files nor the station table give its position",
                             icao)});
        }
    }
    return sites;
}

Result<fs::path> loops_directory() {
    const char* xdg = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    fs::path base = xdg != nullptr ? fs::path(xdg) : fs::path();
    if (!base.is_absolute()) {
        if (home == nullptr || !fs::path(home).is_absolute()) {
            return fail(ErrorCode::bad_argument,
                        "neither XDG_CACHE_HOME nor HOME says where grids may be kept: give "
                        "--cache");
        }
        base = fs::path(home) / ".cache";
    }
    return base / "stormcellar" / "loops";
}

Result<fs::path> private_cache(const fs::path& catalog_directory, level2::Moment moment,
                               const ArchivePlan& plan) {
    const auto base = loops_directory();
    if (!base) return base;
    std::error_code error;
    const fs::path catalog = fs::weakly_canonical(catalog_directory, error);
    std::string recipe = fmt::format("{}\n{}\n{}\n{}\n", software_version,
                                     (error ? catalog_directory : catalog).native(),
                                     level2::moment_name(moment), fmt::join(plan.stations, " "));
    recipe += recipe_of(plan.fill.derived, moment);
    if (plan.mosaic) {
        const auto rules = frame_options(*plan.mosaic, moment, 1);
        recipe += fmt::format("{}\n{}\n{} {} {}", plan.mosaic->name, recipe_of(plan.mosaic->spec),
                              grid::overlap_name(rules.overlap.overlap), rules.overlap.length_m,
                              grid::time_method_name(rules.time));
    } else {
        recipe += fmt::format("{} {} {} {}", plan.fill.spacing_m, plan.fill.nx, plan.fill.ny,
                              fmt::join(plan.fill.levels_m, " "));
    }
    const auto hash = xxh3_64(std::as_bytes(std::span(recipe.data(), recipe.size())));
    const std::string name = plan.mosaic ? plan.mosaic->name : plan.stations.front();
    return *base / fmt::format("{}-{}-{:016x}", name, level2::moment_name(moment), hash);
}

Status check_cache_directory(const fs::path& directory) {
    std::error_code error;
    for (const auto& domain : fs::directory_iterator(directory, error)) {
        const std::string name = domain.path().filename().string();
        if (name.starts_with('.')) continue;
        std::error_code inner;
        bool is_domain = domain.is_directory(inner);
        for (const auto& moment : fs::directory_iterator(domain.path(), inner)) {
            const std::string moment_name = moment.path().filename().string();
            is_domain = is_domain && (moment_name.starts_with('.') ||
                                      level2::moment_from_name(moment_name).has_value());
        }
        if (is_domain) continue;
        return fail(ErrorCode::bad_argument,
                    "--cache: {} is not a cache: it holds {}, which is not a grid",
                    directory.native(), name);
    }
    return {};
}

Result<std::vector<cache::StoreEntry>> entries_at(const cache::StoreReader& store,
                                                  const std::string& domain, level2::Moment moment,
                                                  const std::set<UtcTime>& times) {
    if (times.empty()) return std::vector<cache::StoreEntry>{};
    auto entries = store.list(domain, moment, *times.begin(), *times.rbegin());
    if (!entries) return entries;
    std::erase_if(*entries,
                  [&](const cache::StoreEntry& entry) { return !times.contains(entry.time); });
    return entries;
}

}  // namespace stormcellar::pipeline
