// stormcellar info FILE... [--echo] [--json] [--to OUT.nc]: decodes a Level II file and describes
// it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "cli/files/echo_report.h"
#include "cli/files/volume_export.h"
#include "cli/shared/commands.h"
#include "cli/shared/input_files.h"
#include "cli/shared/output_file.h"
#include "cli/shared/query_options.h"
#include "cli/shared/site_options.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/level2/describe.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::cli {
namespace {

struct InfoOptions {
    std::vector<std::string> files;
    bool json = false;
    bool echo = false;
    int threads = 0;  // 0: as many as the machine has
    std::string to;   // file to write the volume to; empty: none
    int volume = 0;   // number in the file, from 1; 0: its only volume
    VolumeExportOptions exported;
    std::string dealias;               // empty: not typed
    std::vector<std::string> derived;  // names of moments
    SiteOptions site;
};

std::string_view vcp_source_text(level2::VcpSource source) {
    switch (source) {
        case level2::VcpSource::message_5:
            return "message 5";
        case level2::VcpSource::message_7:
            return "message 7";
        case level2::VcpSource::radial:
            return "the radials";
        case level2::VcpSource::none:
            break;
    }
    return "nothing";
}

void print_site(const level2::Volume& volume) {
    if (volume.station.empty()) {
        fmt::print("  site      unknown\n");
    } else if (const auto station = find_station(volume.station)) {
        fmt::print("  site      {} {}, {}\n", volume.station, station->name, station->state);
    } else {
        fmt::print("  site      {}\n", printable(volume.station));
    }
    if (const auto antenna = level2::antenna_position(volume)) {
        fmt::print("  antenna   {:.4f}, {:.4f}, {:.0f} m above sea level{}\n",
                   antenna->latitude_deg, antenna->longitude_deg, antenna->altitude_m,
                   antenna->from_table ? " (station table)" : "");
    }
}

void print_times(const level2::Volume& volume) {
    if (const auto start = volume.start_time()) fmt::print("  start     {}\n", format_utc(*start));
    if (!volume.sweeps.empty()) {
        fmt::print("  radials   {} to {}\n", format_utc(volume.sweeps.front().radials.front().time),
                   format_utc(volume.sweeps.back().radials.back().time));
    }
}

// Returns each moment once, with the number and length of its gates, as in "REF 1832 x 250 m".
std::string moments_text(const level2::Sweep& sweep) {
    std::string text;
    for (const level2::Moment name : level2::all_moments) {
        const level2::SweepMoment* moment = sweep.find(name);
        if (moment == nullptr) continue;
        if (!text.empty()) text += ", ";
        text += fmt::format("{} {} x {} m", level2::moment_name(name), moment->gate_stride,
                            moment->gate_spacing_m);
    }
    return text;
}

void print_sweeps(const level2::Decoded& decoded) {
    const auto& starts = decoded.report.further_volume_starts;
    fmt::print("\n{:>5} {:>4} {:>8} {:>8} {:>8} {:>8}  {:<12}  {}\n", "sweep", "cut", "fixed",
               "mean deg", "radials", "Nyquist", "start", "moments");
    for (std::size_t i = 0; i < decoded.volume.sweeps.size(); ++i) {
        const level2::Sweep& sweep = decoded.volume.sweeps[i];
        if (std::find(starts.begin(), starts.end(), i) != starts.end()) {
            fmt::print("      another volume begins\n");
        }
        const level2::Radial& first = sweep.radials.front();
        const std::string start = format_utc(first.time);
        const std::string fixed =
            sweep.vcp_elevation_deg ? fmt::format("{:.2f}", *sweep.vcp_elevation_deg) : "-";
        const std::string nyquist =
            first.nyquist_mps > 0 ? fmt::format("{:.2f}", first.nyquist_mps) : "-";
        fmt::print("{:>5} {:>4} {:>8} {:>8.2f} {:>8} {:>8}  {:<12}  {}\n", i,
                   sweep.elevation_number, fixed, sweep.mean_elevation_deg(), sweep.radials.size(),
                   nyquist, start.substr(11, 12), moments_text(sweep));
    }
}

void print_problems(const level2::DecodeReport& report) {
    if (report.problems.empty()) return;
    fmt::print("\n");
    for (const level2::Problem& problem : report.problems) {
        const std::string place =
            problem.offset ? fmt::format(" (at {})", *problem.offset) : std::string{};
        fmt::print("{}: {}{}\n", level2::severity_name(problem.severity), printable(problem.text()),
                   place);
    }
}

// Lists the volumes of a file that has several.
void print_volumes(const std::vector<level2::VolumePart>& parts) {
    if (parts.size() < 2) return;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        fmt::print("  volume {:<2} from sweep {} on, {} {}; {}\n", i + 1, parts[i].first_sweep,
                   parts[i].sweeps, plural(parts[i].sweeps, "sweep"),
                   parts[i].complete ? "complete" : "partial");
    }
}

void print_facts(const level2::Decoded& decoded, const level2::FileFacts& file) {
    const level2::Volume& volume = decoded.volume;
    const level2::DecodeReport& report = decoded.report;
    fmt::print("{}\n", printable(file.name));
    print_site(volume);
    print_times(volume);
    fmt::print("  file      {} bytes, {}", file.size, report.container);
    if (report.ldm_records) {
        fmt::print(", {} LDM {}", *report.ldm_records,
                   plural(static_cast<std::uint64_t>(*report.ldm_records), "record"));
    }
    if (!report.message_counts.empty()) fmt::print(", {} bytes of messages", report.message_bytes);
    fmt::print("\n");
    if (volume.vcp) {
        fmt::print("  VCP       {} (from {})\n", *volume.vcp, vcp_source_text(volume.vcp_source));
    }
    if (report.rda_status && report.rda_status->build) {
        fmt::print("  RDA       build {:.2f}\n", *report.rda_status->build);
    }
    fmt::print("  holds     {} {}, {} {}; {}\n", volume.sweeps.size(),
               plural(volume.sweeps.size(), "sweep"), volume.radial_count(),
               plural(volume.radial_count(), "radial"), report.complete ? "complete" : "partial");
    print_volumes(level2::volumes_in(decoded));
    if (!volume.sweeps.empty()) print_sweeps(decoded);
    print_problems(report);
}

std::uintmax_t size_of(const std::vector<std::filesystem::path>& chunks) {
    std::uintmax_t sum = 0;
    for (const std::filesystem::path& chunk : chunks) {
        std::error_code error;
        const auto size = std::filesystem::file_size(chunk, error);
        if (!error) sum += size;
    }
    return sum;
}

// Checks, before the long work begins, that the file can be written.
Status check_output(const InfoOptions& options) {
    if (options.to.empty()) return {};
    for (const std::string& file : options.files) {
        std::error_code ignored;
        if (!std::filesystem::equivalent(file, options.to, ignored)) continue;
        return fail(ErrorCode::bad_argument, "{}: this is the input file itself; name another file",
                    options.to);
    }
    if (options.exported.format.empty()) {
        return check_output_file(options.to, volume_export::volume_endings(),
                                 "the ending chooses the format", options.json);
    }
    const volume_export::VolumeFormat& format = format_for(options.exported);
    return check_output_file(options.to, {format.endings.begin(), format.endings.end()},
                             fmt::format("the format is {}", format.name), options.json);
}

// Returns the index of the volume to write. The index is 0 if the file is a set of chunks and only
// the chosen volume was decoded.
Result<std::size_t> chosen_volume(const InfoOptions& options, const InputFile& file,
                                  std::size_t count) {
    if (!file.chunks.empty() && count == 1) return 0;
    if (options.volume == 0 && count > 1) {
        return fail(ErrorCode::bad_argument,
                    "{}: holds {} volumes; choose one with --volume 1 to {}", file.label, count,
                    count);
    }
    const auto number = static_cast<std::size_t>(std::max(options.volume, 1));
    if (number > count) {
        return fail(ErrorCode::bad_argument, "--volume {}: {} holds only {} volume{}", number,
                    file.label, count, count == 1 ? "" : "s");
    }
    return number - 1;
}

struct DerivedWish {
    std::vector<level2::Moment> moments;  // empty: only those of the radar
    retrieve::DerivedOptions how;
};

std::string derived_moment_names() {
    std::vector<std::string_view> names;
    for (const level2::MomentFacts& facts : level2::moment_facts)
        if (facts.is_derived) names.push_back(facts.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

// Reads --moment and --dealias. The dealiased velocity is written with any derived moment.
Result<DerivedWish> derived_wish_of(const InfoOptions& options) {
    DerivedWish wish;
    for (const std::string& name : options.derived) {
        const auto moment = level2::moment_from_name(name);
        if (!moment || !level2::facts_of(*moment).is_derived)
            return fail(ErrorCode::bad_argument,
                        "--moment {}: it names moments to derive ({}); those of the radar are "
                        "always written",
                        printable(name), derived_moment_names());
        wish.moments.push_back(*moment);
    }
    if (options.dealias.empty()) return wish;
    const auto rung = retrieve::dealiasing_from_name(options.dealias);
    if (!rung) return fail(ErrorCode::bad_argument, "--dealias {}", rung.error().message);
    wish.how.dealiasing = *rung;
    if (wish.moments.empty() && *rung != retrieve::Dealiasing::off)
        wish.moments = {level2::Moment::veld};
    return wish;
}

Status write_chosen(const InfoOptions& options, const InputFile& file, level2::Decoded decoded) {
    const auto wish = derived_wish_of(options);
    if (!wish) return pass_on(wish);
    const level2::DecodeReport report = decoded.report;
    std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    const auto chosen = chosen_volume(options, file, volumes.size());
    if (!chosen) return pass_on(chosen);
    if (!wish->moments.empty()) {
        const auto added =
            retrieve::add_derived_moments(volumes[*chosen], wish->moments, wish->how);
        if (!added) return fail(added.error().code, "{}: {}", file.label, added.error().message);
    }
    auto output = OutputFile::open(options.to);
    if (!output) return pass_on(output);
    Status written = export_volume(volumes, *chosen, report, file.file_name(), output->path(),
                                   format_for(options.exported, options.to), options.exported);
    return written ? output->finish() : written;
}

Result<nlohmann::ordered_json> run_one(const InfoOptions& options, InputFiles& inputs,
                                       const InputFile& file, const SiteRequest& site) {
    level2::DecodeOptions decode_options;
    decode_options.threads =
        options.threads > 0 ? options.threads
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::uint64_t size = 0;
    auto decoded = inputs.decode(file, decode_options, &size);
    if (!decoded) return pass_on(decoded);
    if (Status applied = apply_site(site, decoded->volume); !applied) return pass_on(applied);
    if (size == 0) size = size_of(file.chunks);
    const level2::FileFacts facts{file.file_name(), size};
    auto json = options.json ? level2::describe(*decoded, facts) : nlohmann::ordered_json{};
    if (!options.to.empty()) {
        const std::size_t count = decoded->report.further_volume_starts.size() + 1;
        if (const auto chosen = chosen_volume(options, file, count); !chosen)
            return pass_on(chosen);
    }
    if (options.json && options.echo) json["echo"] = echo_json(*decoded);
    const bool is_taken = options.json || is_stdout(options.to);
    if (!is_taken) print_facts(*decoded, facts);
    if (!is_taken && options.echo) print_echo(*decoded);
    if (!options.to.empty()) {
        const Status written = write_chosen(options, file, std::move(*decoded));
        if (!written) return pass_on(written);
        json["written"] = options.to;
        if (!is_taken) {
            fmt::print("\n{}: written as {}\n", printable(options.to),
                       format_for(options.exported, options.to).name);
        }
    }
    return json;
}

int run_info(const InfoOptions& options) {
    if (const Status good = check_output(options); !good) return report_error(good.error());
    const auto site = parse_site(options.site);
    if (!site) return report_error(site.error());
    const std::string names = fmt::format("{}", fmt::join(options.files, ", "));
    auto inputs = InputFiles::find(options.files, options.volume);
    if (!inputs) return report_error(inputs.error());
    note_left_out(*inputs);
    const auto& files = inputs->files();
    const bool is_of_chunks = files.size() == 1 && !files.front().chunks.empty();
    if (options.volume > 0 && options.to.empty() && !is_of_chunks) {
        return report_error({ErrorCode::bad_argument,
                             "--volume chooses what --to writes, or one of the volumes of which a "
                             "directory has chunks"});
    }
    if (!options.to.empty() && files.size() > 1) {
        return report_error({ErrorCode::bad_argument,
                             fmt::format("{}: holds {} files; name one of them, such as {}", names,
                                         files.size(), files.front().label)});
    }
    nlohmann::ordered_json document;
    int status = exit_done;
    bool any = false;
    std::vector<std::string> no_volumes;
    for (const InputFile& file : files) {
        if (any && !options.json) fmt::print("\n");
        auto json = run_one(options, *inputs, file, *site);
        if (!json && file.was_found && is_no_volume(json.error())) {
            no_volumes.push_back(json.error().message);
            continue;
        }
        if (!json) {
            status = report_error(json.error());
            continue;
        }
        any = true;
        if (files.size() == 1) {
            document = std::move(*json);
        } else {
            document.push_back(std::move(*json));
        }
    }
    if (options.json && any) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        fmt::print("{}\n", document.dump(1, ' ', true, replace));
    }
    if (!any && status == exit_done) {
        return report_error(
            {ErrorCode::not_level2, fmt::format("{}: none of its {} {} is a Level II file", names,
                                                files.size(), plural(files.size(), "file"))});
    }
    for (const std::string& one : no_volumes)
        print_note(fmt::format("left out: {}", one));
    return status;
}

}  // namespace

Run set_up_info(CLI::App& info) {
    const auto options = std::make_shared<InfoOptions>();
    info.add_option("FILE", options->files,
                    "The files to describe: Level II, ODIM_H5 or CfRadial files, a directory of "
                    "chunks, or - for "
                    "standard input. For a tar or zip archive or a directory of files, each file "
                    "is described. Chunks that are named one by one are put together. The content "
                    "of a file decides what it is")
        ->required();
    info.add_flag("--json", options->json, "Print one JSON document");
    info.add_flag("--echo", options->echo,
                  "Also say what the echo is: weather, or which kind of other echo, and between "
                  "which heights snow melts");
    CLI::Option* to = info.add_option(
        "--to", options->to, "Also write the volume to this file, such as x.nc (CfRadial)");
    info.add_option("--volume", options->volume,
                    "Number of the volume, from 1: the one to write if the file holds several, or "
                    "the one to describe if a directory has chunks of several (default: the "
                    "newest)")
        ->check(CLI::Range(1, 1000));
    add_volume_export_options(info, options->exported, to);
    info.add_option("--dealias", options->dealias,
                    fmt::format("Also write the dealiased velocity, VEL_dealiased: {}",
                                retrieve::dealiasing_names()))
        ->default_str("off")
        ->needs(to);
    info.add_option("--moment", options->derived,
                    fmt::format("Also write moments that are derived from the radar's: {}",
                                derived_moment_names()))
        ->delimiter(',')
        ->needs(to);
    add_site_options(info, options->site);
    info.add_option("--threads", options->threads,
                    "Number of threads for decompression. Default: all processors")
        ->check(CLI::Range(1, 256));
    return [options] { return run_info(*options); };
}

}  // namespace stormcellar::cli
