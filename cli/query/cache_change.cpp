#include "cli/query/cache_change.h"

#include <cmath>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/byte_size.h"
#include "cache/evict.h"
#include "cache/pins.h"
#include "cli/shared/query_options.h"
#include "cli/shared/service_places.h"

namespace stormcellar::cli {
namespace {

using cache::StoreEntry;
using cache::StoreReader;

struct EvictOptions {
    PlaceOption cache;
    std::string domain;
    std::string to, bytes;
    std::optional<double> older_than_h;
    bool dry_run = false, json = false;
};

Result<cache::EvictionOrder> order_of(const EvictOptions& options) {
    cache::EvictionOrder order;
    order.domain = options.domain;
    if (options.to.empty() && options.bytes.empty() && !options.older_than_h) {
        return fail(ErrorCode::bad_argument,
                    "say what to remove: --to TIME, --bytes SIZE or --older-than HOURS");
    }
    if (!options.to.empty()) {
        const auto to = parse_utc(options.to, now_utc());
        if (!to) return fail(ErrorCode::bad_argument, "--to: {}", to.error().message);
        order.to = *to;
    }
    if (!options.bytes.empty()) {
        const auto bytes = parse_byte_size(options.bytes);
        if (!bytes) return fail(ErrorCode::bad_argument, "--bytes: {}", bytes.error().message);
        order.bytes = *bytes;
    }
    if (options.older_than_h) {
        if (!(*options.older_than_h >= 0 && *options.older_than_h <= 1e6)) {
            return fail(ErrorCode::bad_argument, "--older-than must be 0 to 1000000 hours, not {}",
                        *options.older_than_h);
        }
        order.older_than = std::chrono::milliseconds{std::llround(*options.older_than_h * 3.6e6)};
    }
    return order;
}

nlohmann::json json_of(const StoreEntry& entry) {
    return {{"domain", entry.domain},
            {"moment", level2::moment_name(entry.moment)},
            {"time", format_utc(entry.time)},
            {"bytes", entry.bytes_on_disk},
            {"path", entry.path.string()}};
}

void print_evicted(const EvictOptions& options, const cache::EvictionPlan& plan,
                   const std::vector<StoreEntry>& gone) {
    std::uint64_t bytes = 0;
    nlohmann::json list = nlohmann::json::array();
    for (const StoreEntry& entry : gone) {
        bytes += entry.bytes_on_disk;
        if (options.json) {
            list.push_back(json_of(entry));
        } else {
            fmt::print("{}\n", printable(entry.path.native()));
        }
    }
    if (options.json) {
        print_json({{"dry_run", options.dry_run},
                    {"evicted", list},
                    {"bytes", bytes},
                    {"looked_at", plan.looked_at},
                    {"pinned", plan.pinned}});
        return;
    }
    fmt::print("{} of {} {} {}, {}; {} {} pinned\n", gone.size(), plan.looked_at,
               plural(plan.looked_at, "grid"), options.dry_run ? "would be removed" : "removed",
               format_byte_size(bytes), plan.pinned, plan.pinned == 1 ? "is" : "are");
}

int run_evict(const EvictOptions& options) {
    const auto order = order_of(options);
    if (!order) return report_error(order.error());
    const auto store = StoreReader::open(options.cache.directory);
    if (!store) return report_error(store.error());
    const auto plan = cache::plan_eviction(*store, *order, now_utc());
    if (!plan) return report_error(plan.error());
    cache::EvictionReport report;
    if (!options.dry_run) report = cache::evict(real_file_system(), plan->victims);
    print_evicted(options, *plan, options.dry_run ? plan->victims : report.evicted);
    if (plan->looked_at == 0) return report_nothing_matched();
    int status = exit_done;
    for (const std::string& problem : report.problems)
        status = report_error({ErrorCode::io, problem});
    if (order->bytes && plan->bytes_left > *order->bytes) {
        status = report_error(
            {ErrorCode::over_budget,
             fmt::format("{} remain, because these grids are pinned or the newest of their domains",
                         format_byte_size(plan->bytes_left))});
    }
    return status;
}

struct PinOptions {
    PlaceOption cache;
    std::string domain;
    TimeRangeOptions times;
    bool json = false;
};

// Pins or unpins every grid of the domain in the range. Skips grids that were evicted in the
// meantime.
int run_pin(const PinOptions& options, bool pin) {
    const auto range = parse_time_range(options.times);
    if (!range) return report_error(range.error());
    const auto store = StoreReader::open(options.cache.directory);
    if (!store) return report_error(store.error());
    nlohmann::json changed = nlohmann::json::array();
    for (const level2::Moment moment : level2::all_moments) {
        const auto entries = store->list(options.domain, moment, range->from, range->to);
        if (!entries) return report_error(entries.error());
        for (const StoreEntry& entry : *entries) {
            // Unpinning gives false if the grid was not pinned.
            const Result<bool> done =
                pin ? cache::pin_grid(real_file_system(), entry.path).map([] { return true; })
                    : cache::unpin_grid(real_file_system(), entry.path);
            if (!done && done.error().code == ErrorCode::not_found) continue;
            if (!done) return report_error(done.error());
            if (!*done) continue;
            changed.push_back(json_of(entry));
            if (!options.json) fmt::print("{}\n", printable(entry.path.native()));
        }
    }
    if (options.json) print_json({{pin ? "pinned" : "unpinned", changed}});
    return changed.empty() ? report_nothing_matched() : exit_done;
}

Command add_evict(CLI::App& cache) {
    CLI::App* evict = cache.add_subcommand(
        "evict", "Remove the oldest grids, even while a daemon runs; pinned grids stay");
    const auto options = std::make_shared<EvictOptions>();
    add_place(*evict, options->cache);
    evict->add_option("--domain", options->domain,
                      "Name of one domain, whose partials are included. Default: all domains");
    evict->add_option("--to", options->to,
                      "Remove all grids up to and including this time, even the newest: UTC, or "
                      "relative as -1h or now");
    evict->add_option(
        "--bytes", options->bytes,
        "Remove the oldest grids until the rest take at most this much, such as 20 GB. The grids "
        "of unknown stations go first, and the newest grid of each other domain stays");
    evict->add_option("--older-than", options->older_than_h,
                      "Remove the grids that are more than this many hours older than the newest "
                      "of their domain");
    evict->add_flag("--dry-run", options->dry_run, "Only print what would be removed");
    evict->add_flag("--json", options->json, "Print one JSON document");
    return {evict, [=] {
                if (Status found = options->cache.find(); !found)
                    return report_error(found.error());
                return run_evict(*options);
            }};
}

Command add_pin(CLI::App& cache, bool pin) {
    CLI::App* command =
        pin ? cache.add_subcommand("pin", "Pin grids, so that they stay until they are unpinned")
            : cache.add_subcommand("unpin", "Unpin grids, so that they may be removed again");
    const auto options = std::make_shared<PinOptions>();
    add_place(*command, options->cache);
    command->add_option("--domain", options->domain, "Domain of the grids")->required();
    add_time_range(*command, options->times);
    command->add_flag("--json", options->json, "Print one JSON document");
    return {command, [=] {
                if (Status found = options->cache.find(); !found)
                    return report_error(found.error());
                return run_pin(*options, pin);
            }};
}

}  // namespace

Commands add_cache_changes(CLI::App& cache) {
    return {add_evict(cache), add_pin(cache, true), add_pin(cache, false)};
}

}  // namespace stormcellar::cli
