// stormcellar cache list|stat|verify|evict|pin|unpin: inspects and changes the grid cache.
#include <cmath>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/query/cache_change.h"
#include "cli/shared/commands.h"
#include "cli/shared/progress.h"
#include "cli/shared/query_options.h"
#include "cli/shared/service_places.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/audit_row.h"

namespace stormcellar::cli {
namespace {

using cache::StoreEntry;
using cache::StoreReader;

struct CacheOptions {
    PlaceOption cache;
    std::string domain;
    TimeRangeOptions times;
    bool json = false;
};

// Returns the grids that the options select, in one domain or in all domains, of any moment.
Result<std::vector<StoreEntry>> matching(const CacheOptions& options) {
    const auto range = parse_time_range(options.times);
    if (!range) return pass_on(range);
    const auto store = StoreReader::open(options.cache.directory);
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
                                {"pinned", entry.pinned},
                                {"path", entry.path.string()}});
        } else {
            fmt::print("{:<12}  {}  {:<24}  {:>9} bytes  {}{}\n", entry.domain,
                       level2::moment_name(entry.moment), format_utc(entry.time),
                       entry.bytes_on_disk, entry.pinned ? "pinned  " : "",
                       printable(entry.path.native()));
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
    std::size_t pinned = 0;
    std::uint64_t pinned_bytes = 0;
};

// The newest grid of a domain and moment, with the result of its audit: how well it agrees with the
// gates of its volume.
struct AuditedGrid {
    StoreEntry entry;
    std::vector<grid::AuditRow> rows;
};
std::optional<AuditedGrid> newest_audit(const std::vector<StoreEntry>& entries,
                                        const std::string& domain, level2::Moment moment) {
    constexpr int most_tries = 10;
    int tries = 0;
    for (auto entry = entries.rbegin(); entry != entries.rend() && tries < most_tries; ++entry) {
        if (entry->domain != domain || entry->moment != moment) continue;
        ++tries;
        const auto file = cache::GridFile::open(entry->path);
        if (!file || file->description().provenance.audit.empty()) continue;
        return AuditedGrid{*entry, file->description().provenance.audit};
    }
    return std::nullopt;
}

nlohmann::json audit_json(const AuditedGrid& audited) {
    nlohmann::json rows = nlohmann::json::array();
    for (const grid::AuditRow& row : audited.rows) {
        rows.push_back(
            {{"elevation_deg", row.elevation_deg},
             {"range_from_m", row.range_from_m},
             {"range_to_m", std::isfinite(row.range_to_m) ? nlohmann::json(row.range_to_m)
                                                          : nlohmann::json(nullptr)},
             {"sampled", row.sampled},
             {"same_status", row.same_status},
             {"count", row.count},
             {"rms", row.rms},
             {"mean", row.mean}});
    }
    return {{"moment", level2::moment_name(audited.entry.moment)},
            {"time", format_utc(audited.entry.time)},
            {"unit", grid::difference_unit(audited.entry.moment)},
            {"rows", rows}};
}

void print_audit(const AuditedGrid& audited) {
    const std::string_view unit = grid::difference_unit(audited.entry.moment);
    fmt::print("  {} of {} against its gates: {}\n", level2::moment_name(audited.entry.moment),
               format_utc(audited.entry.time), grid::errors_text(grid::pooled(audited.rows), unit));
    for (const grid::AuditRow& row : grid::pooled_by_range(audited.rows))
        fmt::print("    {:<14} {}\n", grid::range_text(row), grid::errors_text(row, unit));
}

int run_stat(const CacheOptions& options, const std::vector<StoreEntry>& entries) {
    const UtcTime now = now_utc();
    std::vector<DomainTotal> totals;
    for (const StoreEntry& entry : entries) {
        if (totals.empty() || totals.back().domain != entry.domain) {
            totals.push_back({entry.domain, 0, 0, entry.time, entry.time, 0, 0});
        }
        DomainTotal& total = totals.back();
        ++total.grids;
        total.bytes += entry.bytes_on_disk;
        if (entry.pinned) {
            ++total.pinned;
            total.pinned_bytes += entry.bytes_on_disk;
        }
        total.oldest = std::min(total.oldest, entry.time);
        if (is_believed(entry.time, now) || !is_believed(total.latest, now)) {
            total.latest = std::max(total.latest, entry.time);
        }
    }
    nlohmann::json document = nlohmann::json::array();
    for (const DomainTotal& total : totals) {
        std::vector<AuditedGrid> audits;
        for (const level2::Moment moment : level2::all_moments) {
            auto audited = newest_audit(entries, total.domain, moment);
            if (audited) audits.push_back(std::move(*audited));
        }
        if (options.json) {
            document.push_back({{"domain", total.domain},
                                {"grids", total.grids},
                                {"bytes", total.bytes},
                                {"pinned", total.pinned},
                                {"pinned_bytes", total.pinned_bytes},
                                {"oldest", format_utc(total.oldest)},
                                {"latest", format_utc(total.latest)},
                                {"audits", nlohmann::json::array()}});
            for (const AuditedGrid& audited : audits)
                document.back()["audits"].push_back(audit_json(audited));
            continue;
        }
        fmt::print("{:<12}  {:>6} {:<5}  {:>12} bytes  {:>4} pinned  {} to {}\n", total.domain,
                   total.grids, plural(total.grids, "grid"), total.bytes, total.pinned,
                   format_utc(total.oldest), format_utc(total.latest));
        for (const AuditedGrid& audited : audits)
            print_audit(audited);
    }
    if (options.json) print_json(document);
    return exit_done;
}

int run_verify(const CacheOptions& options, const std::vector<StoreEntry>& entries) {
    nlohmann::json bad = nlohmann::json::array();
    std::size_t checked = 0;
    Progress progress("grids", entries.size(), !options.json);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        progress.show(i);
        const auto file = cache::GridFile::open(entries[i].path);
        const Status whole = file ? file->verify() : Status(pass_on(file));
        // If the grid is gone, a daemon may have evicted it since it was listed. That is no damage.
        const bool is_gone = !whole && whole.error().code == ErrorCode::not_found;
        checked += is_gone ? 0 : 1;
        if (whole || is_gone) continue;
        progress.clear();
        bad.push_back({{"path", entries[i].path.string()}, {"message", whole.error().message}});
        if (!options.json) report_error(whole.error());
    }
    progress.clear();
    if (options.json) {
        print_json({{"checked", checked}, {"bad", bad}});
    } else {
        fmt::print("{} {} checked, {} bad\n", checked, plural(checked, "grid"), bad.size());
    }
    return bad.empty() ? exit_done : exit_failed;
}

}  // namespace

Run set_up_cache(CLI::App& command) {
    command.require_subcommand(1);
    const auto options = std::make_shared<CacheOptions>();
    CLI::App* list = command.add_subcommand("list", "List the grids, oldest first");
    CLI::App* stat = command.add_subcommand("stat", "Show the totals of each domain");
    CLI::App* verify = command.add_subcommand("verify", "Read every grid and verify it");
    for (CLI::App* one : {list, stat, verify}) {
        add_place(*one, options->cache);
        one->add_option("--domain", options->domain, "Name of one domain. Default: all domains");
        add_time_range(*one, options->times);
        one->add_flag("--json", options->json, "Print one JSON document");
    }
    const Commands changes = add_cache_changes(command);
    return [=]() -> int {
        for (const Command& change : changes) {
            if (change.app->parsed()) return change.run();
        }
        if (Status found = options->cache.find(); !found) return report_error(found.error());
        const auto entries = matching(*options);
        if (!entries) return report_error(entries.error());
        const int status = stat->parsed()     ? run_stat(*options, *entries)
                           : verify->parsed() ? run_verify(*options, *entries)
                                              : run_list(*options, *entries);
        return entries->empty() ? report_nothing_matched() : status;
    };
}

}  // namespace stormcellar::cli
