#include "stormcellar/level2/volume_difference.h"

#include <algorithm>
#include <bit>
#include <tuple>

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

template <class Part, class Value>
struct Field {
    std::string_view name;
    Value Part::*value;
};
template <class Part, class Value>
Field(std::string_view name, Value Part::*value) -> Field<Part, Value>;

// The fields of all parts of a volume (radials, sweeps and others), in the order of comparison.
constexpr std::tuple fields = {
    Field{"time", &Radial::time},
    Field{"azimuth", &Radial::azimuth_deg},
    Field{"elevation", &Radial::elevation_deg},
    Field{"Nyquist velocity", &Radial::nyquist_mps},
    Field{"unambiguous range", &Radial::unambiguous_range_m},
    Field{"calibration", &Radial::calibration_dbz},
    Field{"vertical calibration", &Radial::vertical_calibration_dbz},
    Field{"horizontal noise", &Radial::horizontal_noise_dbm},
    Field{"vertical noise", &Radial::vertical_noise_dbm},
    Field{"azimuth number", &Radial::azimuth_number},
    Field{"status", &Radial::status},
    Field{"cut sector", &Radial::cut_sector},
    Field{"spot blanking", &Radial::spot_blanking},
    Field{"azimuth indexing", &Radial::azimuth_indexing},
    Field{"radial flags", &Radial::radial_flags},
    Field{"attenuation", &Radial::attenuation_db_per_km_thousandths},
    Field{"elevation's calibration", &Radial::elevation_calibration_db},
    Field{"name", &SweepMoment::moment},
    Field{"first gate", &SweepMoment::first_gate_m},
    Field{"gate spacing", &SweepMoment::gate_spacing_m},
    Field{"word size", &SweepMoment::word_size_bits},
    Field{"scale", &SweepMoment::scale},
    Field{"offset", &SweepMoment::offset},
    Field{"control flags", &SweepMoment::control_flags},
    Field{"signal threshold", &SweepMoment::snr_threshold_db},
    Field{"folding threshold", &SweepMoment::folding_threshold_db},
    Field{"length of its rows", &SweepMoment::gate_stride},
    Field{"number of gates", &SweepMoment::gate_counts},
    Field{"codes", &SweepMoment::codes8},
    Field{"codes", &SweepMoment::codes16},
    Field{"elevation", &VcpCut::elevation_deg},
    Field{"channel configuration", &VcpCut::channel_configuration},
    Field{"waveform", &VcpCut::waveform},
    Field{"super-resolution", &VcpCut::super_resolution},
    Field{"surveillance PRF", &VcpCut::surveillance_prf},
    Field{"surveillance pulses", &VcpCut::surveillance_pulses},
    Field{"azimuth rate", &VcpCut::azimuth_rate_code},
    Field{"flags", &VcpCut::supplemental},
    Field{"thresholds", &VcpCut::thresholds_eighth_db},
    Field{"Doppler sectors", &VcpCut::rest},
    Field{"message", &Vcp::message_type},
    Field{"type", &Vcp::pattern_type},
    Field{"number", &Vcp::pattern_number},
    Field{"version", &Vcp::version},
    Field{"clutter map group", &Vcp::clutter_group},
    Field{"velocity resolution", &Vcp::doppler_resolution},
    Field{"pulse width", &Vcp::pulse_width},
    Field{"sequencing", &Vcp::sequencing},
    Field{"flags", &Vcp::supplemental},
    Field{"size", &VolumeBlock::size_bytes},
    Field{"version", &VolumeBlock::version_major},
    Field{"version's second part", &VolumeBlock::version_minor},
    Field{"latitude", &VolumeBlock::latitude_deg},
    Field{"longitude", &VolumeBlock::longitude_deg},
    Field{"site height", &VolumeBlock::site_height_m},
    Field{"tower height", &VolumeBlock::tower_height_m},
    Field{"calibration", &VolumeBlock::calibration_db},
    Field{"horizontal power", &VolumeBlock::horizontal_power_kw},
    Field{"vertical power", &VolumeBlock::vertical_power_kw},
    Field{moment_name(Moment::zdr), &VolumeBlock::differential_reflectivity_db},
    Field{"phase", &VolumeBlock::initial_differential_phase_deg},
    Field{"VCP", &VolumeBlock::vcp},
    Field{"processing status", &VolumeBlock::processing_status},
    Field{"rest", &VolumeBlock::rest},
    Field{"name", &VolumeHeader::filename},
    Field{"day", &VolumeHeader::date},
    Field{"time", &VolumeHeader::ms},
    Field{"ICAO", &VolumeHeader::icao},
    Field{"elevation number", &Sweep::elevation_number},
    Field{"message", &Sweep::message_type},
    Field{"azimuth spacing", &Sweep::azimuth_spacing_deg},
    Field{"fixed angle", &Sweep::vcp_elevation_deg},
    Field{"station", &Volume::station},
    Field{"VCP number", &Volume::vcp},
    Field{"source of the VCP number", &Volume::vcp_source},
};

// Sets `name` to the name of the field if the field differs and no name is set. The overload below
// does nothing for fields of other parts.
template <class Part, class Value>
void note(const Field<Part, Value>& field, const Part& a, const Part& b, std::string_view& name) {
    if (name.empty() && !same(a.*field.value, b.*field.value)) name = field.name;
}
template <class OtherPart, class Value, class Part>
void note(const Field<OtherPart, Value>&, const Part&, const Part&, std::string_view&) {}

// Returns the name of the first field in which two parts differ, or an empty text.
template <class Part>
std::string_view other(const Part& a, const Part& b) {
    std::string_view name;
    std::apply([&](const auto&... field) { (note(field, a, b, name), ...); }, fields);
    return name;
}

template <class T>
std::string other_part(std::string_view name, const std::optional<T>& a,
                       const std::optional<T>& b) {
    if (a.has_value() != b.has_value()) return std::string{name};
    const std::string_view field = a ? other(*a, *b) : std::string_view{};
    return field.empty() ? std::string{} : fmt::format("{}: {}", name, field);
}

// Returns the first difference between two lists of parts. A part that only one list has is a
// difference too.
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
    return std::string{other(a, b)};
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
