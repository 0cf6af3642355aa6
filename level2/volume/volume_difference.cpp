#include "stormcellar/level2/volume_difference.h"

#include <algorithm>
#include <bit>
#include <initializer_list>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

template <class T>
bool same(const T& a, const T& b) {
    return a == b;
}
bool same(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same(const std::optional<float>& a, const std::optional<float>& b) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

struct Field {
    std::string_view name;
    bool is_same = true;
};

// Returns the name of the first field that differs, or an empty text.
std::string_view first_other(std::initializer_list<Field> fields) {
    for (const Field& field : fields) {
        if (!field.is_same) return field.name;
    }
    return {};
}

// Each overload of other() returns the first field in which two parts differ, or an empty text.
std::string_view other(const Radial& a, const Radial& b) {
    return first_other({
        {"time", same(a.time, b.time)},
        {"azimuth", same(a.azimuth_deg, b.azimuth_deg)},
        {"elevation", same(a.elevation_deg, b.elevation_deg)},
        {"Nyquist velocity", same(a.nyquist_mps, b.nyquist_mps)},
        {"unambiguous range", same(a.unambiguous_range_m, b.unambiguous_range_m)},
        {"calibration", same(a.calibration_dbz, b.calibration_dbz)},
        {"vertical calibration", same(a.vertical_calibration_dbz, b.vertical_calibration_dbz)},
        {"horizontal noise", same(a.horizontal_noise_dbm, b.horizontal_noise_dbm)},
        {"vertical noise", same(a.vertical_noise_dbm, b.vertical_noise_dbm)},
        {"azimuth number", same(a.azimuth_number, b.azimuth_number)},
        {"status", same(a.status, b.status)},
        {"cut sector", same(a.cut_sector, b.cut_sector)},
        {"spot blanking", same(a.spot_blanking, b.spot_blanking)},
        {"azimuth indexing", same(a.azimuth_indexing, b.azimuth_indexing)},
        {"radial flags", same(a.radial_flags, b.radial_flags)},
        {"attenuation",
         same(a.attenuation_db_per_km_thousandths, b.attenuation_db_per_km_thousandths)},
        {"elevation's calibration", same(a.elevation_calibration_db, b.elevation_calibration_db)},
    });
}

std::string_view other(const SweepMoment& a, const SweepMoment& b) {
    return first_other({
        {"name", same(a.moment, b.moment)},
        {"first gate", same(a.first_gate_m, b.first_gate_m)},
        {"gate spacing", same(a.gate_spacing_m, b.gate_spacing_m)},
        {"word size", same(a.word_size_bits, b.word_size_bits)},
        {"scale", same(a.scale, b.scale)},
        {"offset", same(a.offset, b.offset)},
        {"control flags", same(a.control_flags, b.control_flags)},
        {"signal threshold", same(a.snr_threshold_db, b.snr_threshold_db)},
        {"folding threshold", same(a.folding_threshold_db, b.folding_threshold_db)},
        {"length of its rows", same(a.gate_stride, b.gate_stride)},
        {"number of gates", same(a.gate_counts, b.gate_counts)},
        {"codes", same(a.codes8, b.codes8) && same(a.codes16, b.codes16)},
    });
}

std::string_view other(const VcpCut& a, const VcpCut& b) {
    return first_other({
        {"elevation", same(a.elevation_deg, b.elevation_deg)},
        {"channel configuration", same(a.channel_configuration, b.channel_configuration)},
        {"waveform", same(a.waveform, b.waveform)},
        {"super-resolution", same(a.super_resolution, b.super_resolution)},
        {"surveillance PRF", same(a.surveillance_prf, b.surveillance_prf)},
        {"surveillance pulses", same(a.surveillance_pulses, b.surveillance_pulses)},
        {"azimuth rate", same(a.azimuth_rate_code, b.azimuth_rate_code)},
        {"flags", same(a.supplemental, b.supplemental)},
        {"thresholds", same(a.thresholds_eighth_db, b.thresholds_eighth_db)},
        {"Doppler sectors", same(a.rest, b.rest)},
    });
}

std::string_view other(const Vcp& a, const Vcp& b) {
    return first_other({
        {"message", same(a.message_type, b.message_type)},
        {"type", same(a.pattern_type, b.pattern_type)},
        {"number", same(a.pattern_number, b.pattern_number)},
        {"version", same(a.version, b.version)},
        {"clutter map group", same(a.clutter_group, b.clutter_group)},
        {"velocity resolution", same(a.doppler_resolution, b.doppler_resolution)},
        {"pulse width", same(a.pulse_width, b.pulse_width)},
        {"sequencing", same(a.sequencing, b.sequencing)},
        {"flags", same(a.supplemental, b.supplemental)},
    });
}

std::string_view other(const VolumeBlock& a, const VolumeBlock& b) {
    return first_other({
        {"size", same(a.size_bytes, b.size_bytes)},
        {"version", same(a.version_major, b.version_major)},
        {"version's second part", same(a.version_minor, b.version_minor)},
        {"latitude", same(a.latitude_deg, b.latitude_deg)},
        {"longitude", same(a.longitude_deg, b.longitude_deg)},
        {"site height", same(a.site_height_m, b.site_height_m)},
        {"tower height", same(a.tower_height_m, b.tower_height_m)},
        {"calibration", same(a.calibration_db, b.calibration_db)},
        {"horizontal power", same(a.horizontal_power_kw, b.horizontal_power_kw)},
        {"vertical power", same(a.vertical_power_kw, b.vertical_power_kw)},
        {moment_name(Moment::zdr),
         same(a.differential_reflectivity_db, b.differential_reflectivity_db)},
        {"phase", same(a.initial_differential_phase_deg, b.initial_differential_phase_deg)},
        {"VCP", same(a.vcp, b.vcp)},
        {"processing status", same(a.processing_status, b.processing_status)},
        {"rest", same(a.rest, b.rest)},
    });
}

std::string_view other(const VolumeHeader& a, const VolumeHeader& b) {
    return first_other({
        {"name", same(a.filename, b.filename)},
        {"day", same(a.date, b.date)},
        {"time", same(a.ms, b.ms)},
        {"ICAO", same(a.icao, b.icao)},
    });
}

std::string_view other(const Sweep& a, const Sweep& b) {
    return first_other({
        {"elevation number", same(a.elevation_number, b.elevation_number)},
        {"message", same(a.message_type, b.message_type)},
        {"azimuth spacing", same(a.azimuth_spacing_deg, b.azimuth_spacing_deg)},
        {"fixed angle", same(a.vcp_elevation_deg, b.vcp_elevation_deg)},
    });
}

template <class T>
std::string other_part(std::string_view name, const std::optional<T>& a,
                       const std::optional<T>& b) {
    if (a.has_value() != b.has_value()) return std::string{name};
    const std::string_view field = a ? other(*a, *b) : std::string_view{};
    return field.empty() ? std::string{} : fmt::format("{}: {}", name, field);
}

// Returns the first difference between two rows of parts, counting a part that the other row lacks.
template <class T>
std::string other_of(std::string_view name, const std::vector<T>& a, const std::vector<T>& b) {
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
        if (i >= a.size() || i >= b.size()) return fmt::format("{} {}", name, i);
        const std::string_view field = other(a[i], b[i]);
        if (!field.empty()) return fmt::format("{} {}: {}", name, i, field);
    }
    return {};
}

std::string other_facts(const Volume& a, const Volume& b) {
    for (std::string where : {other_part("header", a.header, b.header),
                              other_part("volume data block", a.block, b.block),
                              other_part("VCP", a.vcp_message, b.vcp_message)}) {
        if (!where.empty()) return where;
    }
    if (a.vcp_message) {
        std::string where = other_of("VCP, cut", a.vcp_message->cuts, b.vcp_message->cuts);
        if (!where.empty()) return where;
    }
    return std::string{first_other({
        {"station", same(a.station, b.station)},
        {"VCP number", same(a.vcp, b.vcp)},
        {"source of the VCP number", same(a.vcp_source, b.vcp_source)},
    })};
}

}  // namespace

std::string difference(const Volume& a, const Volume& b) {
    if (std::string where = other_facts(a, b); !where.empty()) return where;
    if (std::string where = other_of("sweep", a.sweeps, b.sweeps); !where.empty()) return where;
    for (std::size_t i = 0; i < a.sweeps.size(); ++i) {
        const std::string sweep = fmt::format("sweep {}, ", i);
        std::string where = other_of(sweep + "radial", a.sweeps[i].radials, b.sweeps[i].radials);
        if (where.empty()) {
            where = other_of(sweep + "moment", a.sweeps[i].moments, b.sweeps[i].moments);
        }
        if (!where.empty()) return where;
    }
    return {};
}

}  // namespace stormcellar::level2
