// stormcellar cache list|stat|verify: the grid cache, from outside the daemon.
#include <memory>

#include <nlohmann/json.hpp>

#include "cache/store.h"
#include "cli/commands.h"
#include "cli/query_options.h"

namespace stormcellar::cli {
namespace {

using cache::Store;
using cache::StoreEntry;

struct CacheOptions {
    std::string directory;
    std::string domain;
    TimeRangeOptions times;
    bool json = false;
};

// Every grid that the options name, of one domain or of all, whatever its moment.
Result<std::vector<StoreEntry>> matching(const CacheOptions& options) {
    const auto range = parse_time_range(options.times);
    if (!range) return pass_on(range);
    const auto store = Store::open_for_reading(options.directory);
    if (!store) return pass_on(store);
    auto domains = store->domains();
    if (!domains) return pass_on(domains);
    if (!options.domain.empty()) *domains = {options.domain};
    std::vector<StoreEntry> all;
    for (const std::string& domain : *domains) {
        for (const level2::Moment moment : level2::all_moments) {
            const auto entries = store->list(domain, moment, range->from, range->to);
            if (!entries) return pass_on(entries);
            all.insert(all.end(), entries->begin(), entries->end());
        }
    }
    return all;
}

int run_list(const CacheOptions& options, const std::vector<StoreEntry>& entries) {
    nlohmann::json document = nlohmann::json::array();
    for (const StoreEntry& entry : entries) {
        if (options.json) {
            document.push_back({{"domain", entry.domain},
                                {"moment", level2::moment_name(entry.moment)},
                                {"time", format_utc(entry.time)},
                                {"bytes", entry.bytes_on_disk},
                                {"path", entry.path.string()}});
        } else {
            fmt::print("{:<12}  {}  {:<24}  {:>9} bytes  {}\n", entry.domain,
                       level2::moment_name(entry.moment), format_utc(entry.time),
                       entry.bytes_on_disk, printable(entry.path.native()));
        }
    }
    if (options.json) print_json(document);
    return exit_done;
}

struct DomainTotal {
    std::string domain;
    std::size_t grids = 0;
    std::uint64_t bytes = 0;
    UtcTime oldest, latest;
};

int run_stat(const CacheOptions& options, const std::vector<StoreEntry>& entries) {
    std::vector<DomainTotal> totals;
    for (const StoreEntry& entry : entries) {
        if (totals.empty() || totals.back().domain != entry.domain) {
            totals.push_back({entry.domain, 0, 0, entry.time, entry.time});
        }
        DomainTotal& total = totals.back();
        ++total.grids;
        total.bytes += entry.bytes_on_disk;
        total.oldest = std::min(total.oldest, entry.time);
        total.latest = std::max(total.latest, entry.time);
    }
    nlohmann::json document = nlohmann::json::array();
    for (const DomainTotal& total : totals) {
        if (options.json) {
            document.push_back({{"domain", total.domain},
                                {"grids", total.grids},
                                {"bytes", total.bytes},
                                {"oldest", format_utc(total.oldest)},
                                {"latest", format_utc(total.latest)}});
        } else {
            fmt::print("{:<12}  {:>6} grids  {:>12} bytes  {} to {}\n", total.domain, total.grids,
                       total.bytes, format_utc(total.oldest), format_utc(total.latest));
        }
    }
    if (options.json) print_json(document);
    return exit_done;
}

int run_verify(const CacheOptions& options, const std::vector<StoreEntry>& entries) {
    nlohmann::json bad = nlohmann::json::array();
    for (const StoreEntry& entry : entries) {
        const auto file = cache::GridFile::open(entry.path);
        const Status whole = file ? file->verify() : Status(pass_on(file));
        if (whole) continue;
        bad.push_back({{"path", entry.path.string()}, {"message", whole.error().message}});
        if (!options.json) report_error(whole.error());
    }
    if (options.json) {
        print_json({{"checked", entries.size()}, {"bad", bad}});
    } else {
        fmt::print("{} grids checked, {} bad\n", entries.size(), bad.size());
    }
    return bad.empty() ? exit_done : exit_failed;
}

}  // namespace

Command add_cache(CLI::App& app) {
    CLI::App* command = app.add_subcommand("cache", "Look into the cache of grids");
    command->require_subcommand(1);
    const auto options = std::make_shared<CacheOptions>();
    CLI::App* list = command->add_subcommand("list", "Every grid, oldest first");
    CLI::App* stat = command->add_subcommand("stat", "Totals of each domain");
    CLI::App* verify = command->add_subcommand("verify", "Read every grid and check it");
    for (CLI::App* one : {list, stat, verify}) {
        one->add_option("--cache", options->directory, "The cache's directory")->required();
        one->add_option("--domain", options->domain, "One domain; all when left out");
        add_time_range(*one, options->times);
        one->add_flag("--json", options->json, "Print one JSON document");
    }
    return {command, [=]() -> int {
                const auto entries = matching(*options);
                if (!entries) return report_error(entries.error());
                const int status = stat->parsed()     ? run_stat(*options, *entries)
                                   : verify->parsed() ? run_verify(*options, *entries)
                                                      : run_list(*options, *entries);
                return entries->empty() ? report_nothing_matched() : status;
            }};
}

}  // namespace stormcellar::cli
