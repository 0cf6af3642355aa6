#include "daemon/reporter.h"

#include <spdlog/spdlog.h>

#include "base/printable.h"
#include "base/utc_time.h"
#include "daemon/status.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestOutcome;
using pipeline::IngestResult;

// "KTLX 2022-03-17T00:08:42Z NAME": what the event is about.
std::string subject(const Finished& finished) {
    const IngestOutcome& outcome = finished.taken->ingest;
    return fmt::format("{} {} {}", outcome.station.empty() ? "????" : printable(outcome.station),
                       outcome.volume_time ? format_utc(*outcome.volume_time) : "-",
                       printable(finished.job.path.native()));
}

std::string because(const IngestOutcome& outcome) {
    return outcome.reason.empty() ? "" : fmt::format(" ({})", printable(outcome.reason));
}

std::string describe_gridded(const Finished& finished) {
    const IngestOutcome& outcome = finished.taken->ingest;
    const std::optional<double> latency = latency_of(finished);
    const double took_s = std::chrono::duration<double>(finished.ended - finished.started).count();
    return fmt::format("gridded {}{}: {}, read {:.0f} decode {:.0f} grid {:.0f} commit {:.0f} ms{}",
                       outcome.partial ? "partial " : "", subject(finished),
                       latency ? fmt::format("{:.0f} ms after close", *latency * 1000)
                               : fmt::format("{:.0f} ms", took_s * 1000),
                       outcome.read_s * 1000, outcome.decode_s * 1000, outcome.grid_s * 1000,
                       outcome.commit_s * 1000, because(outcome));
}

void log_held_back(RateLimit& limit, SteadyTime now, std::string_view what) {
    if (const auto count = limit.take_held_back(now)) {
        spdlog::warn("{} more {}, not shown one by one", *count, what);
    }
}

}  // namespace

std::string describe(const Finished& finished) {
    if (!finished.taken) {
        return fmt::format("cannot store {}: {}; trying again in {} s",
                           printable(finished.job.path.native()),
                           printable(finished.taken.error().message),
                           Schedule::retry_delay(finished.job.failures + 1).count());
    }
    const IngestOutcome& outcome = finished.taken->ingest;
    switch (outcome.result) {
        case IngestResult::gridded:
            return describe_gridded(finished);
        case IngestResult::no_moment:
            return fmt::format("nothing to grid {}{}", subject(finished), because(outcome));
        case IngestResult::no_position:
            return fmt::format("no position for {}{}", subject(finished), because(outcome));
        case IngestResult::incomplete:
            return fmt::format("waiting for the rest of {}{}", subject(finished), because(outcome));
        case IngestResult::rejected:
            return fmt::format("rejected {}{}", subject(finished), because(outcome));
        case IngestResult::unchanged:
            return fmt::format("unchanged {}", printable(finished.job.path.native()));
        case IngestResult::vanished:
            return fmt::format("gone {}", printable(finished.job.path.native()));
        case IngestResult::registered:
            return fmt::format("registered {}", subject(finished));
    }
    return {};
}

void Reporter::report(const Finished& finished, SteadyTime now) {
    if (!finished.taken) {
        if (failures_.allow(now)) spdlog::error("{}", describe(finished));
        return;
    }
    switch (finished.taken->ingest.result) {
        case IngestResult::gridded:
            spdlog::info("{}", describe(finished));
            break;
        case IngestResult::rejected:
        case IngestResult::no_position:
            if (rejected_.allow(now)) spdlog::warn("{}", describe(finished));
            break;
        case IngestResult::no_moment:
            if (rejected_.allow(now)) spdlog::info("{}", describe(finished));
            break;
        case IngestResult::incomplete:
        case IngestResult::unchanged:
        case IngestResult::vanished:
        case IngestResult::registered:
            spdlog::debug("{}", describe(finished));
            break;
    }
}

void Reporter::report_directory(const Error& error, SteadyTime now) {
    if (!directories_.allow(now)) return;
    const bool is_blind = error.code == ErrorCode::no_space || error.code == ErrorCode::unsupported;
    spdlog::warn("{}{}", printable(error.message),
                 is_blind ? "; the drop directory is polled ([watch] poll_seconds)" : "");
}

// Where the air is clear nothing can be told: that is no news, hour by hour.
void Reporter::report_sites(const pipeline::PairReport& report) {
    const std::string line =
        fmt::format("sites of {} at {}: {}", printable(report.domain), format_utc(report.instant),
                    pipeline::describe(report.found));
    if (pipeline::tells_anything(report.found)) {
        spdlog::info("{}", line);
    } else {
        spdlog::debug("{}", line);
    }
    for (const std::string& fault : report.faults)
        spdlog::warn("sites of {}: {}", printable(report.domain), fault);
}

void Reporter::report_held_back(SteadyTime now) {
    log_held_back(rejected_, now, "files rejected or with nothing to grid");
    log_held_back(failures_, now, "failures to store a file");
    log_held_back(directories_, now,
                  "entries of the drop directory that were left out, or cannot be watched or read");
}

}  // namespace stormcellar::daemon
