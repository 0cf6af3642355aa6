#include "daemon/status/status.h"

#include <utility>
#include <variant>

#include "base/counted.h"
#include "base/printable.h"
#include "daemon/status/status_json.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;

constexpr std::size_t most_listed = 64;
constexpr std::size_t longest_reason = 512;

template <class T>
void push_bounded(std::deque<T>& queue, T value) {
    queue.push_back(std::move(value));
    if (queue.size() > most_listed) queue.pop_front();
}

}  // namespace

std::optional<double> latency_of(const Finished& finished) {
    if (!finished.job.closed_at) return std::nullopt;
    return std::chrono::duration<double>(finished.ended - *finished.job.closed_at).count();
}

StatusBook::StatusBook(std::filesystem::path drop, std::filesystem::path cache) {
    facts_.drop = std::move(drop);
    facts_.cache = std::move(cache);
}

void StatusBook::set_listening(std::filesystem::path socket, int http_port) {
    facts_.socket = std::move(socket);
    facts_.http_port = http_port;
}

bool StatusBook::set_unreadable(const Unreadable& directories) {
    if (facts_.unreadable == directories) return false;
    facts_.unreadable = directories;
    return true;
}

bool StatusBook::add(const Finished& finished, UtcTime at) {
    if (!finished.taken) {
        ++facts_.failures;
        ++facts_.failed.at(index_of(finished.taken.error().code));
        return true;
    }
    const pipeline::IngestOutcome& outcome = finished.taken->ingest;
    if (!rejected_.is_news(finished.job.path, outcome)) {
        facts_.stations.add_data(outcome.station, at);
        return false;
    }
    ++facts_.results.at(index_of(outcome.result()));
    facts_.living_left_out += outcome.living_left_out ? 1 : 0;
    facts_.given_up += outcome.given_up;
    facts_.lone_chunks +=
        outcome.lone_chunk && outcome.result() != IngestResult::incomplete ? 1 : 0;
    facts_.stations.add(outcome, latency_of(finished), at);
    if (!outcome.missing_chunks.empty()) {
        facts_.stations.add_missing_chunks(outcome.station,
                                           {.volume_time = outcome.volume_time,
                                            .volume_number = std::nullopt,
                                            .numbers = outcome.missing_chunks,
                                            .count = outcome.missing_chunks.size()});
    }
    if (!outcome.living.empty()) add_living(finished);
    if (outcome.result() == IngestResult::gridded) add_ingested(finished, at);
    if (const auto* rejected = std::get_if<pipeline::ended::Rejected>(&outcome.ending))
        add_rejected(finished, rejected->with, at);
    return true;
}

void StatusBook::add(pipeline::PairReport report) {
    const std::array<std::string, 3> key = {report.domain, report.found.a, report.found.b};
    facts_.sites.insert_or_assign(key, std::move(report));
}

void StatusBook::add_ingested(const Finished& finished, UtcTime at) {
    const pipeline::IngestOutcome& outcome = finished.taken->ingest;
    // Do not count a file as gridded if the cache kept none of its grids.
    if (outcome.grids.empty() && outcome.partials.empty() && outcome.not_kept > 0) {
        ++facts_.not_kept;
        return;
    }
    ++facts_.ingested;
    facts_.grids += outcome.grids.size();
    if (outcome.partial) ++facts_.partial;
    const std::optional<double> latency_s = latency_of(finished);
    if (latency_s) facts_.close_to_cache.add(*latency_s);
    const std::optional<double> antenna_s = antenna_latency_of(outcome, at);
    if (antenna_s && is_live(*antenna_s)) {
        facts_.antenna_to_cache.add(*antenna_s);
    } else if (antenna_s) {
        ++facts_.not_live;
    }
    push_bounded(facts_.volumes,
                 RecentVolume{printable(finished.job.path.native()), printable(outcome.station),
                              outcome.volume_time ? format_utc(*outcome.volume_time) : "",
                              outcome.grids.size(), latency_s, antenna_s, outcome.read_s,
                              outcome.decode_s, outcome.grid_s, outcome.commit_s});
}

void StatusBook::add_living(const Finished& finished) {
    facts_.living += finished.taken->ingest.living.size();
    if (const auto latency_s = latency_of(finished)) facts_.close_to_living.add(*latency_s);
}

void StatusBook::add_rejected(const Finished& finished, ErrorCode code, UtcTime at) {
    const pipeline::IngestOutcome& outcome = finished.taken->ingest;
    ++facts_.rejected.at(index_of(code));
    std::string file = printable(finished.job.path.native());
    std::erase_if(facts_.rejected_files, [&](const RejectedFile& one) { return one.file == file; });
    push_bounded(
        facts_.rejected_files,
        RejectedFile{std::move(file), printable(outcome.station),
                     printable(outcome.reason.substr(0, longest_reason)), name_of(code), at});
}

std::string StatusBook::json(const Pending& pending, UtcTime now) const {
    return status_json(facts_, pending, now);
}

std::string StatusBook::line(const Pending& pending) const {
    std::string lost;
    if (!facts_.drop_lost.empty()) {
        lost = fmt::format("waiting for the drop directory {}; ", facts_.drop_lost);
    } else if (const auto unreadable = facts_.unreadable.count(); unreadable > 0) {
        lost = fmt::format("cannot read {}; ", counted(unreadable, "directory", "directories"));
    }
    std::string latest;
    if (!facts_.volumes.empty()) {
        const RecentVolume& volume = facts_.volumes.back();
        latest = fmt::format(" (latest {} {})", volume.station, volume.time);
    }
    return fmt::format("{}ingested {}{}, rejected {}, waiting {}, running {}, growing {}", lost,
                       facts_.ingested, latest, facts_.results.at(index_of(IngestResult::rejected)),
                       pending.waiting, pending.running, pending.growing);
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
