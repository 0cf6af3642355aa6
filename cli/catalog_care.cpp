// stormcellar catalog check|rebuild: is the catalog sound, and making it so.
#include "cli/catalog_care.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "catalog/check_catalog.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/query_options.h"
#include "pipeline/instance_lock.h"
#include "pipeline/rebuild_catalog.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using catalog::CatalogCheck;
using catalog::Repair;
using catalog::StationCheck;

nlohmann::json texts_of(const std::vector<fs::path>& paths) {
    nlohmann::json texts = nlohmann::json::array();
    for (const fs::path& path : paths)
        texts.push_back(path.native());
    return texts;
}

void print_check_json(const CatalogCheck& check) {
    nlohmann::json stations = nlohmann::json::array();
    for (const StationCheck& one : check.stations) {
        stations.push_back({{"station", one.station},
                            {"database", one.database.native()},
                            {"damage", one.damage},
                            {"files", one.files},
                            {"missing", texts_of(one.missing)},
                            {"changed", texts_of(one.changed)}});
    }
    print_json({{"sound", check.is_sound()},
                {"stations", stations},
                {"set_aside", texts_of(check.set_aside)}});
}

void print_check(const CatalogCheck& check) {
    for (const StationCheck& one : check.stations) {
        const bool sound = one.damage.empty();
        fmt::print("{:<8}  {:>6} {:<5}  {}\n", one.station.empty() ? "unknown" : one.station,
                   one.files, plural(static_cast<std::uint64_t>(one.files), "file"),
                   sound ? fmt::format("sound, {} missing, {} changed", one.missing.size(),
                                       one.changed.size())
                         : "DAMAGED");
        for (const std::string& line : one.damage)
            fmt::print("  {}: {}\n", printable(one.database.native()), printable(line));
        for (const fs::path& path : one.missing)
            fmt::print("  missing  {}\n", printable(path.native()));
        for (const fs::path& path : one.changed)
            fmt::print("  changed  {}\n", printable(path.native()));
    }
    for (const fs::path& path : check.set_aside)
        fmt::print("set aside before: {}\n", printable(path.native()));
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
        "{} {}: {} stood there, {} registered, {} rejected; {} now of files that are gone\n",
        report.files, plural(static_cast<std::uint64_t>(report.files), "file"), report.unchanged,
        report.registered, report.rejected,
        report.gone == 1 ? std::string{"1 row is"} : fmt::format("{} rows are", report.gone));
}

// state/catalog lies in the directory that a daemon has locked.
fs::path state_of(const std::string& catalog) {
    fs::path directory = fs::absolute(catalog).lexically_normal();
    if (!directory.has_filename()) directory = directory.parent_path();
    return directory.parent_path();
}

}  // namespace

int check_catalog(const CareOptions& options) {
    const auto check = catalog::check_catalog(options.directory, options.station);
    if (!check) {
        const int status = report_error(check.error());
        const bool unknown =
            check.error().code == ErrorCode::not_found && fs::is_directory(options.directory);
        return unknown ? exit_nothing_matched : status;
    }
    if (options.json) {
        print_check_json(*check);
    } else {
        print_check(*check);
    }
    if (check->stations.empty()) return report_nothing_matched();
    return check->is_sound() ? exit_done : exit_failed;
}

int rebuild_catalog(const CareOptions& options) {
    const auto lock = pipeline::InstanceLock::acquire(state_of(options.directory));
    if (!lock) {
        fmt::print(stderr, "stormcellar: the catalog can be rebuilt while no daemon runs: {}\n",
                   printable(lock.error().message));
        return exit_failed;
    }
    std::optional<Progress> progress;
    pipeline::RebuildOptions rebuild;
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
