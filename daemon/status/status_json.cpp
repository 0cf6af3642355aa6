#include "daemon/status/status_json.h"

#include <algorithm>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/printable.h"
#include "stormcellar/base/version.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using Json = nlohmann::ordered_json;

Json number_or_null(std::optional<double> value) {
    if (!value) return nullptr;
    return *value;
}

Json json_of(const std::optional<cache::StoreUsage>& usage) {
    if (!usage) return nullptr;
    Json budget = nullptr;
    if (usage->budget_bytes) budget = *usage->budget_bytes;
    return {{"grids", usage->grids},      {"pinned", usage->pinned},
            {"bytes", usage->bytes},      {"budget_bytes", budget},
            {"evicted", usage->evicted},  {"evicted_bytes", usage->evicted_bytes},
            {"not_kept", usage->not_kept}};
}

Json json_of(const CatalogState& state) {
    Json troubles = Json::array();
    for (const auto& [station, reason] : state.troubles)
        troubles.push_back({{"station", printable(station)}, {"reason", printable(reason)}});
    return {{"stations", state.rule},
            {"further", state.further},
            {"most_further", state.most_further},
            {"left_alone", state.left_alone},
            {"some_left_alone", state.some_left_alone},
            {"troubles", troubles}};
}

Json json_of(const grid::Estimate& estimate) {
    if (!estimate.untold.empty()) return {{"untold", estimate.untold}};
    return {{"value", estimate.value}, {"standard_error", estimate.standard_error}};
}

Json json_of(const pipeline::PairReport& report) {
    const grid::SiteComparison& found = report.found;
    return {{"domain", report.domain},
            {"a", found.a},
            {"b", found.b},
            {"time", format_utc(report.instant)},
            {"bias_db", json_of(found.bias_db)},
            {"azimuth_deg", json_of(found.azimuth_deg)},
            {"elevation_deg", json_of(found.elevation_deg)},
            {"time_s", json_of(found.time_s)},
            {"cells", found.cells},
            {"correlation", found.correlation},
            {"apart_s", found.apart_s},
            {"faults", report.faults}};
}

Json time_or_null(const std::optional<UtcTime>& time) {
    if (!time) return nullptr;
    return format_utc(*time);
}

Json json_of(const std::vector<LoopState>& loops) {
    std::size_t running = 0;
    std::uint64_t restarts = 0;
    std::uint64_t made = 0;
    std::optional<UtcTime> last_made;
    auto each = Json::array();
    for (const LoopState& loop : loops) {
        running += loop.is_running ? 1 : 0;
        restarts += loop.restarts;
        made += loop.made;
        last_made = std::max(last_made, loop.last_made);
        Json problem = nullptr;
        if (!loop.last_problem.empty()) problem = loop.last_problem;
        each.push_back({{"name", loop.name},
                        {"running", loop.is_running},
                        {"restarts", loop.restarts},
                        {"made", loop.made},
                        {"last_made", time_or_null(loop.last_made)},
                        {"frames", loop.frames},
                        {"last_problem", problem}});
    }
    return {{"running", running},
            {"restarts", restarts},
            {"made", made},
            {"last_made", time_or_null(last_made)},
            {"each", each}};
}

Json age_or_null(const std::optional<UtcTime>& time, UtcTime now) {
    if (!time) return nullptr;
    return std::chrono::duration<double>(now - *time).count();
}

Json text_or_null(const std::string& text) {
    if (text.empty()) return nullptr;
    return text;
}

Json json_of(const MachineFacts& machine, UtcTime now) {
    return {{"name", machine.name},
            {"directory", machine.directory},
            {"late", machine.is_late},
            {"why", text_or_null(machine.why)},
            {"newest", time_or_null(machine.newest)},
            {"newest_age_s", age_or_null(machine.newest, now)},
            {"arrived", time_or_null(machine.arrived)},
            {"arrived_age_s", age_or_null(machine.arrived, now)},
            {"taken", machine.taken},
            {"refused", machine.refused},
            {"replaced", machine.replaced},
            {"last_problem", text_or_null(machine.last_problem)}};
}

Json json_of(const Timings& timings) {
    const LatencySummary summary = timings.summary();
    const auto known = [&](double value) {
        return number_or_null(summary.count == 0 ? std::nullopt : std::optional{value});
    };
    return {{"count", summary.count},
            {"median", known(summary.median)},
            {"p95", known(summary.p95)},
            {"max", known(summary.max)}};
}

// Returns an object with the counts above zero, by the name of the error.
Json json_of(const PerErrorCode<std::uint64_t>& counts) {
    Json document = Json::object();
    for (const ErrorCode code : all_error_codes) {
        const std::uint64_t count = counts.at(index_of(code));
        if (count > 0) document[std::string{name_of(code)}] = count;
    }
    return document;
}

Json json_of(const RecentVolume& volume) {
    return {{"file", volume.file},
            {"station", volume.station},
            {"time", volume.time},
            {"grids", volume.grids},
            {"latency_s", number_or_null(volume.latency_s)},
            {"antenna_to_cache_s", number_or_null(volume.antenna_s)},
            {"read_s", volume.read_s},
            {"decode_s", volume.decode_s},
            {"grid_s", volume.grid_s},
            {"commit_s", volume.commit_s}};
}

Json json_of(const RejectedFile& file) {
    return {{"file", file.file},
            {"station", file.station},
            {"at", format_utc(file.at)},
            {"by", file.code},
            {"reason", file.reason}};
}

Json json_of(const MissingChunks& missing) {
    Json number = nullptr;
    if (missing.volume_number) number = *missing.volume_number;
    return {{"volume_time", time_or_null(missing.volume_time)},
            {"volume_number", number},
            {"count", missing.count},
            {"numbers", missing.numbers}};
}

Json json_of(const std::string& name, const StationState& state, UtcTime now) {
    const auto count = [&](IngestResult result) { return state.results.at(index_of(result)); };
    Json antenna = json_of(state.antenna_to_cache);
    antenna["last"] = number_or_null(state.last_antenna_s);
    antenna["last_is_live"] = state.last_antenna_s && is_live(*state.last_antenna_s);
    antenna["not_live"] = state.not_live;
    Json missing = Json::array();
    for (const MissingChunks& volume : state.missing)
        missing.push_back(json_of(volume));
    return {{"station", printable(name)},
            {"volume_time", time_or_null(state.volume_time)},
            {"volume_age_s", age_or_null(state.volume_time, now)},
            {"newest_radial", time_or_null(state.newest_radial)},
            {"ingested_at", time_or_null(state.ingested_at)},
            {"ingested_age_s", age_or_null(state.ingested_at, now)},
            {"data_at", time_or_null(state.data_at)},
            {"data_age_s", age_or_null(state.data_at, now)},
            {"gridded", count(IngestResult::gridded)},
            {"partial", state.partial},
            {"rejected", count(IngestResult::rejected)},
            {"no_moment", count(IngestResult::no_moment)},
            {"no_position", count(IngestResult::no_position)},
            {"latency_s", json_of(state.close_to_cache)},
            {"living_grids", state.living},
            {"sweep_latency_s", json_of(state.close_to_living)},
            {"antenna_to_cache_s", antenna},
            {"missing_chunks", state.missing_chunks},
            {"missing", missing}};
}

Json json_of(const Unreadable& unreadable) {
    Json directories = Json::array();
    for (const auto& [directory, reason] : unreadable.named)
        directories.push_back({{"directory", printable(directory)}, {"reason", printable(reason)}});
    return {{"count", unreadable.count()}, {"directories", directories}};
}

Json listening_of(const StatusFacts& facts) {
    Json socket = nullptr;
    if (!facts.socket.empty()) socket = printable(facts.socket.native());
    Json port = nullptr;
    if (facts.http_port != 0) port = facts.http_port;
    return {{"socket", socket}, {"http_port", port}};
}

Json waiting_files_of(const StatusFacts& facts) {
    Json files = Json::array();
    for (const WaitingFile& file : facts.waiting_files)
        files.push_back({{"file", file.file}, {"left_s", file.left_s}});
    return files;
}

Json counts_of(const StatusFacts& facts, const Pending& pending, UtcTime now) {
    const auto count = [&](IngestResult result) { return facts.results.at(index_of(result)); };
    return {{"state", facts.state},
            {"pid", ::getpid()},
            {"version", software_version},
            {"started", format_utc(facts.started)},
            {"updated", format_utc(now)},
            {"drop", printable(facts.drop.native())},
            {"drop_lost", facts.drop_lost.empty() ? Json() : Json(facts.drop_lost)},
            {"unreadable", json_of(facts.unreadable)},
            {"cache", printable(facts.cache.native())},
            {"listening", listening_of(facts)},
            {"ingested", facts.ingested},
            {"grids", facts.grids},
            {"living_grids", facts.living},
            {"partial", facts.partial},
            {"rejected", count(IngestResult::rejected)},
            {"rejected_by", json_of(facts.rejected)},
            {"not_kept", facts.not_kept},
            {"lone_chunks", facts.lone_chunks},
            {"no_moment", count(IngestResult::no_moment)},
            {"no_position", count(IngestResult::no_position)},
            {"other_station", count(IngestResult::other_station)},
            {"unchanged", count(IngestResult::unchanged)},
            {"vanished", count(IngestResult::vanished)},
            {"failures", facts.failures},
            {"failures_by", json_of(facts.failed)},
            {"pending",
             {{"waiting", pending.waiting},
              {"running", pending.running},
              {"growing", pending.growing},
              {"retrying", pending.retrying},
              {"longest_wait_s", facts.longest_wait_s},
              {"waiting_files", waiting_files_of(facts)}}},
            {"overflows", facts.overflows},
            {"unseen", facts.unseen},
            {"living_left_out", facts.living_left_out},
            {"growing_given_up", facts.given_up},
            {"scans", facts.scans},
            {"directories", facts.directories},
            {"rolling", json_of(facts.usage)},
            {"catalog", json_of(facts.catalog)}};
}

}  // namespace

std::string status_json(const StatusFacts& facts, const Pending& pending, UtcTime now) {
    Json document = counts_of(facts, pending, now);
    document["latency_s"] = json_of(facts.close_to_cache);
    document["sweep_latency_s"] = json_of(facts.close_to_living);
    document["antenna_to_cache_s"] = json_of(facts.antenna_to_cache);
    document["antenna_to_cache_s"]["not_live"] = facts.not_live;
    const auto list = [&](const char* name) -> Json& { return document[name] = Json::array(); };
    Json& volumes = list("volumes");
    for (const RecentVolume& volume : facts.volumes)
        volumes.push_back(json_of(volume));
    Json& rejected = list("rejected_files");
    for (const RejectedFile& file : facts.rejected_files)
        rejected.push_back(json_of(file));
    Json& stations = list("stations");
    for (const auto& [name, state] : facts.stations.stations())
        stations.push_back(json_of(name, state, now));
    document["stations_left_out"] = facts.stations.left_out();
    Json& sites = list("sites");
    for (const auto& [key, report] : facts.sites)
        sites.push_back(json_of(report));
    Json& machines = list("machines");
    for (const MachineFacts& machine : facts.machines)
        machines.push_back(json_of(machine, now));
    const bool elsewhere = facts.loops.empty() && !facts.others_loops.empty();
    document["loops"] = json_of(elsewhere ? facts.others_loops : facts.loops);
    if (elsewhere) document["loops"]["elsewhere"] = true;
    // Replace invalid UTF-8. Texts were made printable before, but a name must never end the
    // service.
    return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string loops_json(const std::vector<LoopState>& loops, std::string_view state, UtcTime started,
                       UtcTime now) {
    const Json document = {{"state", state},
                           {"pid", ::getpid()},
                           {"version", software_version},
                           {"started", format_utc(started)},
                           {"updated", format_utc(now)},
                           {"loops", json_of(loops)}};
    return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace stormcellar::daemon
