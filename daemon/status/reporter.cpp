#include "daemon/status/reporter.h"

#include <variant>

#include "base/printable.h"
#include "daemon/queue/intake.h"
#include "daemon/status/status.h"
#include "daemon/status/status_names.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestOutcome;
using pipeline::IngestResult;

constexpr std::size_t longest_reason = 512;

// Returns the subject of a log line, such as "KTLX 2022-03-17T00:08:42Z NAME".
std::string subject(const Finished& finished) {
    const IngestOutcome& outcome = finished.taken->ingest;
    return fmt::format("{} {} {}", outcome.station.empty() ? "????" : printable(outcome.station),
                       outcome.volume_time ? format_utc(*outcome.volume_time) : "-",
                       printable(finished.job.path.native()));
}

std::string because(const IngestOutcome& outcome) {
    if (outcome.reason.empty()) return "";
    return fmt::format(" ({})", printable(outcome.reason.substr(0, longest_reason)));
}

std::string describe_gridded(const Finished& finished) {
    const IngestOutcome& outcome = finished.taken->ingest;
    const std::optional<double> latency = latency_of(finished);
    const double took_s = std::chrono::duration<double>(finished.ended - finished.started).count();
    return fmt::format(
        "gridded {}{}: {}; read {:.0f} ms, decode {:.0f} ms, grid {:.0f} ms, commit {:.0f} ms{}",
        outcome.partial ? "partial " : "", subject(finished),
        latency ? fmt::format("{:.0f} ms after close", *latency * 1000)
                : fmt::format("{:.0f} ms", took_s * 1000),
        outcome.read_s * 1000, outcome.decode_s * 1000, outcome.grid_s * 1000,
        outcome.commit_s * 1000, because(outcome));
}

// Returns true if the job added sweeps to the grid of a volume that is still growing.
bool shows_living(const IngestOutcome& outcome) {
    return outcome.result() != IngestResult::gridded && !outcome.living.empty();
}

std::string describe_living(const Finished& finished) {
    const std::optional<double> latency = latency_of(finished);
    return fmt::format("sweep of {}: gridded{}", subject(finished),
                       latency ? fmt::format(" {:.0f} ms after close", *latency * 1000)
                               : std::string{"; the close of its file was not seen"});
}

}  // namespace

std::string describe(const Finished& finished) {
    if (!finished.taken) {
        const Error& error = finished.taken.error();
        const int tries = finished.job.failures + 1;
        const std::string next =
            tries < Intake::most_tries || is_shortage(error.code)
                ? fmt::format("trying again in {} s", Schedule::retry_delay(tries).count())
                : fmt::format("gave up after {} tries until the next scan of the drop directory",
                              tries);
        return fmt::format("cannot store {}: {}; {}", printable(finished.job.path.native()),
                           printable(error.message), next);
    }
    const IngestOutcome& outcome = finished.taken->ingest;
    if (shows_living(outcome)) return describe_living(finished);
    switch (outcome.result()) {
        case IngestResult::gridded:
            return describe_gridded(finished);
        case IngestResult::no_moment:
            return fmt::format("nothing to grid in {}{}", subject(finished), because(outcome));
        case IngestResult::no_position:
            return fmt::format("no position for {}{}", subject(finished), because(outcome));
        case IngestResult::other_station:
            return fmt::format("not gridded {}{}", subject(finished), because(outcome));
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

About about(const Finished& finished) {
    if (!finished.taken) {
        return {.event = Event::store_failed,
                .file = finished.job.path,
                .reason = name_of(finished.taken.error().code)};
    }
    const IngestOutcome& outcome = finished.taken->ingest;
    About subject{.event = event_of(outcome.result()),
                  .station = printable(outcome.station),
                  .volume = outcome.volume_time,
                  .file = finished.job.path};
    if (const auto* rejected = std::get_if<pipeline::ended::Rejected>(&outcome.ending))
        subject.reason = name_of(rejected->with);
    if (shows_living(outcome)) subject.event = Event::living;
    if (!outcome.grids.empty() || !outcome.living.empty()) subject.latency_s = latency_of(finished);
    subject.took_s = std::chrono::duration<double>(finished.ended - finished.started).count();
    return subject;
}

void Reporter::report(const Finished& finished, Named named) {
    const auto level = [&] {
        if (!finished.taken) return named == Named::before ? LogLevel::debug : LogLevel::error;
        switch (finished.taken->ingest.result()) {
            case IngestResult::gridded:
                return finished.taken->ingest.no_room ? LogLevel::warning : LogLevel::info;
            case IngestResult::no_moment:
                return LogLevel::info;
            case IngestResult::rejected:
            case IngestResult::no_position:
            case IngestResult::other_station:
                return LogLevel::warning;
            default:
                return LogLevel::debug;
        }
    };
    log_line(level(), about(finished), describe(finished));
}

void Reporter::report_directory(const Error& error) {
    const bool is_blind = error.code == ErrorCode::no_space || error.code == ErrorCode::unsupported;
    log_warning(
        {.event = Event::directory_problem, .reason = name_of(error.code)}, "{}{}",
        printable(error.message),
        is_blind ? "; the service polls the drop directory instead ([watch] poll_seconds)" : "");
}

// Reports the differences between two sites. Writes no line if nothing could be determined, as
// happens every hour in clear air.
void Reporter::report_sites(const pipeline::PairReport& report) {
    const About compared{
        .event = Event::sites_compared, .volume = report.instant, .domain = report.domain};
    log_line(pipeline::tells_anything(report.found) ? LogLevel::info : LogLevel::debug, compared,
             fmt::format("compared sites of {} at {}: {}", printable(report.domain),
                         format_utc(report.instant), pipeline::describe(report.found)));
    About faulty = compared;
    faulty.event = Event::site_fault;
    for (const std::string& fault : report.faults)
        log_warning(faulty, "sites of {}: {}", printable(report.domain), fault);
}

}  // namespace stormcellar::daemon
