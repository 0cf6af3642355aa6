// stormcellar info FILE [--json] [--to OUT.nc]: decode a Level II file and describe it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/file_system.h"
#include "base/station_table.h"
#include "cli/commands.h"
#include "cli/volume_export.h"
#include "level2/chunk_directory.h"
#include "level2/describe.h"

namespace stormcellar::cli {
namespace {

struct InfoOptions {
    std::string file;
    bool json = false;
    int threads = 0;  // 0: as many as the machine has
    std::string to;   // CfRadial file to write; empty: none
    int volume = 0;   // of the file, from 1; 0: its only one
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

// Each moment once, with its gates, as "REF 1832 x 250 m".
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
            fmt::print("      a further volume begins\n");
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
    fmt::print(", {} bytes of messages\n", report.message_bytes);
    if (volume.vcp) {
        fmt::print("  VCP       {} (from {})\n", *volume.vcp, vcp_source_text(volume.vcp_source));
    }
    if (report.rda_status && report.rda_status->build) {
        fmt::print("  RDA       build {:.2f}\n", *report.rda_status->build);
    }
    const std::size_t volumes = report.further_volume_starts.size() + 1;
    fmt::print("  holds     {} {}, {} {}{}; {}\n", volume.sweeps.size(),
               plural(volume.sweeps.size(), "sweep"), volume.radial_count(),
               plural(volume.radial_count(), "radial"),
               volumes > 1 ? fmt::format(", {} volumes", volumes) : std::string{},
               report.complete ? "complete" : "partial");
    if (!volume.sweeps.empty()) print_sweeps(decoded);
    print_problems(report);
}

// Of a directory: of the files in it.
std::uintmax_t size_of(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
        const auto size = std::filesystem::file_size(path, error);
        return error ? 0 : size;
    }
    std::uintmax_t sum = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
        const auto size = entry.file_size(error);
        if (!error) sum += size;
    }
    return sum;
}

// Before long work: whether the CfRadial file can appear where it shall.
Status check_output(const InfoOptions& options) {
    if (options.to.empty()) return {};
    std::error_code ignored;
    if (std::filesystem::equivalent(options.file, options.to, ignored)) {
        return fail(ErrorCode::bad_argument, "{}: is the volume itself", options.to);
    }
    return check_target(options.to);
}

// Which volume of the file is to be written, from 0.
Result<std::size_t> chosen_volume(const InfoOptions& options, std::size_t count) {
    if (options.volume == 0 && count > 1) {
        return fail(ErrorCode::bad_argument,
                    "{}: holds {} volumes: say which one with --volume 1 to {}", options.file,
                    count, count);
    }
    const auto number = static_cast<std::size_t>(std::max(options.volume, 1));
    if (number > count) {
        return fail(ErrorCode::bad_argument, "--volume {}: {} holds {} volume{}", number,
                    options.file, count, count == 1 ? "" : "s");
    }
    return number - 1;
}

Status write_chosen(const InfoOptions& options, level2::Decoded decoded) {
    const level2::DecodeReport report = decoded.report;
    const std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    const auto chosen = chosen_volume(options, volumes.size());
    if (!chosen) return pass_on(chosen);
    return export_volume(volumes, *chosen, report, options.file, options.to);
}

int run_info(const InfoOptions& options) {
    if (const Status good = check_output(options); !good) return report_error(good.error());
    level2::DecodeOptions decode_options;
    decode_options.threads =
        options.threads > 0 ? options.threads
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const std::filesystem::path path{options.file};
    auto decoded = level2::decode_path(path, decode_options);
    if (!decoded) return report_error(decoded.error());
    const level2::FileFacts file{path.filename().string(), size_of(path)};
    auto json = options.json ? level2::describe(*decoded, file) : nlohmann::ordered_json{};
    if (!options.to.empty()) {
        const std::size_t count = decoded->report.further_volume_starts.size() + 1;
        if (const auto chosen = chosen_volume(options, count); !chosen) {
            return report_error(chosen.error());
        }
    }
    if (!options.json) print_facts(*decoded, file);
    if (!options.to.empty()) {
        const Status written = write_chosen(options, std::move(*decoded));
        if (!written) return report_error(written.error());
        json["written"] = options.to;
        if (!options.json) fmt::print("\n{}: written as CfRadial\n", printable(options.to));
    }
    if (options.json) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        fmt::print("{}\n", json.dump(1, ' ', true, replace));
    }
    return exit_done;
}

}  // namespace

Command add_info(CLI::App& app) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* info = app.add_subcommand("info", "Decode a Level II file and describe it");
    info->add_option("FILE", options->file,
                     "The file, or a directory of chunks; what it is, is found by content")
        ->required();
    info->add_flag("--json", options->json, "One JSON document");
    CLI::Option* to = info->add_option("--to", options->to,
                                       "Also write the volume to this file, as CfRadial netCDF");
    info->add_option("--volume", options->volume, "Which one, of a file that holds several; from 1")
        ->check(CLI::Range(1, 1000))
        ->needs(to);
    info->add_option("--threads", options->threads, "Threads to decompress with")
        ->check(CLI::Range(1, 256));
    return {info, [options] { return run_info(*options); }};
}

}  // namespace stormcellar::cli
