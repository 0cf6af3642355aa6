// stormcellar/level2/volume.h -- the decoded content of a Level II file.
//
// Codes are kept as in the file (8 or 16 bits) with their scale and offset; value_of() computes a
// value on demand. Arrays are contiguous, with one row for each radial. Nothing is interpreted
// beyond the ICDs (RDA/RPG 2620002, Archive II/User 2620010).
//
// Units     Meters, degrees, m/s, dBZ, dB. Ranges are slant ranges to the CENTER of a gate.
// Threads   Plain data and pure functions; any thread may read it while no thread writes it.
// Errors    None.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::level2 {

// The meaning of the code of a gate. Code 0 is below threshold and code 1 is range folded, except
// in CFP, where codes 0 to 7 are flags and give no_data. In derived moments, code 2 is ambiguous:
// the gate has an echo, but its value cannot be derived. A gate beyond the last gate of the radial
// is no_data.
enum class GateStatus : std::uint8_t { valid, below_threshold, range_folded, no_data, ambiguous };

enum class RadialStatus : std::uint8_t {
    start_of_elevation = 0,
    intermediate = 1,
    end_of_elevation = 2,
    start_of_volume = 3,
    end_of_volume = 4,
    start_of_last_elevation = 5,
};

// Returns the status of a code of this moment; never no_data except for the flags of CFP.
[[nodiscard]] GateStatus status_of_code(Moment moment, std::uint16_t code);

struct Radial {
    UtcTime time;
    float azimuth_deg = 0;
    float elevation_deg = 0;  // as measured; may be negative
    float nyquist_mps = 0;    // 0 if the radar does not say (TDWR, surveillance cuts)
    float unambiguous_range_m = 0;
    // dBZ0: the reflectivity that an echo at 1 km would have if it were as strong as the noise;
    // none in message 1.
    std::optional<float> calibration_dbz;
    std::optional<float> horizontal_noise_dbm;
    std::optional<float> vertical_noise_dbm;
    std::uint16_t azimuth_number = 0;
    std::uint8_t status = 1;  // a RadialStatus, or any other value as in the file
    std::uint8_t cut_sector = 0;
    std::uint8_t spot_blanking = 0;
    std::uint8_t azimuth_indexing = 0;
    std::uint16_t radial_flags = 0;
    std::optional<std::int16_t> attenuation_db_per_km_thousandths;  // elevation block: dB/km * 1000
    std::optional<float> elevation_calibration_db;                  // elevation block
    std::optional<float> vertical_calibration_dbz;
};

// One moment of one sweep: rows of `gate_stride` codes, one row for each radial of the sweep. If
// the radials of a sweep differ in gate geometry, word size, scale or offset, the sweep has one
// SweepMoment for each kind of radial, in which gate_counts is 0 for radials of other kinds.
struct SweepMoment {
    Moment moment = Moment::ref;
    std::int32_t first_gate_m = 0;  // to the center of gate 0; negative in some legacy volumes
    std::int32_t gate_spacing_m = 0;
    std::int32_t gate_stride = 0;  // codes in a row: the largest gate count of any radial
    int word_size_bits = 8;        // 8: the codes are in codes8; 16: in codes16
    float scale = 1;               // value = (code - offset) / scale; 0 means value = code
    float offset = 0;
    int control_flags = 0;                   // message 31; -1 in message 1, which has none
    float snr_threshold_db = 0;              // message 31; 0 in message 1
    float folding_threshold_db = 0;          // message 31 "tover"
    std::vector<std::uint16_t> gate_counts;  // per radial; 0: the radial lacks this moment
    std::vector<std::uint8_t> codes8;
    std::vector<std::uint16_t> codes16;

    // Returns a code without a bounds check: radial < gate_counts.size(), 0 <= gate < gate_stride.
    [[nodiscard]] std::uint16_t code(std::size_t radial, std::int32_t gate) const {
        const std::size_t at =
            radial * static_cast<std::size_t>(gate_stride) + static_cast<std::size_t>(gate);
        return word_size_bits == 8 ? codes8[at] : codes16[at];
    }
    // Returns the status of a gate. Any gate number is allowed; outside the radial's gates the
    // status is no_data.
    [[nodiscard]] GateStatus status(std::size_t radial, std::int32_t gate) const;
    // Returns the physical value of a valid code.
    [[nodiscard]] float value_of(std::uint16_t code) const {
        const auto number = static_cast<float>(code);
        return scale == 0 ? number : (number - offset) / scale;
    }
    [[nodiscard]] double range_m(std::int32_t gate) const {
        return first_gate_m + static_cast<double>(gate_spacing_m) * gate;
    }
};

// The radials, in file order, that share an elevation number. A new sweep begins where the number
// or the message type changes, at a radial with status 0, 3 or 5, and after a 24-byte header.
struct Sweep {
    int elevation_number = 0;                // the cut of the VCP, from 1
    int message_type = 31;                   // 1 or 31
    float azimuth_spacing_deg = 0;           // 0.5 or 1; 0 if the message does not say
    std::optional<float> vcp_elevation_deg;  // the cut's fixed angle, from message 5 or 7
    std::vector<Radial> radials;
    std::vector<SweepMoment> moments;

    // Returns the first SweepMoment of this moment, or null.
    [[nodiscard]] const SweepMoment* find(Moment moment) const;
    [[nodiscard]] double mean_elevation_deg() const;  // NaN if there are no radials
};

// One cut of the volume coverage pattern, message 5 or 7 (ICD 2620002 table XI).
struct VcpCut {
    float elevation_deg = 0;
    std::uint8_t channel_configuration = 0;
    // 1 surveillance, 2 Doppler with ambiguity resolution, 3 Doppler without, 4 batch
    std::uint8_t waveform = 0;
    std::uint8_t super_resolution = 0;
    std::uint8_t surveillance_prf = 0;
    std::uint16_t surveillance_pulses = 0;
    std::int16_t azimuth_rate_code = 0;
    std::uint16_t supplemental = 0;                      // flags: SAILS, MRLE, MPDA, base tilt
    std::array<std::int16_t, 6> thresholds_eighth_db{};  // REF VEL SW ZDR PHI RHO, dB * 8
    std::array<std::uint8_t, 22> rest{};                 // Doppler sectors, as in the message

    [[nodiscard]] bool is_sails() const { return (supplemental & 0x0001U) != 0; }
    [[nodiscard]] int sails_sequence() const { return (supplemental >> 1) & 0x7; }
    [[nodiscard]] bool is_mrle() const { return (supplemental & 0x0010U) != 0; }
    [[nodiscard]] int mrle_sequence() const { return (supplemental >> 5) & 0x7; }
    [[nodiscard]] bool is_mpda() const { return (supplemental & 0x0200U) != 0; }
    [[nodiscard]] bool is_base_tilt() const { return (supplemental & 0x0400U) != 0; }
};

struct Vcp {
    int message_type = 5;
    std::uint16_t pattern_type = 2;
    std::uint16_t pattern_number = 0;
    std::uint8_t version = 0;
    std::uint8_t clutter_group = 0;
    std::uint8_t doppler_resolution = 0;  // 2: 0.5 m/s, 4: 1 m/s
    std::uint8_t pulse_width = 0;         // 2 short, 4 long
    std::uint16_t sequencing = 0;
    std::uint16_t supplemental = 0;
    std::vector<VcpCut> cuts;

    [[nodiscard]] bool is_sails() const { return (supplemental & 0x0001U) != 0; }
    [[nodiscard]] int sails_count() const { return (supplemental >> 1) & 0x7; }
    [[nodiscard]] bool is_mrle() const { return (supplemental & 0x0010U) != 0; }
    [[nodiscard]] int mrle_count() const { return (supplemental >> 5) & 0x7; }
    [[nodiscard]] bool is_mpda() const { return (supplemental & 0x0800U) != 0; }
    [[nodiscard]] bool has_base_tilt() const { return (supplemental & 0x1000U) != 0; }
    [[nodiscard]] int base_tilt_count() const { return (supplemental >> 13) & 0x7; }
};

// The volume data block of message 31.
struct VolumeBlock {
    std::uint16_t size_bytes = 44;
    std::uint8_t version_major = 1;
    std::uint8_t version_minor = 0;
    float latitude_deg = 0;
    float longitude_deg = 0;
    std::int16_t site_height_m = 0;    // base of the tower above mean sea level
    std::uint16_t tower_height_m = 0;  // feed horn above the base
    float calibration_db = 0;
    float horizontal_power_kw = 0;
    float vertical_power_kw = 0;
    float differential_reflectivity_db = 0;
    float initial_differential_phase_deg = 0;
    std::uint16_t vcp = 0;
    std::uint16_t processing_status = 0;
    std::vector<std::uint8_t> rest;  // bytes after the 44 of the first version, unchanged
};

// The 24 bytes before the first record.
struct VolumeHeader {
    std::string filename;    // "AR2V0006.116", "ARCHIVE2.031"
    std::uint32_t date = 0;  // NEXRAD day number
    std::uint32_t ms = 0;    // milliseconds after midnight
    std::string icao;        // empty in ARCHIVE2 files

    [[nodiscard]] UtcTime time() const { return time_from_nexrad(date, ms); }
    // Returns the number after the last dot of `filename`, 0 to 999, or none.
    [[nodiscard]] std::optional<int> volume_number() const;
};

enum class VcpSource : std::uint8_t { none, message_5, message_7, radial };

struct Volume {
    std::optional<VolumeHeader> header;
    std::string station;  // ICAO from the header, else message 31, else the file name; or empty
    std::optional<VolumeBlock> block;
    std::optional<Vcp> vcp_message;
    std::optional<int> vcp;
    VcpSource vcp_source = VcpSource::none;
    std::vector<Sweep> sweeps;  // file order

    // Returns the time of the header, if it is plausible and within an hour of the radials.
    // Otherwise returns the time of the first radial that the other radials of its sweep confirm,
    // or none.
    [[nodiscard]] std::optional<UtcTime> start_time() const;
    [[nodiscard]] std::size_t radial_count() const;
};

// Returns the name of the volume of `station` that starts at `start`: "KTLX20220317_000842". The
// name of its file may differ.
[[nodiscard]] std::string volume_name(std::string_view station, UtcTime start);

// Returns true if `time` is in 1970 to 2149, the years that messages can express. A message without
// a date (day number 0) gives a time before 1970.
[[nodiscard]] bool is_plausible(UtcTime time);
// Returns true if `time` is plausible. If `start` is known, `time` must also be within 6 hours of
// `start`. A volume takes minutes, but a damaged radial may have any time.
[[nodiscard]] bool is_time_of_volume(UtcTime time, std::optional<UtcTime> start);

// Returns the radial's status without the top bit, which marks bad data.
[[nodiscard]] RadialStatus status_of(const Radial& radial);
// Return true if the status of the last radial marks the end of the volume.
[[nodiscard]] bool has_ended(const Volume& volume);
[[nodiscard]] bool has_ended(std::span<const Sweep> sweeps);

// The position of the antenna. Its altitude from message 31 is site height + tower height, or the
// site height alone if the two are equal (TDWR). The station table corrects the position from the
// message:
// - If it is within 0.01 degrees of the table but its altitude is more than 30 m off, the altitude
//   comes from the table.
// - If it is up to 1 degree off, the radar has moved, and the message is right.
// - If it is farther off, or the file has no position, everything comes from the table.
// antenna_position() returns none if neither the file nor the table has the site.
struct AntennaPosition {
    double latitude_deg = 0;
    double longitude_deg = 0;
    double altitude_m = 0;    // above mean sea level
    bool from_table = false;  // at least one of the numbers is from the station table
    // Set if message 31 and the table differ by more than 30 m in altitude or 0.01 degrees.
    std::optional<std::string> disagreement;
};
[[nodiscard]] std::optional<AntennaPosition> antenna_position(const Volume& volume);

}  // namespace stormcellar::level2
