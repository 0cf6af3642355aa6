#include "fetch/pull/pull_status.h"

#include <nlohmann/json.hpp>

#include "stormcellar/base/version.h"

namespace stormcellar::pull {
namespace {

using nlohmann::ordered_json;

ordered_json time_json(const std::optional<UtcTime>& time) {
    return time ? ordered_json(format_utc(*time)) : ordered_json();
}

}  // namespace

std::string status_text(const std::vector<SourceStatus>& sources, UtcTime now) {
    ordered_json list = ordered_json::array();
    for (const SourceStatus& source : sources) {
        const char* const state = !source.error.empty() ? "failing"
                                  : source.answered     ? "answering"
                                                        : "starting";
        list.push_back({{"name", source.name},
                        {"url", source.url},
                        {"state", state},
                        {"error", source.error},
                        {"answered", time_json(source.answered)},
                        {"next_try", time_json(source.next_try)},
                        {"newest_grid", time_json(source.newest)},
                        {"grids", source.grids},
                        {"bytes", source.bytes},
                        {"pulled", source.pulled},
                        {"refused", source.refused},
                        {"removed", source.removed},
                        {"failures", source.failures}});
    }
    const ordered_json all = {
        {"time", format_utc(now)}, {"version", software_version}, {"sources", std::move(list)}};
    return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace stormcellar::pull
