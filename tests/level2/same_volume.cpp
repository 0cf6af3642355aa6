#include "tests/level2/same_volume.h"

#include <bit>
#include <concepts>
#include <tuple>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

template <class T>
bool same(const T& a, const T& b) {
    if constexpr (std::same_as<T, float>) {
        return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    } else {
        return a == b;
    }
}

bool same(const std::optional<float>& a, const std::optional<float>& b) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

template <class... Fields>
bool same(const std::tuple<Fields...>& a, const std::tuple<Fields...>& b) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return (same(std::get<I>(a), std::get<I>(b)) && ...);
    }
    (std::index_sequence_for<Fields...>{});
}

auto fields(const Radial& r) {
    return std::tie(r.time, r.azimuth_deg, r.elevation_deg, r.nyquist_mps, r.unambiguous_range_m,
                    r.calibration_dbz, r.horizontal_noise_dbm, r.vertical_noise_dbm,
                    r.azimuth_number, r.status, r.cut_sector, r.spot_blanking, r.azimuth_indexing,
                    r.radial_flags, r.attenuation_db_per_km_thousandths, r.elevation_calibration_db,
                    r.vertical_calibration_dbz);
}

auto fields(const SweepMoment& m) {
    return std::tie(m.moment, m.first_gate_m, m.gate_spacing_m, m.gate_stride, m.word_size_bits,
                    m.scale, m.offset, m.control_flags, m.snr_threshold_db, m.folding_threshold_db,
                    m.gate_counts, m.codes8, m.codes16);
}

auto fields(const VcpCut& c) {
    return std::tie(c.elevation_deg, c.channel_configuration, c.waveform, c.super_resolution,
                    c.surveillance_prf, c.surveillance_pulses, c.azimuth_rate_code, c.supplemental,
                    c.thresholds_eighth_db, c.rest);
}

auto fields(const Vcp& v) {
    return std::tie(v.message_type, v.pattern_type, v.pattern_number, v.version, v.clutter_group,
                    v.doppler_resolution, v.pulse_width, v.sequencing, v.supplemental);
}

auto fields(const VolumeBlock& b) {
    return std::tie(b.size_bytes, b.version_major, b.version_minor, b.latitude_deg, b.longitude_deg,
                    b.site_height_m, b.tower_height_m, b.calibration_db, b.horizontal_power_kw,
                    b.vertical_power_kw, b.differential_reflectivity_db,
                    b.initial_differential_phase_deg, b.vcp, b.processing_status, b.rest);
}

auto fields(const VolumeHeader& h) {
    return std::tie(h.filename, h.date, h.ms, h.icao);
}

auto fields(const Sweep& s) {
    return std::tie(s.elevation_number, s.message_type, s.azimuth_spacing_deg, s.vcp_elevation_deg);
}

template <class T>
bool same_part(const std::optional<T>& a, const std::optional<T>& b) {
    return a.has_value() == b.has_value() && (!a || same(fields(*a), fields(*b)));
}

// The first index at which two rows of parts differ, counting a missing part; none when equal.
template <class T>
std::optional<std::size_t> first_difference(const std::vector<T>& a, const std::vector<T>& b) {
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
        if (i >= a.size() || i >= b.size() || !same(fields(a[i]), fields(b[i]))) return i;
    }
    return std::nullopt;
}

}  // namespace

std::string difference(const Volume& a, const Volume& b) {
    if (!same_part(a.header, b.header)) return "header";
    if (a.station != b.station) return "station";
    if (!same_part(a.block, b.block)) return "volume data block";
    if (!same_part(a.vcp_message, b.vcp_message)) return "VCP";
    if (a.vcp_message) {
        const auto cut = first_difference(a.vcp_message->cuts, b.vcp_message->cuts);
        if (cut) return fmt::format("VCP cut {}", *cut);
    }
    if (a.vcp != b.vcp || a.vcp_source != b.vcp_source) return "VCP number";
    if (const auto at = first_difference(a.sweeps, b.sweeps)) return fmt::format("sweep {}", *at);
    for (std::size_t i = 0; i < a.sweeps.size(); ++i) {
        const auto radial = first_difference(a.sweeps[i].radials, b.sweeps[i].radials);
        if (radial) return fmt::format("sweep {}, radial {}", i, *radial);
        const auto moment = first_difference(a.sweeps[i].moments, b.sweeps[i].moments);
        if (moment) return fmt::format("sweep {}, moment {}", i, *moment);
    }
    return {};
}

std::string difference(const Decoded& a, const Decoded& b) {
    if (std::string where = difference(a.volume, b.volume); !where.empty()) return where;
    const DecodeReport& x = a.report;
    const DecodeReport& y = b.report;
    if (x.container != y.container) return "container";
    if (x.ldm_records != y.ldm_records) return "ldm_records";
    if (x.negative_control_words != y.negative_control_words) return "negative_control_words";
    if (x.message_bytes != y.message_bytes) return "message_bytes";
    if (x.message_counts != y.message_counts) return "message_counts";
    if (x.bytes_dropped != y.bytes_dropped) return "bytes_dropped";
    if (x.complete != y.complete) return "complete";
    if (x.further_volume_starts != y.further_volume_starts) return "further_volume_starts";
    if (x.message_station != y.message_station) return "message_station";
    if (x.corruption.has_value() != y.corruption.has_value()) return "corruption";
    if (x.corruption && x.corruption->offset != y.corruption->offset) return "corruption's offset";
    if (x.problems.size() != y.problems.size()) return "number of problems";
    for (std::size_t i = 0; i < x.problems.size(); ++i) {
        const Problem& p = x.problems[i];
        const Problem& q = y.problems[i];
        if (p.code != q.code || p.text() != q.text() || p.offset != q.offset) {
            return "problem " + p.text() + " / " + q.text();
        }
    }
    return {};
}

}  // namespace stormcellar::level2
