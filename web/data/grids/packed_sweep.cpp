#include "web/data/grids/packed_sweep.h"

#include <cstring>
#include <limits>
#include <vector>

namespace stormcellar::web {
namespace {

std::vector<const level2::SweepMoment*> kinds_of(const level2::Sweep& sweep,
                                                 level2::Moment moment) {
    std::vector<const level2::SweepMoment*> kinds;
    for (const level2::SweepMoment& one : sweep.moments) {
        if (one.moment == moment) kinds.push_back(&one);
    }
    return kinds;
}

PackedSweepHeader sweep_header(const level2::Volume& volume, const level2::Sweep& sweep,
                               const level2::SweepMoment& gates) {
    PackedSweepHeader header;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto antenna = level2::antenna_position(volume);
    header.latitude_deg = antenna ? antenna->latitude_deg : unknown;
    header.longitude_deg = antenna ? antenna->longitude_deg : unknown;
    header.altitude_m = antenna ? antenna->altitude_m : unknown;
    header.moment = static_cast<std::uint32_t>(gates.moment);
    header.elevation_number = static_cast<std::uint32_t>(sweep.elevation_number);
    header.elevation_deg = static_cast<float>(sweep.mean_elevation_deg());
    header.radial_count = static_cast<std::uint32_t>(sweep.radials.size());
    header.gate_stride = static_cast<std::uint32_t>(gates.gate_stride);
    header.first_gate_m = gates.first_gate_m;
    header.gate_spacing_m = gates.gate_spacing_m;
    header.code_bytes = gates.word_size_bits == 8 ? 1 : 2;
    header.first_valid_code = level2::facts_of(gates.moment).first_valid_code;
    header.scale = gates.scale;
    header.offset = gates.offset;
    return header;
}

void append_radials(const level2::Sweep& sweep, const level2::SweepMoment& gates,
                    std::string& bytes) {
    for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
        const level2::Radial& radial = sweep.radials[i];
        PackedRadial packed;
        packed.time_ms = radial.time.time_since_epoch().count();
        packed.azimuth_deg = radial.azimuth_deg;
        packed.elevation_deg = radial.elevation_deg;
        packed.nyquist_mps = radial.nyquist_mps;
        packed.unambiguous_range_m = radial.unambiguous_range_m;
        packed.gate_count = i < gates.gate_counts.size() ? gates.gate_counts[i] : 0;
        bytes.append(reinterpret_cast<const char*>(&packed), sizeof packed);
    }
}

std::int64_t gates_with_echo(const level2::Sweep& sweep, level2::Moment moment) {
    const std::uint16_t first_valid = level2::facts_of(moment).first_valid_code;
    std::int64_t count = 0;
    for (const level2::SweepMoment* gates : kinds_of(sweep, moment))
        for (std::size_t radial = 0; radial < gates->gate_counts.size(); ++radial)
            for (std::int32_t gate = 0; gate < gates->gate_counts[radial]; ++gate)
                count += gates->code(radial, gate) >= first_valid ? 1 : 0;
    return count;
}

// Returns the share of the gates with echo of the measured moment that the sweep lacks.
float share_left_out(const level2::Sweep& kept, const level2::Sweep& all, level2::Moment moment) {
    const level2::Moment measured = level2::measured_moment(moment);
    const std::int64_t before = gates_with_echo(all, measured);
    if (before == 0) return 0;
    const std::int64_t lost = before - gates_with_echo(kept, measured);
    return static_cast<float>(static_cast<double>(lost) / static_cast<double>(before));
}

}  // namespace

Result<std::string> pack_sweep(const level2::Volume& volume, std::size_t sweep,
                               level2::Moment moment, std::size_t kind,
                               const LackingEcho& lacking) {
    if (sweep >= volume.sweeps.size()) {
        return fail(ErrorCode::not_found, "the volume has {} sweeps; there is no sweep {}",
                    volume.sweeps.size(), sweep);
    }
    const level2::Sweep& of = volume.sweeps[sweep];
    const auto kinds = kinds_of(of, moment);
    if (kind >= kinds.size()) {
        return fail(ErrorCode::not_found, "sweep {} has {} kinds of gates of {}; there is no {}",
                    sweep, kinds.size(), level2::moment_name(moment), kind);
    }
    const level2::SweepMoment& gates = *kinds[kind];
    PackedSweepHeader header = sweep_header(volume, of, gates);
    header.sweep = static_cast<std::uint32_t>(sweep);
    header.kind = static_cast<std::uint32_t>(kind);
    header.kind_count = static_cast<std::uint32_t>(kinds.size());
    if (lacking.all != nullptr && sweep < lacking.all->sweeps.size()) {
        header.least_probability = static_cast<float>(lacking.least_probability);
        header.left_out_share = share_left_out(of, lacking.all->sweeps[sweep], moment);
    }
    header.radials_offset = sizeof header;
    header.codes_offset = header.radials_offset + of.radials.size() * sizeof(PackedRadial);
    std::string bytes(sizeof header, '\0');
    append_radials(of, gates, bytes);
    if (header.code_bytes == 1) {
        bytes.append(reinterpret_cast<const char*>(gates.codes8.data()), gates.codes8.size());
    } else {
        bytes.append(reinterpret_cast<const char*>(gates.codes16.data()), gates.codes16.size() * 2);
    }
    header.size = bytes.size();
    std::memcpy(bytes.data(), &header, sizeof header);
    return bytes;
}

}  // namespace stormcellar::web
