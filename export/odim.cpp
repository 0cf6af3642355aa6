#include "export/odim.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/printable.h"
#include "export/cfradial_layout.h"
#include "export/cfradial_parts.h"
#include "export/exchange_names.h"
#include "export/hdf5_builder.h"
#include "export/volume_facts.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"

namespace stormcellar::netcdf {
namespace {

using level2::GateStatus;
using level2::Radial;
using level2::Sweep;
using level2::SweepMoment;
using level2::Volume;

// The codes 0 and 1 are never values.
constexpr std::uint16_t undetect = 0;
constexpr std::uint16_t nodata = 1;

// The moments of a sweep that make one dataset.
struct OdimScan {
    std::vector<const SweepMoment*> moments;  // of one geometry, each once
    std::int32_t gates = 0;                   // of the longest radial
};

bool has_gates(const SweepMoment& moment) {
    return std::any_of(moment.gate_counts.begin(), moment.gate_counts.end(),
                       [](std::uint16_t gates) { return gates > 0; });
}

bool takes(const OdimScan& scan, const SweepMoment& moment) {
    return std::none_of(scan.moments.begin(), scan.moments.end(), [&](const SweepMoment* other) {
        return other->moment == moment.moment || other->first_gate_m != moment.first_gate_m ||
               other->gate_spacing_m != moment.gate_spacing_m;
    });
}

// Returns at least one scan, so that the radials of a sweep without moments are not lost.
std::vector<OdimScan> scans_of(const Sweep& sweep) {
    std::vector<OdimScan> scans;
    for (const SweepMoment& moment : sweep.moments) {
        if (!has_gates(moment)) continue;
        auto scan = std::find_if(scans.begin(), scans.end(),
                                 [&](const OdimScan& made) { return takes(made, moment); });
        if (scan == scans.end()) scan = scans.emplace(scan);
        scan->moments.push_back(&moment);
        for (const std::uint16_t gates : moment.gate_counts)
            scan->gates = std::max<std::int32_t>(scan->gates, gates);
    }
    if (scans.empty()) scans.emplace_back();
    return scans;
}

// Returns the numbers of the radials by azimuth. Radials at the same azimuth stay in their order.
std::vector<std::size_t> order_of(const Sweep& sweep) {
    std::vector<std::size_t> order(sweep.radials.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto azimuth_deg = [&](std::size_t radial) {
        const float measured = sweep.radials[radial].azimuth_deg;
        return std::isfinite(measured) ? measured : std::numeric_limits<float>::max();
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return azimuth_deg(a) < azimuth_deg(b); });
    return order;
}

double on_circle(double azimuth_deg) {
    if (azimuth_deg < 0) return azimuth_deg + 360;
    return azimuth_deg >= 360 ? azimuth_deg - 360 : azimuth_deg;
}

double epoch_seconds(UtcTime time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

void write_date(Hdf5Builder& file, const std::string& prefix, UtcTime time) {
    const std::string compact = format_compact(time);  // 20220317_000842
    file.text((prefix + "date").c_str(), compact.substr(0, 8));
    file.text((prefix + "time").c_str(), compact.substr(9));
}

// Returns the radar as ODIM names it. A comma separates entries, so the place has none.
std::string source_of(const Volume& volume) {
    if (volume.station.empty()) return "CMT:unknown radar";
    std::string source = "RAD:" + printable(volume.station);
    if (const auto station = find_station(volume.station)) {
        std::string place = fmt::format("{} {}", station->name, station->state);
        std::erase(place, ',');
        source += ",PLC:" + place;
    }
    return source;
}

void write_root(Hdf5Builder& file, const Volume& volume, const VolumeWriteOptions& options,
                const Coverage& coverage) {
    file.text("Conventions", "ODIM_H5/V2_4");
    file.group("what");
    file.text("object", "PVOL");
    file.text("version", "H5rad 2.4");
    write_date(file, "", coverage.start);
    file.text("source", source_of(volume));

    file.group("where");
    const auto antenna = level2::antenna_position(volume);
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    file.number("lon", antenna ? antenna->longitude_deg : unknown);
    file.number("lat", antenna ? antenna->latitude_deg : unknown);
    file.number("height", antenna ? antenna->altitude_m : unknown);

    file.group("how");
    file.text("software", "stormcellar");
    file.text("sw_version", software_version);
    file.number("startepochs", epoch_seconds(coverage.start));
    file.number("endepochs", epoch_seconds(coverage.end));
    file.integer("scan_count", static_cast<std::int64_t>(volume.sweeps.size()));
    if (volume.vcp) file.text("task", fmt::format("VCP-{}", *volume.vcp));
    if (!options.source_file.empty()) file.text("source_file", printable(options.source_file));
    file.text("volume", options.complete ? "complete" : "partial");
    if (!options.notes.empty()) file.text("comment", text_of_notes(options.notes));
}

// Writes the Nyquist velocity. If radials differ, NI has the velocity of the first radial, and an
// array of our own has the velocities of all rows.
void write_nyquist(Hdf5Builder& file, const Sweep& sweep, const std::vector<std::size_t>& order) {
    const float first_mps = sweep.radials.front().nyquist_mps;
    std::vector<double> all_mps;
    for (const std::size_t radial : order)
        all_mps.push_back(static_cast<double>(sweep.radials[radial].nyquist_mps));
    if (first_mps > 0) file.number("NI", static_cast<double>(first_mps));
    const bool differ = std::any_of(sweep.radials.begin(), sweep.radials.end(),
                                    [&](const auto& r) { return r.nyquist_mps != first_mps; });
    if (differ) file.numbers("nyquist_velocities", all_mps);
}

void write_rows(Hdf5Builder& file, const Sweep& sweep, const std::vector<std::size_t>& order) {
    const double half_deg =
        sweep.azimuth_spacing_deg > 0 ? static_cast<double>(sweep.azimuth_spacing_deg) / 2 : 0.5;
    std::vector<double> starts_deg;
    std::vector<double> stops_deg;
    std::vector<double> elevations_deg;
    std::vector<double> times_s;
    for (const std::size_t row : order) {
        const Radial& radial = sweep.radials[row];
        const auto azimuth_deg = static_cast<double>(radial.azimuth_deg);
        starts_deg.push_back(on_circle(azimuth_deg - half_deg));
        stops_deg.push_back(on_circle(azimuth_deg + half_deg));
        elevations_deg.push_back(static_cast<double>(radial.elevation_deg));
        times_s.push_back(epoch_seconds(radial.time));
    }
    file.numbers("startazA", starts_deg);
    file.numbers("stopazA", stops_deg);
    file.numbers("elangles", elevations_deg);
    file.numbers("startazT", times_s);
    file.numbers("stopazT", times_s);
}

template <class Code>
void write_codes(Hdf5Builder& file, const SweepMoment& moment, std::int32_t gates,
                 const std::vector<std::size_t>& order) {
    std::vector<Code> codes;
    codes.reserve(order.size() * static_cast<std::size_t>(gates));
    for (const std::size_t radial : order) {
        for (std::int32_t gate = 0; gate < gates; ++gate) {
            const GateStatus status = moment.status(radial, gate);
            std::uint16_t code = nodata;
            if (status == GateStatus::valid) code = moment.code(radial, gate);
            if (status == GateStatus::below_threshold) code = undetect;
            codes.push_back(static_cast<Code>(code));
        }
    }
    file.codes("data", order.size(), std::span<const Code>(codes));
}

void write_moment(Hdf5Builder& file, const std::string& group, const SweepMoment& moment,
                  std::int32_t gates, const std::vector<std::size_t>& order) {
    file.group(group + "/what");
    file.text("quantity", exchange_names_of(moment.moment).name);
    // If the scale is 0, the code itself is the value.
    const double scale = moment.scale == 0 ? 1.0 : static_cast<double>(moment.scale);
    const double offset = moment.scale == 0 ? 0.0 : static_cast<double>(moment.offset);
    file.number("gain", 1 / scale);
    file.number("offset", offset == 0 ? 0.0 : -offset / scale);
    file.number("nodata", nodata);
    file.number("undetect", undetect);
    file.open(group);
    if (moment.word_size_bits == 16) return write_codes<std::uint16_t>(file, moment, gates, order);
    write_codes<std::uint8_t>(file, moment, gates, order);
    file.text("CLASS", "IMAGE");
    file.text("IMAGE_VERSION", "1.2");
}

void write_scan(Hdf5Builder& file, const std::string& group, const Volume& volume,
                std::size_t number, const OdimScan& scan) {
    const Sweep& sweep = volume.sweeps[number];
    const std::vector<std::size_t> order = order_of(sweep);
    const Coverage coverage =
        coverage_of(std::span(volume.sweeps).subspan(number, 1), coverage_of(volume).start);
    file.group(group + "/what");
    file.text("product", "SCAN");
    write_date(file, "start", coverage.start);
    write_date(file, "end", coverage.end);

    file.group(group + "/where");
    const SweepMoment* geometry = scan.moments.empty() ? nullptr : scan.moments.front();
    const double spacing_m = geometry == nullptr ? 0 : geometry->gate_spacing_m;
    const double start_m = geometry == nullptr ? 0 : geometry->first_gate_m - spacing_m / 2;
    const auto first_row = std::find(order.begin(), order.end(), std::size_t{0}) - order.begin();
    file.number("elangle", static_cast<double>(fixed_angle_deg(sweep)));
    file.integer("nbins", scan.gates);
    file.number("rstart", start_m);
    file.number("rscale", spacing_m);
    file.integer("nrays", static_cast<std::int64_t>(order.size()));
    file.integer("a1gate", first_row);

    file.group(group + "/how");
    file.integer("scan_index", static_cast<std::int64_t>(number + 1));
    file.integer("elevation_number", sweep.elevation_number);
    write_nyquist(file, sweep, order);
    write_rows(file, sweep, order);
    for (std::size_t i = 0; i < scan.moments.size(); ++i)
        write_moment(file, fmt::format("{}/data{}", group, i + 1), *scan.moments[i], scan.gates,
                     order);
}

Result<std::vector<std::byte>> build(const Volume& volume, const VolumeWriteOptions& options) {
    const MutexLock lock(library_mutex());
    Hdf5Builder file(options.deflate_level);
    write_root(file, volume, options, coverage_of(volume));
    int dataset = 0;
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
        for (const OdimScan& scan : scans_of(volume.sweeps[sweep]))
            write_scan(file, fmt::format("dataset{}", ++dataset), volume, sweep, scan);
    }
    return file.finish();
}

Status check(const Volume& volume, const VolumeWriteOptions& options) {
    if (Status good = check_deflate_level(options); !good) return good;
    if (Status good = check_sweeps(volume.sweeps); !good) return good;
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
        if (volume.sweeps[sweep].radials.size() <= most_hdf5_numbers) continue;
        return fail(ErrorCode::unsupported,
                    "sweep {} has {} radials; ODIM_H5 can hold the azimuths of {}", sweep,
                    volume.sweeps[sweep].radials.size(), most_hdf5_numbers);
    }
    return {};
}

}  // namespace

Status write_odim(FileSystem& file_system, const std::filesystem::path& path, const Volume& volume,
                  const VolumeWriteOptions& options) {
    if (Status good = check(volume, options); !good)
        return fail(good.error().code, "{}: {}", path.string(), good.error().message);
    const auto bytes = build(volume, options);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
