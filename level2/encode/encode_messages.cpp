#include "level2/encode/encode_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "level2/encode/encode_checks.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t communications_header_bytes = 12;
constexpr std::size_t frame_body_bytes = 2400;  // 1,208 halfwords with the header
constexpr std::uint8_t orda_channel = 8;        // single channel, Open RDA
// Value in a block for a number that the radial lacks.
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

std::int16_t to_i16(double number) {
    return static_cast<std::int16_t>(std::lround(number));
}
std::uint16_t to_u16(double number) {
    return static_cast<std::uint16_t>(std::lround(number));
}

void append_cut(ByteWriter& out, const VcpCut& cut) {
    // 180 degrees are 2^15, and negative angles wrap around (ICD table III-A).
    out.u16(static_cast<std::uint16_t>(std::lround(cut.elevation_deg * (32768.0 / 180.0))));
    out.u8(cut.channel_configuration);
    out.u8(cut.waveform);
    out.u8(cut.super_resolution);
    out.u8(cut.surveillance_prf);
    out.u16(cut.surveillance_pulses);
    out.i16(cut.azimuth_rate_code);
    for (const std::int16_t threshold : cut.thresholds_eighth_db) {
        out.i16(threshold);
    }
    // The supplemental flags are between the first Doppler sector and the second.
    const std::span<const std::uint8_t> rest = cut.rest;
    out.raw(rest.first(6));
    out.u16(cut.supplemental);
    out.raw(rest.subspan(6));
}

// Writes message 5 or 7, ICD table XI.
Status append_vcp(ByteWriter& out, const Vcp& vcp, UtcTime time, MessageRun& run) {
    constexpr std::size_t header_bytes = 22;
    constexpr std::size_t cut_bytes = 46;
    const std::size_t body_bytes = header_bytes + cut_bytes * vcp.cuts.size();
    if (body_bytes > frame_body_bytes) {
        return refuse("VCP {} has {} cuts; a message holds {}", vcp.pattern_number, vcp.cuts.size(),
                      (frame_body_bytes - header_bytes) / cut_bytes);
    }
    if (vcp.message_type != 5 && vcp.message_type != 7) {
        return refuse("a VCP comes in message 5 or 7, not {}", vcp.message_type);
    }
    const auto type = static_cast<std::uint8_t>(vcp.message_type);
    const std::size_t size_position = begin_message(out, orda_channel, type, time, run);
    out.u16(static_cast<std::uint16_t>(body_bytes / 2));
    out.u16(vcp.pattern_type);
    out.u16(vcp.pattern_number);
    out.u16(static_cast<std::uint16_t>(vcp.cuts.size()));
    out.u8(vcp.version);
    out.u8(vcp.clutter_group);
    out.u8(vcp.doppler_resolution);
    out.u8(vcp.pulse_width);
    out.u32(0);
    out.u16(vcp.sequencing);
    out.u16(vcp.supplemental);
    out.u16(0);
    for (const VcpCut& cut : vcp.cuts) {
        append_cut(out, cut);
    }
    end_message(out, size_position);
    out.pad_to_multiple_of(frame_bytes);
    return {};
}

// Returns the first build, in hundredths, that sends the blocks and moments of this volume (ICD
// 2620002, tables XVII of each build).
std::uint16_t build_of(const Volume& volume) {
    constexpr std::uint16_t build_13 = 1300, build_17 = 1700, build_19 = 1900, build_20 = 2000;
    const auto has_cfp = [](const Sweep& sweep) { return sweep.find(Moment::cfp) != nullptr; };
    const int version = volume.block ? volume.block->version_major : 1;
    if (version >= 3) return build_20;
    if (std::any_of(volume.sweeps.begin(), volume.sweeps.end(), has_cfp)) return build_19;
    return version == 2 ? build_17 : build_13;
}

// Writes message 2, ICD table IV, for a radar that operates under remote control, is on line, sends
// reflectivity, velocity and width, and has no alarm. Facts that a Volume does not hold (power,
// maps, corrections) are zero.
void append_status(ByteWriter& out, const Volume& volume, UtcTime time, MessageRun& run) {
    constexpr std::uint16_t build_18 = 1800, version_of_build_19 = 9;
    constexpr std::uint16_t operate = 0x10, on_line = 2, remote = 4, utility_power = 2;
    constexpr std::uint16_t all_moments_enabled = 0x1C, operational = 4, super_resolution = 2;
    const std::uint16_t build = build_of(volume);
    const std::size_t halfwords = build < build_18 ? 40 : 60;
    const int block_vcp = volume.block ? volume.block->vcp : 0;
    const std::size_t size_position = begin_message(out, orda_channel, 2, time, run);
    const std::size_t body = out.size();
    out.u16(operate);
    out.u16(on_line);
    out.u16(remote);
    out.u16(utility_power);
    out.u16(0);  // average transmitter power
    out.u16(0);  // reflectivity calibration correction
    out.u16(all_moments_enabled);
    out.u16(static_cast<std::uint16_t>(volume.vcp.value_or(block_vcp)));
    out.u16(0);  // control authorization
    out.u16(build);
    out.u16(operational);
    out.u16(super_resolution);
    out.zeros(2 * halfwords - (out.size() - body));
    if (build >= build_18) out.set_u16(out.size() - 2, version_of_build_19);
    end_message(out, size_position);
    out.pad_to_multiple_of(frame_bytes);
}

// Writes the volume data block, ICD table XVII-E.
void append_volume_block(ByteWriter& out, const VolumeBlock& block) {
    out.text("RVOL", 4);
    out.u16(block.size_bytes);
    out.u8(block.version_major);
    out.u8(block.version_minor);
    out.f32(block.latitude_deg);
    out.f32(block.longitude_deg);
    out.i16(block.site_height_m);
    out.u16(block.tower_height_m);
    out.f32(block.calibration_db);
    out.f32(block.horizontal_power_kw);
    out.f32(block.vertical_power_kw);
    out.f32(block.differential_reflectivity_db);
    out.f32(block.initial_differential_phase_deg);
    out.u16(block.vcp);
    out.u16(block.processing_status);
    out.raw(block.rest);
}

bool has_elevation_block(const Radial& radial) {
    return radial.attenuation_db_per_km_thousandths.has_value() ||
           radial.elevation_calibration_db.has_value();
}

// Writes the elevation data block, ICD table XVII-F.
void append_elevation_block(ByteWriter& out, const Radial& radial) {
    out.text("RELV", 4);
    out.u16(12);
    out.i16(radial.attenuation_db_per_km_thousandths.value_or(std::int16_t{0}));
    out.f32(radial.elevation_calibration_db.value_or(unknown));
}

bool has_calibration(const Radial& radial) {
    return radial.calibration_dbz.has_value() || radial.vertical_calibration_dbz.has_value();
}

bool has_radial_block(const Radial& radial) {
    return has_calibration(radial) || radial.horizontal_noise_dbm.has_value() ||
           radial.vertical_noise_dbm.has_value() || radial.nyquist_mps != 0 ||
           radial.unambiguous_range_m != 0 || radial.radial_flags != 0;
}

// Writes the radial data block, ICD table XVII-H. Without calibration, the block has only 20 bytes.
void append_radial_block(ByteWriter& out, const Radial& radial) {
    out.text("RRAD", 4);
    out.u16(has_calibration(radial) ? 28 : 20);
    out.u16(to_u16(radial.unambiguous_range_m / 100.0));
    out.f32(radial.horizontal_noise_dbm.value_or(unknown));
    out.f32(radial.vertical_noise_dbm.value_or(unknown));
    out.u16(to_u16(radial.nyquist_mps * 100.0));
    out.u16(radial.radial_flags);
    if (!has_calibration(radial)) return;
    out.f32(radial.calibration_dbz.value_or(unknown));
    out.f32(radial.vertical_calibration_dbz.value_or(unknown));
}

// Writes the data block of a moment, ICD table XVII-B.
void append_moment(ByteWriter& out, const SweepMoment& moment, std::size_t radial) {
    const std::size_t gates = moment.gate_counts[radial];
    const std::size_t row = radial * static_cast<std::size_t>(moment.gate_stride);
    // The RDA fills names such as "SW" with blanks.
    out.text("D", 1);
    std::string name{moment_name(moment.moment)};
    name.resize(3, ' ');
    out.text(name, 3);
    out.u32(0);
    out.u16(static_cast<std::uint16_t>(gates));
    out.i16(static_cast<std::int16_t>(moment.first_gate_m));
    out.u16(static_cast<std::uint16_t>(moment.gate_spacing_m));
    out.i16(to_i16(moment.folding_threshold_db * 10.0));
    out.i16(to_i16(moment.snr_threshold_db * 8.0));
    out.u8(static_cast<std::uint8_t>(moment.control_flags));
    out.u8(static_cast<std::uint8_t>(moment.word_size_bits));
    out.f32(moment.scale);
    out.f32(moment.offset);
    if (moment.word_size_bits == 8) {
        out.raw(std::span(moment.codes8).subspan(row, gates));
    } else {
        for (const std::uint16_t code : std::span(moment.codes16).subspan(row, gates)) {
            out.u16(code);
        }
    }
}

std::uint8_t azimuth_spacing_code(float spacing_deg) {
    if (spacing_deg == 0) return 0;
    return spacing_deg < 0.75F ? 1 : 2;
}

// Writes the blocks of one radial and the table of pointers to them.
class BlockTable {
  public:
    // Appends an empty table of `slots` pointers to `out`. Pointers count from `start`.
    BlockTable(ByteWriter& out, std::size_t start, std::size_t slots)
        : out_(out), start_(start), next_(out.size()) {
        out_.zeros(4 * slots);
    }
    void begin_block() {
        out_.pad_to_multiple_of(4);
        out_.set_u32(next_, static_cast<std::uint32_t>(out_.size() - start_));
        next_ += 4;
    }

  private:
    ByteWriter& out_;
    std::size_t start_;
    std::size_t next_;
};

}  // namespace

std::size_t begin_message(ByteWriter& out, std::uint8_t channel, std::uint8_t type, UtcTime time,
                          MessageRun& run) {
    const NexradTime stamp = nexrad_from_time(time);
    out.zeros(communications_header_bytes);
    const std::size_t size_position = out.size();
    out.u16(0);
    out.u8(channel);
    out.u8(type);
    out.u16(run.sequence++);
    out.u16(static_cast<std::uint16_t>(stamp.day));
    out.u32(stamp.milliseconds);
    out.u16(1);  // number of segments
    out.u16(1);  // number of this segment
    return size_position;
}

void end_message(ByteWriter& out, std::size_t size_position) {
    const std::size_t halfwords = (out.size() - size_position) / 2;
    out.set_u16(size_position, static_cast<std::uint16_t>(halfwords));
}

// Builds that send CFP (19 and later) have room for ten pointers, earlier builds for nine.
MessageRun::MessageRun(const Volume& volume) {
    const auto has_cfp = [](const Sweep& sweep) { return sweep.find(Moment::cfp) != nullptr; };
    const bool late = std::any_of(volume.sweeps.begin(), volume.sweeps.end(), has_cfp);
    pointer_slots = late ? 10 : 9;
}

Status append_metadata(ByteWriter& out, const Volume& volume, UtcTime time, MessageRun& run) {
    // Leave out message 2 of an RDA before the Open RDA, because a Volume does not hold its
    // content.
    const bool legacy = !volume.sweeps.empty() && volume.sweeps.front().message_type == 1;
    const std::size_t used_frames = (volume.vcp_message ? 1U : 0U) + (legacy ? 0U : 1U);
    out.zeros((metadata_frames - used_frames) * frame_bytes);
    if (volume.vcp_message) {
        Status written = append_vcp(out, *volume.vcp_message, time, run);
        if (!written) return written;
    }
    if (!legacy) append_status(out, volume, time, run);
    return {};
}

Status append_radial(ByteWriter& out, const Volume& volume, const Sweep& sweep, std::size_t index,
                     MessageRun& run) {
    const Radial& radial = sweep.radials[index];
    const bool elevation_block = has_elevation_block(radial);
    const bool radial_block = has_radial_block(radial);
    std::size_t blocks = 1U + (elevation_block ? 1U : 0U) + (radial_block ? 1U : 0U);
    for (const SweepMoment& moment : sweep.moments) {
        if (moment.gate_counts[index] > 0) ++blocks;
    }

    const NexradTime stamp = nexrad_from_time(radial.time);
    const std::size_t size_position = begin_message(out, orda_channel, 31, radial.time, run);
    const std::size_t start = out.size();
    out.text(volume.station, 4);
    out.u32(stamp.milliseconds);
    out.u16(static_cast<std::uint16_t>(stamp.day));
    out.u16(radial.azimuth_number);
    out.f32(radial.azimuth_deg);
    out.u8(0);  // not compressed
    out.u8(0);
    const std::size_t length_position = out.size();
    out.u16(0);
    out.u8(azimuth_spacing_code(sweep.azimuth_spacing_deg));
    out.u8(radial.status);
    out.u8(static_cast<std::uint8_t>(sweep.elevation_number));
    out.u8(radial.cut_sector);
    out.f32(radial.elevation_deg);
    out.u8(radial.spot_blanking);
    out.u8(radial.azimuth_indexing);
    out.u16(static_cast<std::uint16_t>(blocks));

    BlockTable table(out, start, std::max(run.pointer_slots, blocks));
    table.begin_block();
    append_volume_block(out, *volume.block);
    if (elevation_block) {
        table.begin_block();
        append_elevation_block(out, radial);
    }
    if (radial_block) {
        table.begin_block();
        append_radial_block(out, radial);
    }
    for (const SweepMoment& moment : sweep.moments) {
        if (moment.gate_counts[index] == 0) continue;
        table.begin_block();
        append_moment(out, moment, index);
    }
    out.pad_to_multiple_of(4);

    const std::size_t length = out.size() - start;
    if (length > 0xFFFF) {
        return refuse("radial {} of elevation {} takes {} bytes; message 31 holds 65535",
                      radial.azimuth_number, sweep.elevation_number, length);
    }
    out.set_u16(length_position, static_cast<std::uint16_t>(length));
    end_message(out, size_position);
    return {};
}

}  // namespace stormcellar::level2
