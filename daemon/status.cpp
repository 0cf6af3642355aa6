#include "daemon/status.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/printable.h"
#include "base/version.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;

constexpr std::size_t most_latencies = 4096;
constexpr std::size_t most_volumes = 64;

template <class T>
void push_bounded(std::deque<T>& queue, T value, std::size_t most) {
    queue.push_back(std::move(value));
    if (queue.size() > most) queue.pop_front();
}

nlohmann::json number_or_null(std::optional<double> value) {
    if (!value) return nullptr;
    return *value;
}

nlohmann::ordered_json json_of(const std::optional<cache::StoreUsage>& usage) {
    if (!usage) return nullptr;
    nlohmann::ordered_json budget = nullptr;
    if (usage->budget_bytes) budget = *usage->budget_bytes;
    return {{"grids", usage->grids},      {"pinned", usage->pinned},
            {"bytes", usage->bytes},      {"budget_bytes", budget},
            {"evicted", usage->evicted},  {"evicted_bytes", usage->evicted_bytes},
            {"not_kept", usage->not_kept}};
}

nlohmann::ordered_json json_of(const grid::Estimate& estimate) {
    if (!estimate.untold.empty()) return {{"untold", estimate.untold}};
    return {{"value", estimate.value}, {"standard_error", estimate.standard_error}};
}

nlohmann::ordered_json json_of(const pipeline::PairReport& report) {
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

nlohmann::ordered_json time_or_null(const std::optional<UtcTime>& time) {
    if (!time) return nullptr;
    return format_utc(*time);
}

nlohmann::ordered_json json_of(const std::vector<LoopState>& loops) {
    std::size_t running = 0;
    std::uint64_t restarts = 0;
    std::uint64_t made = 0;
    std::optional<UtcTime> last_made;
    auto each = nlohmann::ordered_json::array();
    for (const LoopState& loop : loops) {
        running += loop.is_running ? 1 : 0;
        restarts += loop.restarts;
        made += loop.made;
        last_made = std::max(last_made, loop.last_made);
        nlohmann::ordered_json problem = nullptr;
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

}  // namespace

std::optional<double> latency_of(const Finished& finished) {
    if (!finished.job.closed_at) return std::nullopt;
    return std::chrono::duration<double>(finished.ended - *finished.job.closed_at).count();
}

LatencySummary summarise(std::vector<double> seconds) {
    LatencySummary summary;
    summary.count = seconds.size();
    if (seconds.empty()) return summary;
    std::sort(seconds.begin(), seconds.end());
    const auto rank = [&](double share) {
        const double nth = std::ceil(share * static_cast<double>(seconds.size()));
        return seconds[static_cast<std::size_t>(std::max(nth, 1.0)) - 1];
    };
    summary.median = rank(0.5);
    summary.p95 = rank(0.95);
    summary.max = seconds.back();
    return summary;
}

StatusBook::StatusBook(std::filesystem::path drop, std::filesystem::path cache)
    : drop_(std::move(drop)), cache_(std::move(cache)) {}

void StatusBook::count_scan(std::size_t directories) {
    ++scans_;
    directories_ = directories;
}

void StatusBook::add(const Finished& finished) {
    if (!finished.taken) {
        ++failures_;
        return;
    }
    const IngestResult result = finished.taken->ingest.result;
    ++results_.at(static_cast<std::size_t>(result));
    if (result == IngestResult::gridded) add_ingested(finished);
}

void StatusBook::add(pipeline::PairReport report) {
    const std::array<std::string, 3> key = {report.domain, report.found.a, report.found.b};
    sites_.insert_or_assign(key, std::move(report));
}

void StatusBook::add_ingested(const Finished& finished) {
    const pipeline::IngestOutcome& outcome = finished.taken->ingest;
    ++ingested_;
    grids_ += outcome.grids.size();
    if (outcome.partial) ++partial_;
    const std::optional<double> latency = latency_of(finished);
    if (latency) push_bounded(latencies_, *latency, most_latencies);
    push_bounded(
        volumes_,
        Volume{printable(finished.job.path.native()), printable(outcome.station),
               outcome.volume_time ? format_utc(*outcome.volume_time) : "", outcome.grids.size(),
               latency, outcome.read_s, outcome.decode_s, outcome.grid_s, outcome.commit_s},
        most_volumes);
}

std::string StatusBook::json(const Pending& pending, UtcTime now) const {
    const auto count = [this](IngestResult result) {
        return results_.at(static_cast<std::size_t>(result));
    };
    nlohmann::ordered_json document = {
        {"state", state_},
        {"pid", ::getpid()},
        {"version", software_version},
        {"started", format_utc(started_)},
        {"updated", format_utc(now)},
        {"drop", printable(drop_.native())},
        {"cache", printable(cache_.native())},
        {"ingested", ingested_},
        {"grids", grids_},
        {"partial", partial_},
        {"rejected", count(IngestResult::rejected)},
        {"no_moment", count(IngestResult::no_moment)},
        {"no_position", count(IngestResult::no_position)},
        {"unchanged", count(IngestResult::unchanged)},
        {"vanished", count(IngestResult::vanished)},
        {"failures", failures_},
        {"pending",
         {{"waiting", pending.waiting},
          {"running", pending.running},
          {"growing", pending.growing}}},
        {"overflows", overflows_},
        {"scans", scans_},
        {"directories", directories_},
        {"rolling", json_of(usage_)},
    };
    const LatencySummary latency = summarise({latencies_.begin(), latencies_.end()});
    const auto known = [&](double value) {
        return number_or_null(latency.count == 0 ? std::nullopt : std::optional{value});
    };
    document["latency_s"] = {{"count", latency.count},
                             {"median", known(latency.median)},
                             {"p95", known(latency.p95)},
                             {"max", known(latency.max)}};
    document["volumes"] = nlohmann::ordered_json::array();
    for (const Volume& volume : volumes_) {
        document["volumes"].push_back({{"file", volume.file},
                                       {"station", volume.station},
                                       {"time", volume.time},
                                       {"grids", volume.grids},
                                       {"latency_s", number_or_null(volume.latency_s)},
                                       {"read_s", volume.read_s},
                                       {"decode_s", volume.decode_s},
                                       {"grid_s", volume.grid_s},
                                       {"commit_s", volume.commit_s}});
    }
    document["sites"] = nlohmann::ordered_json::array();
    for (const auto& [key, report] : sites_)
        document["sites"].push_back(json_of(report));
    document["loops"] = json_of(loops_);
    // Texts were made printable; whatever else a name may bring must not end the service.
    return document.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string StatusBook::line(const Pending& pending) const {
    std::string latest;
    if (!volumes_.empty()) {
        latest = fmt::format(" (latest {} {})", volumes_.back().station, volumes_.back().time);
    }
    return fmt::format("ingested {}{}, rejected {}, waiting {}, running {}, growing {}", ingested_,
                       latest, results_.at(static_cast<std::size_t>(IngestResult::rejected)),
                       pending.waiting, pending.running, pending.growing);
}

std::string loops_json(const std::vector<LoopState>& loops, std::string_view state, UtcTime started,
                       UtcTime now) {
    const nlohmann::ordered_json document = {{"state", state},
                                             {"pid", ::getpid()},
                                             {"version", software_version},
                                             {"started", format_utc(started)},
                                             {"updated", format_utc(now)},
                                             {"loops", json_of(loops)}};
    return document.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string loops_line(const std::vector<LoopState>& loops) {
    std::size_t running = 0;
    std::uint64_t made = 0;
    for (const LoopState& loop : loops) {
        running += loop.is_running ? 1 : 0;
        made += loop.made;
    }
    return fmt::format("{} of {} loops run, made {}", running, loops.size(), made);
}

}  // namespace stormcellar::daemon
