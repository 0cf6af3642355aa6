#include "fetch/pull/grid_list.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <tuple>

#include <nlohmann/json.hpp>

namespace stormcellar::pull {
namespace {

using nlohmann::json;

std::string text_at(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

bool is_wanted(const std::string& domain, const PullSource& source) {
    if (!cache::is_domain_name(domain) || !cache::is_part(domain)) return false;
    const auto group = cache::group_of(domain);
    const auto has = [](const std::vector<std::string>& wanted, std::string_view name) {
        return wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
    };
    return has(source.domains, group) &&
           has(source.stations, std::string_view{domain}.substr(group.size() + 1));
}

std::optional<cache::GridName> name_of(const json& entry, UtcTime now) {
    if (!entry.is_object()) return std::nullopt;
    const auto moment = level2::moment_from_name(text_at(entry, "moment"));
    const std::string text = text_at(entry, "time");
    // Refuse "now" and "-1h", which parse_utc() accepts but which are no times of grids.
    if (!moment || !text.ends_with('Z')) return std::nullopt;
    const auto time = parse_utc(text, now);
    if (!time || !cache::is_possible(*time)) return std::nullopt;
    return cache::GridName{text_at(entry, "domain"), *moment, *time};
}

}  // namespace

std::string list_url(const PullSource& source, UtcTime from) {
    return fmt::format("{}/api/v1/grids?from={}&limit={}", source.url, format_utc(from),
                       most_listed);
}

std::string file_url(const PullSource& source, const cache::GridName& grid) {
    return fmt::format("{}/api/v1/grids/{}/{}/{}/file", source.url, grid.domain,
                       level2::moment_name(grid.moment), format_utc(grid.time));
}

Result<std::vector<cache::GridName>> parse_grid_list(std::span<const std::byte> text,
                                                     const PullSource& source, UtcTime from,
                                                     UtcTime now) {
    const auto* const begin = reinterpret_cast<const char*>(text.data());
    // Drop values that are nested more deeply than a list of grids is. A text that consists of
    // brackets would take a hundred times its size in memory.
    const auto is_kept = [](int depth, json::parse_event_t, const json&) { return depth <= 3; };
    const json all = json::parse(begin, begin + text.size(), is_kept, false);
    if (!all.is_object() || !all.contains("grids") || !all["grids"].is_array()) {
        return fail(ErrorCode::corrupt, "{}: the answer is not a list of grids", source.url);
    }
    std::vector<cache::GridName> grids;
    for (const json& entry : all["grids"]) {
        const auto name = name_of(entry, now);
        if (!name || !is_wanted(name->domain, source)) continue;
        if (name->time >= from && is_believed(name->time, now)) grids.push_back(*name);
    }
    std::ranges::sort(grids, [](const auto& a, const auto& b) {
        return std::tie(b.time, a.domain, a.moment) < std::tie(a.time, b.domain, b.moment);
    });
    grids.erase(std::unique(grids.begin(), grids.end()), grids.end());
    if (grids.size() > most_listed) grids.resize(most_listed);
    return grids;
}

}  // namespace stormcellar::pull
