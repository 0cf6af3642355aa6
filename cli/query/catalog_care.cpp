// stormcellar catalog check|rebuild: checks whether the catalog is sound, and repairs it.
#include "cli/query/catalog_care.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "catalog/check_catalog.h"
#include "cli/shared/commands.h"
#include "cli/shared/progress.h"
#include "cli/shared/query_options.h"
#include "pipeline/care/rebuild_catalog.h"
#include "pipeline/keep/instance_lock.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using catalog::CatalogCheck;
using catalog::ClearReport;
using catalog::Repair;
using catalog::StationCheck;
using catalog::Trouble;

// Returns the rule for known stations that --stations describes. For "any", the rule accepts every
// station that has a database.
Result<std::shared_ptr<StationRule>> rule_of(const CareOptions& options) {
    if (options.stations == "known") return std::make_shared<StationRule>();
    if (options.stations == "any") {
        auto any = std::make_shared<StationRule>(StationRule::any());
        Status admitted = catalog::admit_existing(options.directory, *any);
        if (!admitted) return pass_on(admitted);
        return any;
    }
    std::vector<std::string> listed;
    std::istringstream names(options.stations + ',');
    for (std::string name; std::getline(names, name, ',');) {
        if (name == "known") {
            for (const Station& station : all_stations())
                listed.emplace_back(station.icao);
        } else if (is_icao(name)) {
            listed.push_back(std::move(name));
        } else {
            return fail(ErrorCode::bad_argument,
                        "--stations takes known, any or ICAO identifiers such as KTLX, not '{}'",
                        name);
        }
    }
    return std::make_shared<StationRule>(StationRule::listed(listed));
}

// Returns the state directory, which a running daemon locks. The catalog is in state/catalog.
fs::path state_of(const std::string& catalog) {
    fs::path directory = fs::absolute(catalog).lexically_normal();
    if (!directory.has_filename()) directory = directory.parent_path();
    return directory.parent_path();
}

nlohmann::json texts_of(const std::vector<fs::path>& paths) {
    nlohmann::json texts = nlohmann::json::array();
    for (const fs::path& path : paths)
        texts.push_back(path.native());
    return texts;
}

nlohmann::json to_json(const std::vector<Trouble>& troubles) {
    nlohmann::json all = nlohmann::json::array();
    for (const Trouble& trouble : troubles)
        all.push_back({{"station", trouble.station}, {"error", trouble.error.message}});
    return all;
}

void print_check_json(const CatalogCheck& check, const ClearReport& cleared) {
    nlohmann::json stations = nlohmann::json::array();
    for (const StationCheck& one : check.stations) {
        stations.push_back({{"station", one.station},
                            {"database", one.database.native()},
                            {"known", one.is_known},
                            {"damage", one.damage},
                            {"files", one.files},
                            {"missing", texts_of(one.missing)},
                            {"unseen", texts_of(one.unseen)},
                            {"changed", texts_of(one.changed)}});
    }
    nlohmann::json removed = nlohmann::json::array();
    for (const catalog::ClearedDatabase& one : cleared.cleared)
        removed.push_back({{"station", one.station}, {"files", one.files}, {"there", one.there}});
    print_json({{"sound", check.is_sound()},
                {"stations", stations},
                {"cleared", removed},
                {"not_cleared", to_json(cleared.kept)},
                {"troubles", to_json(check.troubles)},
                {"set_aside", texts_of(check.set_aside)}});
}

void print_check(const CatalogCheck& check) {
    for (const StationCheck& one : check.stations) {
        const bool sound = one.damage.empty();
        fmt::print(
            "{:<8}  {:>6} {:<5}  {}{}\n", one.station.empty() ? "unknown" : one.station, one.files,
            plural(static_cast<std::uint64_t>(one.files), "file"),
            sound ? fmt::format(
                        "sound, {} missing, {} changed{}", one.missing.size(), one.changed.size(),
                        one.unseen.empty()
                            ? ""
                            : fmt::format(", {} that cannot be looked at", one.unseen.size()))
                  : "DAMAGED",
            one.is_known ? "" : ", not a known station");
        for (const std::string& line : one.damage)
            fmt::print("  {}: {}\n", printable(one.database.native()), printable(line));
        for (const fs::path& path : one.missing)
            fmt::print("  missing  {}\n", printable(path.native()));
        for (const fs::path& path : one.changed)
            fmt::print("  changed  {}\n", printable(path.native()));
        for (const fs::path& path : one.unseen)
            fmt::print("  unseen   {}\n", printable(path.native()));
    }
    for (const fs::path& path : check.set_aside)
        fmt::print("set aside before: {}\n", printable(path.native()));
    const auto others = std::count_if(check.stations.begin(), check.stations.end(),
                                      [](const StationCheck& one) { return !one.is_known; });
    if (others == 0) return;
    fmt::print(
        "{} of unknown stations; the daemon leaves such databases alone, and --clear-unknown "
        "removes them\n",
        others == 1 ? std::string{"1 database is"} : fmt::format("{} databases are", others));
}

void print_cleared(const ClearReport& report) {
    for (const catalog::ClearedDatabase& one : report.cleared) {
        fmt::print("{:<8}  removed, {} {}, {} of them will be read again\n", one.station, one.files,
                   plural(static_cast<std::uint64_t>(one.files), "file"), one.there);
    }
}

// Removes the databases of unknown stations. Fails if another process writes the catalog.
Result<ClearReport> clear_unknown(const CareOptions& options, const StationRule& stations) {
    const auto lock = pipeline::InstanceLock::acquire(state_of(options.directory));
    if (!lock) {
        return fail(lock.error().code, "databases can only be removed while no daemon runs: {}",
                    lock.error().message);
    }
    return catalog::clear_unknown(options.directory, stations);
}

nlohmann::json to_json(const Repair& repair) {
    return {{"station", repair.station},     {"database", repair.database.native()},
            {"damage", repair.damage},       {"set_aside", repair.set_aside.native()},
            {"kept_gone", repair.kept_gone}, {"to_read_again", repair.to_read_again},
            {"lost_at_most", repair.lost}};
}

void print_report(const pipeline::RebuildReport& report, bool json) {
    if (json) {
        nlohmann::json repairs = nlohmann::json::array(), problems = nlohmann::json::array();
        for (const Repair& repair : report.repairs)
            repairs.push_back(to_json(repair));
        for (const Error& problem : report.problems)
            problems.push_back(problem.message);
        print_json({{"repairs", repairs},
                    {"files", report.files},
                    {"unchanged", report.unchanged},
                    {"registered", report.registered},
                    {"rejected", report.rejected},
                    {"gone", report.gone},
                    {"problems", problems}});
        return;
    }
    for (const Repair& repair : report.repairs)
        fmt::print("{}\n", printable(catalog::describe(repair)));
    fmt::print(
        "{} {}: {} unchanged, {} registered, {} rejected; {} of files that are gone\n",
        report.files, plural(static_cast<std::uint64_t>(report.files), "file"), report.unchanged,
        report.registered, report.rejected,
        report.gone == 1 ? std::string{"1 row is"} : fmt::format("{} rows are", report.gone));
}

}  // namespace

int check_catalog(const CareOptions& options) {
    const auto rule = rule_of(options);
    if (!rule) return report_error(rule.error());
    ClearReport cleared;
    if (options.clear_unknown) {
        auto done = clear_unknown(options, **rule);
        if (!done) return report_error(done.error());
        cleared = std::move(*done);
    }
    const auto check = catalog::check_catalog(options.directory, options.station, rule->get());
    if (!check) {
        const int status = report_error(check.error());
        const bool unknown =
            check.error().code == ErrorCode::not_found && fs::is_directory(options.directory);
        return unknown ? exit_nothing_matched : status;
    }
    if (options.json) {
        print_check_json(*check, cleared);
    } else {
        print_cleared(cleared);
        print_check(*check);
    }
    for (const Trouble& trouble : cleared.kept)
        report_error(trouble.error);
    for (const Trouble& trouble : check->troubles)
        report_error(trouble.error);
    if (!cleared.kept.empty() || !check->is_sound()) return exit_failed;
    const bool is_empty = check->stations.empty() && cleared.cleared.empty();
    return is_empty ? report_nothing_matched() : exit_done;
}

int rebuild_catalog(const CareOptions& options) {
    const auto lock = pipeline::InstanceLock::acquire(state_of(options.directory));
    if (!lock) {
        fmt::print(stderr,
                   "stormcellar: the catalog can only be rebuilt while no daemon runs: {}\n",
                   printable(lock.error().message));
        return exit_failed;
    }
    const auto rule = rule_of(options);
    if (!rule) return report_error(rule.error());
    std::optional<Progress> progress;
    pipeline::RebuildOptions rebuild;
    rebuild.stations = *rule;
    rebuild.catalog = options.directory;
    rebuild.drop = options.drop;
    rebuild.station = options.station;
    rebuild.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    rebuild.progress = [&](std::size_t done, std::size_t all) {
        if (!progress) progress.emplace("files", all, !options.json);
        progress->show(done);
    };
    const auto report = pipeline::rebuild_catalog(rebuild);
    progress.reset();
    if (!report) return report_error(report.error());
    for (const Error& problem : report->problems)
        report_error(problem);
    print_report(*report, options.json);
    return report->problems.empty() ? exit_done : exit_failed;
}

}  // namespace stormcellar::cli
