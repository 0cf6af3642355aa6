// Writes message 1, digital radar data of the first RDA (ICD 2620002, table III).
#include <algorithm>
#include <array>
#include <cmath>

#include "level2/encode/encode_checks.h"
#include "level2/encode/encode_messages.h"

namespace stormcellar::level2 {
namespace {

constexpr std::uint8_t legacy_channel = 0;
constexpr std::size_t data_at = 100;  // offset of the first gate, after the message header
constexpr std::size_t body_bytes = frame_bytes - message_header_bytes;
constexpr double code_per_degree = 32768.0 / 180.0;

std::uint16_t angle_code(float angle_deg) {
    const auto code = std::lround(angle_deg * code_per_degree);
    return static_cast<std::uint16_t>(static_cast<unsigned long>(code) & 0xFFFFU);
}

// The moments of a radial; null for a moment that the radial lacks.
struct Gates {
    const SweepMoment* ref = nullptr;
    const SweepMoment* vel = nullptr;
    const SweepMoment* sw = nullptr;

    [[nodiscard]] const SweepMoment* doppler() const { return vel != nullptr ? vel : sw; }
};

std::size_t count_of(const SweepMoment* moment, std::size_t radial) {
    return moment == nullptr ? 0 : moment->gate_counts[radial];
}

Gates gates_of(const Sweep& sweep, std::size_t radial) {
    Gates gates;
    for (const SweepMoment& moment : sweep.moments) {
        if (moment.gate_counts[radial] == 0) continue;
        if (moment.moment == Moment::ref) gates.ref = &moment;
        if (moment.moment == Moment::vel) gates.vel = &moment;
        if (moment.moment == Moment::sw) gates.sw = &moment;
    }
    return gates;
}

Status check(const Sweep& sweep, std::size_t index, const Gates& gates) {
    const std::size_t codes =
        count_of(gates.ref, index) + count_of(gates.vel, index) + count_of(gates.sw, index);
    if (data_at + codes > body_bytes) {
        return refuse("radial {} of elevation {} has {} gates; a frame holds {}", index,
                      sweep.elevation_number, codes, body_bytes - data_at);
    }
    return {};
}

std::int16_t first_gate(const SweepMoment* moment) {
    return static_cast<std::int16_t>(moment == nullptr ? 0 : moment->first_gate_m);
}
std::uint16_t spacing(const SweepMoment* moment) {
    return static_cast<std::uint16_t>(moment == nullptr ? 0 : moment->gate_spacing_m);
}
std::int16_t tenths(float number) {
    return static_cast<std::int16_t>(std::lround(number * 10.0));
}

void append_head(ByteWriter& out, const Volume& volume, const Sweep& sweep, std::size_t index,
                 const Gates& gates) {
    const Radial& radial = sweep.radials[index];
    const NexradTime stamp = nexrad_from_time(radial.time);
    out.u32(stamp.milliseconds);
    out.u16(static_cast<std::uint16_t>(stamp.day));
    out.u16(static_cast<std::uint16_t>(std::lround(radial.unambiguous_range_m / 100.0)));
    out.u16(angle_code(radial.azimuth_deg));
    out.u16(radial.azimuth_number);
    out.u16(radial.status);
    out.u16(angle_code(radial.elevation_deg));
    out.u16(static_cast<std::uint16_t>(sweep.elevation_number));
    out.i16(first_gate(gates.ref));
    out.i16(first_gate(gates.doppler()));
    out.u16(spacing(gates.ref));
    out.u16(spacing(gates.doppler()));
    out.u16(static_cast<std::uint16_t>(count_of(gates.ref, index)));
    out.u16(static_cast<std::uint16_t>(count_of(gates.doppler(), index)));
    out.u16(radial.cut_sector);
    out.u32(0);  // calibration constant, which a Volume does not hold
    std::size_t pointer = data_at;
    for (const SweepMoment* moment : {gates.ref, gates.vel, gates.sw}) {
        out.u16(static_cast<std::uint16_t>(moment == nullptr ? 0 : pointer));
        pointer += count_of(moment, index);
    }
    const bool coarse = gates.vel != nullptr && gates.vel->scale == 1;
    out.u16(coarse ? 4 : 2);
    out.u16(static_cast<std::uint16_t>(volume.vcp.value_or(0)));
    out.zeros(14);
    out.i16(static_cast<std::int16_t>(std::lround(radial.nyquist_mps * 100.0)));
    out.i16(radial.attenuation_db_per_km_thousandths.value_or(std::int16_t{0}));
    const SweepMoment* any = gates.ref != nullptr ? gates.ref : gates.doppler();
    out.i16(tenths(any == nullptr ? 0 : any->folding_threshold_db));
    out.u16(radial.spot_blanking);
}

}  // namespace

Status append_radial_1(ByteWriter& out, const Volume& volume, const Sweep& sweep, std::size_t index,
                       MessageRun& run) {
    const Gates gates = gates_of(sweep, index);
    if (Status checked = check(sweep, index, gates); !checked) return checked;
    const std::size_t size_position =
        begin_message(out, legacy_channel, 1, sweep.radials[index].time, run);
    const std::size_t body = out.size();
    append_head(out, volume, sweep, index, gates);
    out.zeros(data_at - (out.size() - body));
    for (const SweepMoment* moment : {gates.ref, gates.vel, gates.sw}) {
        if (moment == nullptr) continue;
        const std::size_t row = index * static_cast<std::size_t>(moment->gate_stride);
        out.raw(std::span(moment->codes8).subspan(row, moment->gate_counts[index]));
    }
    if ((out.size() - body) % 2 != 0) out.u8(0);
    end_message(out, size_position);
    out.pad_to_multiple_of(frame_bytes);
    return {};
}

}  // namespace stormcellar::level2
