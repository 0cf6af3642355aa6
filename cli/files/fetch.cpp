// stormcellar fetch --from T --to T --stations A,B|--bounds W,S,E,N -o DIR: downloads raw files
// from a public bucket.
#include "stormcellar/fetch/fetch.h"

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/byte_size.h"
#include "cli/shared/commands.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/progress.h"
#include "cli/shared/query_options.h"

namespace stormcellar::cli {
namespace {

struct FetchOptions {
    TimeRangeOptions times;
    std::string stations;
    std::string bounds;
    std::string directory;
    fetch::FetchRequest request;
    bool quiet = false;
    bool json = false;
};

Status complete_request(FetchOptions& options) {
    const auto range = parse_time_range(options.times);
    if (!range) return pass_on(range);
    if (!range->from || !range->to) {
        return fail(ErrorCode::bad_argument, "fetch needs --from and --to");
    }
    if (options.stations.empty() == options.bounds.empty()) {
        return fail(ErrorCode::bad_argument, "fetch needs either --stations or --bounds");
    }
    auto stations =
        options.bounds.empty() ? parse_stations(options.stations) : stations_within(options.bounds);
    if (!stations) return pass_on(stations);
    options.request.stations = std::move(*stations);
    options.request.from = *range->from;
    options.request.to = *range->to;
    options.request.directory = options.directory;
    return {};
}

nlohmann::json json_of(const fetch::FetchReport& report) {
    auto failures = nlohmann::json::array();
    for (const fetch::FetchFailure& failure : report.failures)
        failures.push_back({{"what", failure.what}, {"reason", failure.reason}});
    return {{"found", report.found},     {"fetched", report.fetched},
            {"present", report.present}, {"without_radials", report.without_radials},
            {"bytes", report.bytes},     {"failures", failures}};
}

int report_of(const FetchOptions& options, const fetch::FetchReport& report) {
    for (const fetch::FetchFailure& failure : report.failures) {
        fmt::print(stderr, "stormcellar: {}: {}\n", printable(failure.what),
                   printable(failure.reason));
    }
    if (options.json) {
        print_json(json_of(report));
    } else if (!options.quiet) {
        fmt::print(stderr, "fetched {} {} of {} {} ({}) into {}; {} were there already{}\n",
                   report.fetched, plural(report.fetched, "volume"),
                   options.request.stations.size(),
                   plural(options.request.stations.size(), "station"),
                   format_byte_size(report.bytes), printable(options.directory), report.present,
                   report.failures.empty()
                       ? ""
                       : fmt::format("; {} failed, and the same command tries them again",
                                     report.failures.size()));
    }
    if (!report.failures.empty()) return exit_failed;
    return report.found == 0 ? report_nothing_matched() : exit_done;
}

int run_fetch(FetchOptions options) {
    if (Status complete = complete_request(options); !complete) {
        return report_error(complete.error());
    }
    Interrupt interrupt;
    Progress progress("volumes", 0, !options.quiet && !options.json);
    options.request.stop = &interrupt.flag();
    options.request.progress = [&](const fetch::FetchProgress& now) {
        progress.show(now.done, now.files);
    };
    const auto report = fetch::fetch(options.request);
    progress.clear();
    if (!report) return report_error(report.error());
    if (report->stopped) {
        fmt::print(stderr,
                   "stormcellar: interrupted after {} {}; the same command continues from there\n",
                   report->fetched, plural(report->fetched, "volume"));
        interrupt.end_by_signal();
    }
    return report_of(options, *report);
}

}  // namespace

Run set_up_fetch(CLI::App& fetch) {
    const auto options = std::make_shared<FetchOptions>();
    add_time_range(fetch, options->times);
    fetch.add_option("--stations", options->stations,
                     "ICAO identifiers of the stations, such as KTLX,KFDR");
    fetch.add_option("--bounds", options->bounds,
                     "Fetch the stations within these bounds: WEST,SOUTH,EAST,NORTH in degrees");
    fetch
        .add_option("-o,--output", options->directory,
                    "Directory for the files; it is made if it does not exist")
        ->required();
    fetch
        .add_option("--source", options->request.source,
                    "Address of the bucket, which must answer as Amazon S3 does (ListObjectsV2)")
        ->capture_default_str();
    fetch.add_option("--parallel", options->request.parallel, "Number of transfers at a time")
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    fetch
        .add_option("--tries", options->request.tries,
                    "Number of times that each transfer is tried")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    fetch.add_flag("--quiet", options->quiet, "Print only what went wrong");
    fetch.add_flag("--json", options->json, "Print what was done as one JSON document");
    return [options] { return run_fetch(*options); };
}

}  // namespace stormcellar::cli
