#include "level2/encode_checks.h"

#include <algorithm>
#include <limits>

#include "base/station_table.h"

namespace stormcellar::level2 {
namespace {

template <class Integer>
bool fits(double number) {
    return number >= std::numeric_limits<Integer>::min() &&
           number <= std::numeric_limits<Integer>::max();
}

// The rows are there and as long as they say.
Status check_rows(const Sweep& sweep, const SweepMoment& moment) {
    const auto name = moment_name(moment.moment);
    const int number = sweep.elevation_number;
    if (moment.word_size_bits != 8 && moment.word_size_bits != 16) {
        return refuse("{} of elevation {} has codes of {} bits", name, number,
                      moment.word_size_bits);
    }
    if (moment.gate_stride < 0 || moment.gate_counts.size() != sweep.radials.size()) {
        return refuse("{} of elevation {} has {} rows for {} radials", name, number,
                      moment.gate_counts.size(), sweep.radials.size());
    }
    const std::size_t codes =
        moment.word_size_bits == 8 ? moment.codes8.size() : moment.codes16.size();
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    if (codes != stride * sweep.radials.size()) {
        return refuse("{} of elevation {} has {} codes for {} rows of {}", name, number, codes,
                      sweep.radials.size(), stride);
    }
    const auto too_long = [stride](std::uint16_t gates) { return gates > stride; };
    if (std::any_of(moment.gate_counts.begin(), moment.gate_counts.end(), too_long)) {
        return refuse("{} of elevation {} counts more gates than a row holds", name, number);
    }
    return {};
}

Status check_moment(const Sweep& sweep, const SweepMoment& moment) {
    const auto name = moment_name(moment.moment);
    const int number = sweep.elevation_number;
    if (Status rows = check_rows(sweep, moment); !rows) return rows;
    if (!fits<std::int16_t>(moment.first_gate_m) || !fits<std::uint16_t>(moment.gate_spacing_m)) {
        return refuse("{} of elevation {} begins at {} m and steps by {} m", name, number,
                      moment.first_gate_m, moment.gate_spacing_m);
    }
    if (!fits<std::uint8_t>(moment.control_flags) ||
        !fits<std::int16_t>(moment.snr_threshold_db * 8.0) ||
        !fits<std::int16_t>(moment.folding_threshold_db * 10.0)) {
        return refuse("{} of elevation {} has flags or thresholds beyond message 31", name, number);
    }
    return {};
}

Status check_times(const Sweep& sweep) {
    for (const Radial& radial : sweep.radials) {
        if (!fits<std::uint16_t>(nexrad_from_time(radial.time).day)) {
            return refuse("elevation {} has a radial of {}; messages end in 2149",
                          sweep.elevation_number, format_utc(radial.time));
        }
    }
    return {};
}

// What message 1 says of a moment is fixed, but for the step of velocity.
bool is_of_message_1(const SweepMoment& moment) {
    if (moment.word_size_bits != 8 || moment.control_flags != -1) return false;
    if (moment.snr_threshold_db != 0) return false;
    if (moment.moment == Moment::ref) return moment.scale == 2 && moment.offset == 66;
    if (moment.moment == Moment::vel) {
        return (moment.scale == 1 || moment.scale == 2) && moment.offset == 129;
    }
    return moment.moment == Moment::sw && moment.scale == 2 && moment.offset == 129;
}

Status check_sweep_1(const Sweep& sweep) {
    const int number = sweep.elevation_number;
    if (!fits<std::uint16_t>(number) || sweep.azimuth_spacing_deg != 0) {
        return refuse("elevation {} with radials every {} degrees; message 1 does not say it",
                      number, sweep.azimuth_spacing_deg);
    }
    for (const SweepMoment& moment : sweep.moments) {
        if (Status rows = check_rows(sweep, moment); !rows) return rows;
        if (!is_of_message_1(moment)) {
            return refuse("{} of elevation {} is not as message 1 has it",
                          moment_name(moment.moment), number);
        }
    }
    return check_times(sweep);
}

Status check_sweep(const Sweep& sweep) {
    const int number = sweep.elevation_number;
    if (sweep.message_type == 1) return check_sweep_1(sweep);
    if (sweep.message_type != 31) {
        return refuse("elevation {} came in message {}, not 1 or 31", number, sweep.message_type);
    }
    if (!fits<std::uint8_t>(number)) return refuse("elevation number {}", number);
    const float spacing = sweep.azimuth_spacing_deg;
    if (spacing != 0 && spacing != 0.5F && spacing != 1) {
        return refuse("elevation {} has radials every {} degrees, not 0.5 or 1", number, spacing);
    }
    for (const Radial& radial : sweep.radials) {
        if (!fits<std::uint16_t>(radial.nyquist_mps * 100.0) ||
            !fits<std::uint16_t>(radial.unambiguous_range_m / 100.0)) {
            return refuse("elevation {} has a Nyquist velocity of {} m/s at {} m", number,
                          radial.nyquist_mps, radial.unambiguous_range_m);
        }
    }
    for (const SweepMoment& moment : sweep.moments) {
        Status checked = check_moment(sweep, moment);
        if (!checked) return checked;
    }
    return check_times(sweep);
}

}  // namespace

Status check_encodable(const Volume& volume) {
    if (volume.header) {
        if (volume.header->filename.size() > 12) {
            return refuse("the header's name '{}' is longer than 12", volume.header->filename);
        }
        if (!volume.header->icao.empty() && volume.header->icao.size() != 4) {
            return refuse("the header's site '{}' is not four characters", volume.header->icao);
        }
    }
    if (const auto start = volume.start_time();
        start && !fits<std::uint16_t>(nexrad_from_time(*start).day)) {
        return refuse("the volume begins at {}; messages end in 2149", format_utc(*start));
    }
    if (volume.radial_count() == 0) {
        if (!volume.header) return refuse("neither header nor radials");
        return {};
    }
    const auto is_31 = [](const Sweep& sweep) { return sweep.message_type == 31; };
    if (std::any_of(volume.sweeps.begin(), volume.sweeps.end(), is_31)) {
        if (!is_icao(volume.station)) {
            return refuse("the station '{}' is no ICAO identifier", volume.station);
        }
        if (!volume.block) return refuse("no position: the volume data block is missing");
    }
    if (volume.block && volume.block->size_bytes != 44 + volume.block->rest.size()) {
        return refuse("the volume data block says {} bytes and holds {}", volume.block->size_bytes,
                      44 + volume.block->rest.size());
    }
    for (const Sweep& sweep : volume.sweeps) {
        Status checked = check_sweep(sweep);
        if (!checked) return checked;
    }
    return {};
}

}  // namespace stormcellar::level2
