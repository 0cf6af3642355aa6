// stormcellar catalog stations|list|latest|oldest|get|check|rebuild: queries and maintains the
// catalog.
#include "stormcellar/catalog/catalog.h"

#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/files/volume_export.h"
#include "cli/query/catalog_care.h"
#include "cli/query/catalog_get.h"
#include "cli/shared/commands.h"
#include "cli/shared/query_options.h"
#include "cli/shared/service_places.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using catalog::CatalogEntry;
using catalog::CatalogReader;

struct CatalogOptions {
    PlaceOption place{Directory::catalog, {}, {}};
    std::string drop;
    std::string station;
    TimeRangeOptions times;
    bool rejected = false;
    bool json = false;
    // Stations that count as known; empty: the default, which set_up_catalog() sets.
    std::string stations;
    bool clear_unknown = false;
    GetOptions get;
};

// Returns the state of the volume. If a file has several volumes, some may be complete and some
// incomplete.
catalog::FileState state_of(const CatalogEntry& entry) {
    using catalog::FileState;
    const bool settled = entry.state == FileState::complete || entry.state == FileState::partial;
    if (!settled || !entry.volume.start_time) return entry.state;
    return entry.volume.complete ? FileState::complete : FileState::partial;
}

nlohmann::json to_json(const CatalogEntry& entry) {
    return {{"station", entry.station},
            {"path", entry.path.string()},
            {"size", entry.size_bytes},
            {"state", catalog::file_state_name(state_of(entry))},
            {"reason", entry.reason},
            {"start_time", json_time(entry.volume.start_time)},
            {"end_time", json_time(entry.volume.end_time)},
            {"volume_number",
             entry.volume.volume_number ? nlohmann::json(*entry.volume.volume_number) : nullptr},
            {"generation", entry.generation},
            {"vcp", entry.volume.vcp ? nlohmann::json(*entry.volume.vcp) : nullptr},
            {"n_sweeps", entry.volume.sweep_count},
            {"n_radials", entry.volume.radial_count},
            {"complete", entry.volume.complete},
            {"registered_time", format_utc(entry.registered_time)}};
}

void print_entry(const CatalogEntry& entry) {
    const std::string start =
        entry.volume.start_time ? format_utc(*entry.volume.start_time) : std::string{"-"};
    const std::string vcp = entry.volume.vcp ? fmt::format("{}", *entry.volume.vcp) : "-";
    fmt::print("{:<4}  {:<24}  VCP {:>3}  {:>3} sweeps  {:>6} radials  {:<8}  {}{}\n",
               entry.station.empty() ? "-" : printable(entry.station), start, vcp,
               entry.volume.sweep_count, entry.volume.radial_count,
               catalog::file_state_name(state_of(entry)), printable(entry.path.native()),
               entry.reason.empty() ? "" : "  (" + printable(entry.reason) + ")");
}

int print_entries(const std::vector<CatalogEntry>& entries, bool json) {
    if (json) {
        nlohmann::json document = nlohmann::json::array();
        for (const CatalogEntry& entry : entries)
            document.push_back(to_json(entry));
        print_json(document);
    } else {
        for (const CatalogEntry& entry : entries)
            print_entry(entry);
    }
    return entries.empty() ? report_nothing_matched() : exit_done;
}

// Reports databases that could not be read. A database holds one station, so a bad one affects only
// its own station.
int report_troubles(const CatalogReader& catalog, int status) {
    for (const catalog::Trouble& trouble : catalog.troubles())
        status = report_error(trouble.error);
    return status;
}

int run_stations(const CatalogOptions& options) {
    auto opened = CatalogReader::open(options.place.directory);
    if (!opened) return report_error(opened.error());
    const auto stations = opened->stations();
    if (!stations) return report_error(stations.error());
    nlohmann::json document = nlohmann::json::array();
    for (const catalog::StationSummary& summary : *stations) {
        if (options.json) {
            document.push_back({{"station", summary.station},
                                {"n_volumes", summary.volume_count},
                                {"n_rejected", summary.rejected_count},
                                {"oldest", json_time(summary.oldest)},
                                {"latest", json_time(summary.latest)}});
            continue;
        }
        fmt::print("{:<8}  {:>6} {:<7}  {:>4} rejected  {}\n",
                   summary.station.empty() ? "unknown" : summary.station, summary.volume_count,
                   plural(static_cast<std::uint64_t>(summary.volume_count), "volume"),
                   summary.rejected_count,
                   summary.oldest ? fmt::format("{} to {}", format_utc(*summary.oldest),
                                                format_utc(*summary.latest))
                                  : "");
    }
    if (options.json) print_json(document);
    const int status = report_troubles(*opened, exit_done);
    return stations->empty() && status == exit_done ? report_nothing_matched() : status;
}

// Returns true for the later chunks of a volume. The catalog describes the volume only in the row
// of its first chunk.
bool is_part_of_a_volume(const CatalogEntry& entry) {
    return !entry.volume.start_time && entry.state != catalog::FileState::rejected &&
           level2::parse_chunk_name(entry.path.filename().native()).has_value();
}

// Returns the entries that the options select: entries of one station, or of all stations whose
// databases can be read.
Result<std::vector<CatalogEntry>> matching(const CatalogOptions& options,
                                           const CatalogReader& catalog) {
    const auto range = parse_time_range(options.times);
    if (!range) return pass_on(range);
    const catalog::Query query{range->from, range->to, options.rejected};
    if (!options.station.empty()) {
        auto entries = catalog.list(options.station, query);
        if (entries) std::erase_if(*entries, is_part_of_a_volume);
        return entries;
    }

    const auto stations = catalog.station_names();
    if (!stations) return pass_on(stations);
    std::vector<CatalogEntry> all;
    for (const std::string& station : *stations) {
        const auto entries = catalog.list(station, query);
        if (entries) all.insert(all.end(), entries->begin(), entries->end());
    }
    std::erase_if(all, is_part_of_a_volume);
    return all;
}

// Reports an error. If the catalog does not know the station, the status says that nothing matched.
// If the catalog is missing, the command has failed.
int report_query_error(const Error& error, const CatalogOptions& options) {
    const int status = report_error(error);
    const bool unknown =
        error.code == ErrorCode::not_found && fs::is_directory(options.place.directory);
    return unknown ? exit_nothing_matched : status;
}

int run_list(const CatalogOptions& options) {
    auto opened = CatalogReader::open(options.place.directory);
    if (!opened) return report_query_error(opened.error(), options);
    const auto entries = matching(options, *opened);
    if (!entries) return report_query_error(entries.error(), options);
    if (!opened->troubles().empty()) {
        if (!entries->empty() || options.json) (void)print_entries(*entries, options.json);
        return report_troubles(*opened, exit_failed);
    }
    return print_entries(*entries, options.json);
}

// Returns true if the file does not exist. A file that may not be examined counts as existing. A
// member of an archive exists if its archive does.
bool is_gone(const fs::path& path) {
    std::error_code error;
    const bool is_there = fs::exists(path, error) || archive::member_path_of(path);
    return !is_there && (!error || error == std::errc::no_such_file_or_directory);
}

int run_one(const CatalogOptions& options, bool latest) {
    auto opened = CatalogReader::open(options.place.directory);
    if (!opened) return report_error(opened.error());
    const auto entry = latest ? opened->latest(options.station) : opened->oldest(options.station);
    if (!entry) return report_query_error(entry.error(), options);
    if (!entry->has_value()) return report_nothing_matched();
    if ((*entry)->state == catalog::FileState::gone || is_gone((*entry)->path)) {
        fmt::print(stderr, "stormcellar: warning: {}: the raw file is gone\n",
                   printable((*entry)->path.native()));
    }
    if (latest && (*entry)->volume.start_time) warn_of_future(*(*entry)->volume.start_time);
    if (options.json) {
        print_json(to_json(**entry));
    } else {
        print_entry(**entry);
    }
    return exit_done;
}

int run_get(const CatalogOptions& options) {
    auto opened = CatalogReader::open(options.place.directory);
    if (!opened) return report_query_error(opened.error(), options);
    const auto entries = matching(options, *opened);
    if (!entries) return report_query_error(entries.error(), options);
    if (entries->empty()) return report_nothing_matched();
    return get_files(*opened, *entries, options.get);
}

// Sets the drop directory from the configuration if it was not typed.
Status find_drop(CatalogOptions& options) {
    if (!options.drop.empty()) return {};
    const auto places = service_places(options.place.config);
    if (!places) return pass_on(places);
    if (*places) options.drop = (*places)->drop.native();
    if (!options.drop.empty()) return {};
    return fail(ErrorCode::bad_argument,
                "say which directory the raw files are in: --drop DIRECTORY, or --config FILE");
}

CLI::App* add_query(CLI::App& parent, CatalogOptions& options, const std::string& name,
                    const std::string& about) {
    CLI::App* app = parent.add_subcommand(name, about);
    add_place(*app, options.place);
    return app;
}

CLI::App* add_get(CLI::App& command, CatalogOptions& options, const std::string& station_help) {
    CLI::App* get = add_query(command, options, "get",
                              "Copy raw files out of the archive, or decode their volumes");
    get->add_option("--station", options.station, station_help)->required();
    add_time_range(*get, options.times);
    get->add_option("-o,--output", options.get.output,
                    "Directory to write into; - writes one file to standard output")
        ->required();
    get->add_flag("--force", options.get.force, "Replace files that exist already");
    CLI::Option* decode =
        get->add_flag("--decode", options.get.decode,
                      "Write each volume, as CfRadial netCDF unless --format names another "
                      "format, instead of copying its file");
    add_volume_export_options(*get, options.get.exported, decode);
    return get;
}

void add_care_options(CLI::App& check, CLI::App& rebuild, const std::string& station_help,
                      CatalogOptions& options) {
    for (CLI::App* one : {&check, &rebuild})
        one->add_option("--station", options.station, station_help + ". Default: all radars");
    for (CLI::App* one : {&check, &rebuild})
        one->add_option("--stations", options.stations,
                        "Stations that may have a database: known (those in the station table), "
                        "any, or a list such as known,XABC. Default: known; for rebuild with "
                        "--catalog and --drop, any");
    check.add_flag("--clear-unknown", options.clear_unknown,
                   "First remove the databases of all other stations (only while no daemon runs)");
    rebuild.add_option("--drop", options.drop,
                       "The drop directory, into which LDM writes the raw files. Default: that of "
                       "the service");
}

}  // namespace

Run set_up_catalog(CLI::App& command) {
    command.require_subcommand(1);
    const auto options = std::make_shared<CatalogOptions>();
    const std::string station_help = "ICAO identifier of the radar, such as KTLX";

    CLI::App* stations =
        add_query(command, *options, "stations", "List the stations in the catalog");
    CLI::App* list = add_query(command, *options, "list", "List the volumes, oldest first");
    list->add_option("--station", options->station, station_help + ". Default: all radars");
    add_time_range(*list, options->times);
    list->add_flag("--rejected", options->rejected, "Also list the files that hold no volume");
    CLI::App* latest = add_query(command, *options, "latest", "Show the newest volume");
    CLI::App* oldest = add_query(command, *options, "oldest", "Show the oldest volume");
    for (CLI::App* one : {latest, oldest})
        one->add_option("--station", options->station, station_help)->required();
    CLI::App* get = add_get(command, *options, station_help);
    CLI::App* check = add_query(command, *options, "check",
                                "Examine the databases and compare their rows with the files");
    CLI::App* rebuild =
        add_query(command, *options, "rebuild",
                  "Set damaged databases aside and register the files in the drop directory");
    add_care_options(*check, *rebuild, station_help, *options);
    for (CLI::App* one : {stations, list, latest, oldest, check, rebuild})
        one->add_flag("--json", options->json, "Print one JSON document");

    return [=] {
        // If both directories were typed, the catalog belongs to the user and not to the service.
        const bool is_own =
            rebuild->parsed() && !options->place.directory.empty() && !options->drop.empty();
        if (options->stations.empty()) options->stations = is_own ? "any" : "known";
        if (Status found = options->place.find(); !found) return report_error(found.error());
        if (stations->parsed()) return run_stations(*options);
        if (list->parsed()) return run_list(*options);
        if (get->parsed()) return run_get(*options);
        if (rebuild->parsed()) {
            if (Status found = find_drop(*options); !found) return report_error(found.error());
        }
        const CareOptions care{options->place.directory, options->drop,          options->station,
                               options->stations,        options->clear_unknown, options->json};
        if (check->parsed()) return check_catalog(care);
        if (rebuild->parsed()) return rebuild_catalog(care);
        return run_one(*options, latest->parsed());
    };
}

}  // namespace stormcellar::cli
