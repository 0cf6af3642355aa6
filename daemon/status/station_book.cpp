#include "daemon/status/station_book.h"

#include <algorithm>
#include <utility>

namespace stormcellar::daemon {
namespace {

constexpr std::size_t most_missing_volumes = 8;
constexpr std::size_t most_missing_numbers = 64;

// Sets `newest` to the later of the two times. Ignores a time far in the future, because a radar's
// clock that is ahead must not hide that no more data arrive.
void advance(std::optional<UtcTime>& newest, std::optional<UtcTime> time, UtcTime now) {
    if (time && *time <= now + StationBook::most_ahead) newest = std::max(newest, time);
}

}  // namespace

std::optional<double> antenna_latency_of(const pipeline::IngestOutcome& outcome, UtcTime at) {
    if (!outcome.newest_radial) return std::nullopt;
    return std::chrono::duration<double>(at - *outcome.newest_radial).count();
}

bool is_live(double antenna_latency_s) {
    const auto seconds = [](auto duration) {
        return std::chrono::duration<double>(duration).count();
    };
    return antenna_latency_s >= -seconds(StationBook::most_ahead) &&
           antenna_latency_s <= seconds(StationBook::most_live_age);
}

StationState* StationBook::find(const std::string& station) {
    if (const auto known = stations_.find(station); known != stations_.end()) return &known->second;
    if (stations_.size() >= most_stations) {
        ++left_out_;
        return nullptr;
    }
    return &stations_[station];
}

void StationBook::add(const pipeline::IngestOutcome& outcome, std::optional<double> latency_s,
                      UtcTime at) {
    if (outcome.station.empty()) return;
    StationState* state = find(outcome.station);
    if (state == nullptr) return;
    state->data_at = std::max(state->data_at, std::optional{at});
    ++state->results.at(index_of(outcome.result()));
    state->living += outcome.living.size();
    if (!outcome.living.empty() && latency_s) state->close_to_living.add(*latency_s);
    if (outcome.result() != pipeline::IngestResult::gridded) return;
    state->ingested_at = std::max(state->ingested_at, std::optional{at});
    advance(state->volume_time, outcome.volume_time, at);
    advance(state->newest_radial, outcome.newest_radial, at);
    if (outcome.partial) ++state->partial;
    if (latency_s) state->close_to_cache.add(*latency_s);
    const std::optional<double> antenna_s = antenna_latency_of(outcome, at);
    if (!antenna_s) return;
    state->last_antenna_s = antenna_s;
    if (is_live(*antenna_s)) {
        state->antenna_to_cache.add(*antenna_s);
    } else {
        ++state->not_live;
    }
}

void StationBook::add_data(const std::string& station, UtcTime at) {
    if (station.empty()) return;
    if (StationState* state = find(station))
        state->data_at = std::max(state->data_at, std::optional{at});
}

void StationBook::add_missing_chunks(const std::string& station, MissingChunks missing) {
    StationState* state = find(station);
    if (state == nullptr) return;
    missing.count = std::max(missing.count, missing.numbers.size());
    if (missing.count == 0) return;
    if (missing.numbers.size() > most_missing_numbers) missing.numbers.resize(most_missing_numbers);
    state->missing_chunks += missing.count;
    state->missing.push_back(std::move(missing));
    if (state->missing.size() > most_missing_volumes) state->missing.pop_front();
}

void StationBook::add_known(const std::string& station, UtcTime newest_volume, UtcTime now) {
    if (station.empty() || newest_volume > now + most_ahead || now - newest_volume > known_for)
        return;
    if (StationState* state = find(station)) advance(state->volume_time, newest_volume, now);
}

}  // namespace stormcellar::daemon
