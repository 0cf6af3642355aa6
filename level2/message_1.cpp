// Message 1, digital radar data of the first RDA (ICD 2620002, table III; used until 2008).
#include "base/byte_reader.h"
#include "level2/radial_message.h"

namespace stormcellar::level2 {
namespace {

// The ranges that all moments of one kind of waveform share.
struct Gates {
    std::int32_t first_m = 0;
    std::int32_t spacing_m = 0;
    std::uint16_t count = 0;
};

// Adds one moment. A pointer of 0 means that the radial lacks it. False if it does not fit.
bool add_moment(RadialMessage& message, Moment moment, const Gates& gates, std::uint16_t pointer,
                float scale, float offset, float threshold_db, std::span<const std::byte> body) {
    if (pointer == 0 || gates.count == 0) return true;
    ByteReader reader{body};
    reader.seek(pointer);
    MomentBlock block;
    block.moment = moment;
    block.first_gate_m = gates.first_m;
    block.gate_spacing_m = gates.spacing_m;
    block.gates = gates.count;
    block.scale = scale;
    block.offset = offset;
    block.folding_threshold_db = threshold_db;
    block.codes = reader.bytes(gates.count);
    return !reader.failed() && message.add(block);
}

}  // namespace

RadialResult read_message_1(std::span<const std::byte> body) {
    ByteReader reader{body};
    RadialMessage message;
    message.message_type = 1;
    Radial& radial = message.radial;
    const std::uint32_t ms = reader.u32();
    const std::uint16_t date = reader.u16();
    radial.time = time_from_nexrad(date, ms);
    radial.unambiguous_range_m = static_cast<float>(reader.u16()) * 100.0F;
    radial.azimuth_deg = azimuth_from_code(reader.u16());
    radial.azimuth_number = reader.u16();
    radial.status = static_cast<std::uint8_t>(reader.u16());
    radial.elevation_deg = elevation_from_code(reader.u16());
    message.elevation_number = reader.u16();
    Gates surveillance;
    Gates doppler;
    surveillance.first_m = reader.i16();
    doppler.first_m = reader.i16();
    surveillance.spacing_m = reader.u16();
    doppler.spacing_m = reader.u16();
    surveillance.count = reader.u16();
    doppler.count = reader.u16();
    radial.cut_sector = static_cast<std::uint8_t>(reader.u16());
    reader.skip(4);  // calibration constant: not the dBZ0 of message 31
    const std::uint16_t ref_pointer = reader.u16();
    const std::uint16_t vel_pointer = reader.u16();
    const std::uint16_t sw_pointer = reader.u16();
    const std::uint16_t velocity_resolution = reader.u16();
    message.vcp = reader.u16();
    reader.skip(14);
    radial.nyquist_mps = static_cast<float>(reader.i16()) / 100.0F;
    radial.attenuation_db_per_km_thousandths = reader.i16();
    const float threshold_db = static_cast<float>(reader.i16()) / 10.0F;
    radial.spot_blanking = static_cast<std::uint8_t>(reader.u16());
    if (reader.failed()) return tl::unexpected(std::string_view{"message 1 is too short"});

    // Velocity comes in steps of 0.5 m/s (resolution 2) or 1 m/s (4).
    const float velocity_scale = velocity_resolution == 4 ? 1.0F : 2.0F;
    const bool fits =
        add_moment(message, Moment::ref, surveillance, ref_pointer, 2, 66, threshold_db, body) &&
        add_moment(message, Moment::vel, doppler, vel_pointer, velocity_scale, 129, threshold_db,
                   body) &&
        add_moment(message, Moment::sw, doppler, sw_pointer, 2, 129, threshold_db, body);
    if (!fits) return tl::unexpected(std::string_view{"gates reach beyond the end of message 1"});
    return message;
}

}  // namespace stormcellar::level2
