#include "stormcellar/level2/describe.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "level2/decode/volume_checks.h"
#include "stormcellar/level2/moment_statistics.h"

namespace stormcellar::level2 {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

// Returns the time, with microseconds unless they are zero, as in the reference descriptions.
std::string iso_time(UtcTime time) {
    const auto second = std::chrono::floor<std::chrono::seconds>(time);
    const auto ms = (time - second).count();
    std::string text = format_utc(second);
    if (ms == 0) return text;
    text.pop_back();
    return text + fmt::format(".{:03d}000Z", ms);
}

double rounded(double value, double step) {
    return std::round(value / step) * step;
}

// Rounds a float to this many decimal digits, so that the JSON shows 0.1 and not the digits of the
// float.
double decimal(float value, int digits) {
    const double power = std::pow(10.0, digits);
    return std::round(static_cast<double>(value) * power) / power;
}

Json describe_header(const std::optional<VolumeHeader>& header) {
    if (!header) return nullptr;
    return {{"filename", header->filename},
            {"date", header->date},
            {"ms", header->ms},
            {"icao", header->icao},
            {"time", iso_time(header->time())}};
}

Json describe_cut(const VcpCut& cut) {
    return {{"angle", decimal(cut.elevation_deg, 4)},
            {"chan", cut.channel_configuration},
            {"waveform", cut.waveform},
            {"superres", cut.super_resolution},
            {"surv_prf", cut.surveillance_prf},
            {"supp", cut.supplemental},
            {"sails", cut.is_sails()},
            {"sails_seq", cut.sails_sequence()},
            {"mrle", cut.is_mrle()},
            {"mrle_seq", cut.mrle_sequence()},
            {"mpda", cut.is_mpda()},
            {"base_tilt", cut.is_base_tilt()}};
}

Json describe_vcp(const std::optional<Vcp>& vcp) {
    if (!vcp) return nullptr;
    Json json = {{"pattern", vcp->pattern_number},
                 {"type", vcp->pattern_type},
                 {"ncuts", vcp->cuts.size()},
                 {"version", vcp->version},
                 {"dop_res", vcp->doppler_resolution},
                 {"pulse", vcp->pulse_width},
                 {"sequencing", vcp->sequencing},
                 {"supplemental", vcp->supplemental},
                 {"sails", vcp->is_sails()},
                 {"n_sails", vcp->sails_count()},
                 {"mrle", vcp->is_mrle()},
                 {"n_mrle", vcp->mrle_count()},
                 {"mpda", vcp->is_mpda()},
                 {"base_tilt", vcp->has_base_tilt()},
                 {"n_base_tilts", vcp->base_tilt_count()},
                 {"cuts", Json::array()}};
    for (const VcpCut& cut : vcp->cuts)
        json["cuts"].push_back(describe_cut(cut));
    return json;
}

Json describe_block(const std::optional<VolumeBlock>& block) {
    if (!block) return nullptr;
    return {{"size", block->size_bytes},
            {"ver", fmt::format("{}.{}", block->version_major, block->version_minor)},
            {"lat", decimal(block->latitude_deg, 6)},
            {"lon", decimal(block->longitude_deg, 6)},
            {"site_h", block->site_height_m},
            {"tower_h", block->tower_height_m},
            {"vcp", block->vcp}};
}

Json describe_vcp_source(const Volume& volume) {
    if (volume.vcp_source == VcpSource::none) return nullptr;
    if (volume.vcp_source == VcpSource::message_5) return "msg5";
    if (volume.vcp_source == VcpSource::message_7) return "msg7";
    const bool is_legacy = !volume.sweeps.empty() && volume.sweeps.front().message_type == 1;
    return is_legacy ? "msg1 radial" : "RVOL";
}

template <class Key>
Json describe_counts(const std::map<Key, std::uint64_t>& counts) {
    Json json = Json::object();
    for (const auto& [key, count] : counts)
        json[std::to_string(key)] = count;
    return json;
}

std::map<int, std::uint64_t> status_counts(const Volume& volume) {
    std::map<int, std::uint64_t> counts;
    for (const Sweep& sweep : volume.sweeps) {
        for (const Radial& radial : sweep.radials)
            ++counts[radial.status];
    }
    return counts;
}

double largest_azimuth_step(const Sweep& sweep) {
    double largest = 0;
    for (std::size_t i = 1; i < sweep.radials.size(); ++i) {
        const double step = std::abs(static_cast<double>(sweep.radials[i].azimuth_deg) -
                                     static_cast<double>(sweep.radials[i - 1].azimuth_deg));
        largest = std::max(largest, std::min(step, 360 - step));
    }
    return largest;
}

Json describe_moment(const MomentStatistics& statistics) {
    const SweepMoment& first = *statistics.first;
    Json json = {{"n_radials", statistics.radials},
                 {"gates", statistics.gates_first},
                 {"gates_min", statistics.gates_min},
                 {"gates_max", statistics.gates_max},
                 {"first_gate_m", first.first_gate_m},
                 {"gate_spacing_m", first.gate_spacing_m},
                 {"word_size", first.word_size_bits},
                 {"scale", first.scale},
                 {"offset", first.offset},
                 {"control_flags", nullptr},
                 {"geometry_constant", statistics.geometry_constant},
                 {"scale_constant", statistics.scale_constant},
                 {"crc32", fmt::format("{:08x}", statistics.crc32)},
                 {"n_codes", statistics.codes}};
    if (first.control_flags >= 0) json["control_flags"] = first.control_flags;
    if (first.moment == Moment::cfp) json["code_2_to_7"] = statistics.code_2_to_7;
    json["code0"] = statistics.code_0;
    json["code1"] = statistics.code_1;
    json["valid"] = statistics.valid;
    json["min"] = or_null(statistics.min);
    json["max"] = or_null(statistics.max);
    json["mean"] = or_null(statistics.mean);
    return json;
}

Json describe_problems(const DecodeReport& report) {
    Json problems = Json::array();
    for (const Problem& problem : report.problems) {
        problems.push_back({{"severity", severity_name(problem.severity)},
                            {"code", problem.code},
                            {"message", problem.text()},
                            {"offset", or_null(problem.offset)},
                            {"count", std::max<std::uint64_t>(problem.count, 1)}});
    }
    return problems;
}

Json describe_corruption(const DecodeReport& report) {
    if (!report.corruption) return nullptr;
    return {{"offset", report.corruption->offset}, {"reason", report.corruption->reason}};
}

// Describes the times of the first and the last radial of the file, or null.
void describe_times(Json& json, const Volume& volume) {
    json["first_radial_time"] = nullptr;
    json["last_radial_time"] = nullptr;
    if (volume.sweeps.empty()) return;
    json["first_radial_time"] = iso_time(volume.sweeps.front().radials.front().time);
    json["last_radial_time"] = iso_time(volume.sweeps.back().radials.back().time);
}

// Describes the last message 2. Returns null if there is none.
Json describe_status(const std::optional<RdaStatus>& status) {
    if (!status) return nullptr;
    Json json = {{"state", static_cast<int>(status->state)},
                 {"operability", status->operability},
                 {"vcp", status->vcp},
                 {"build", nullptr},
                 {"troubles", rda_troubles(*status)}};
    // Builds are given in hundredths, so round to hundredths; a float would show more digits.
    if (status->build) json["build"] = std::round(*status->build * 100.0) / 100.0;
    return json;
}

}  // namespace

Json describe_sweep(const Sweep& sweep, std::size_t index) {
    const Radial& first = sweep.radials.front();
    const Radial& last = sweep.radials.back();
    const auto by_elevation = [](const Radial& a, const Radial& b) {
        return a.elevation_deg < b.elevation_deg;
    };
    const auto [lowest, highest] =
        std::minmax_element(sweep.radials.begin(), sweep.radials.end(), by_elevation);
    std::set<double> nyquist_values;
    for (const Radial& radial : sweep.radials)
        nyquist_values.insert(decimal(radial.nyquist_mps, 2));
    Json json = {{"index", index},
                 {"elevation_number", sweep.elevation_number},
                 {"message_type", sweep.message_type},
                 {"n_radials", sweep.radials.size()},
                 {"mean_elevation", sweep.mean_elevation_deg()},
                 {"min_elevation", lowest->elevation_deg},
                 {"max_elevation", highest->elevation_deg},
                 {"first_azimuth", first.azimuth_deg},
                 {"last_azimuth", last.azimuth_deg},
                 {"first_azimuth_number", first.azimuth_number},
                 {"last_azimuth_number", last.azimuth_number},
                 {"azimuth_spacing", nullptr},
                 {"start_time", iso_time(first.time)},
                 {"end_time", iso_time(last.time)},
                 {"nyquist_velocity", decimal(first.nyquist_mps, 2)},
                 {"nyquist_values", nyquist_values},
                 {"unambiguous_range_km", rounded(first.unambiguous_range_m, 100) / 1000},
                 {"first_status", first.status},
                 {"last_status", last.status},
                 {"max_azimuth_step", largest_azimuth_step(sweep)}};
    if (sweep.azimuth_spacing_deg != 0) json["azimuth_spacing"] = sweep.azimuth_spacing_deg;
    if (sweep.vcp_elevation_deg) json["vcp_elevation"] = decimal(*sweep.vcp_elevation_deg, 4);
    json["moments"] = Json::object();
    for (const Moment moment : all_moments) {
        if (const auto statistics = moment_statistics(sweep, moment)) {
            json["moments"][std::string{moment_name(moment)}] = describe_moment(*statistics);
        }
    }
    return json;
}

Json describe(const Decoded& decoded, const FileFacts& file) {
    const Volume& volume = decoded.volume;
    const DecodeReport& report = decoded.report;
    Json json = {{"file", file.name},
                 {"size", file.size},
                 {"container", report.container},
                 {"volume_header", describe_header(volume.header)},
                 {"site", text_or_null(volume.station)},
                 {"site_msg31", text_or_null(report.message_station)},
                 {"n_ldm_records", or_null(report.ldm_records)},
                 {"n_negative_control_words", or_null(report.negative_control_words)},
                 {"decompressed_message_bytes", report.message_bytes},
                 {"message_counts", describe_counts(report.message_counts)},
                 {"vcp", or_null(volume.vcp)},
                 {"vcp_source", describe_vcp_source(volume)},
                 {"vcp_message", describe_vcp(volume.vcp_message)},
                 {"volume_block", describe_block(volume.block)},
                 {"corruption", describe_corruption(report)},
                 {"radial_status_counts", describe_counts(status_counts(volume))},
                 {"msg31_compression", describe_counts(report.radial_compression)},
                 {"oddities", Json::array()},
                 {"n_oddities", report.problems.size()},
                 {"n_sweeps", volume.sweeps.size()},
                 {"n_radials", volume.radial_count()}};
    for (const Problem& problem : report.problems)
        json["oddities"].push_back(problem.text());
    describe_times(json, volume);
    json["complete"] = report.complete;
    json["volumes"] = Json::array();
    for (const VolumePart& part : volumes_in(decoded)) {
        json["volumes"].push_back({{"first_sweep", part.first_sweep},
                                   {"n_sweeps", part.sweeps},
                                   {"complete", part.complete}});
    }
    json["bytes_dropped"] = report.bytes_dropped;
    json["further_volume_starts"] = report.further_volume_starts;
    json["rda_status"] = describe_status(report.rda_status);
    json["problems"] = describe_problems(report);
    json["sweeps"] = Json::array();
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i)
        json["sweeps"].push_back(describe_sweep(volume.sweeps[i], i));
    return json;
}

}  // namespace stormcellar::level2
