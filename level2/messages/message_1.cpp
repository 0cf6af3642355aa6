// Reads message 1, digital radar data of the first RDA (ICD 2620002, table III; used until 2008).
#include <array>

#include "base/byte_reader.h"
#include "level2/messages/radial_message.h"

namespace stormcellar::level2 {
namespace {

// The gate geometry that all moments of one waveform, surveillance or Doppler, share.
struct Gates {
    std::int32_t first_m = 0;
    std::int32_t spacing_m = 0;
    std::uint16_t count = 0;
};

constexpr std::size_t data_bytes = 100;  // before the gates

// The place of a moment's gates in the message.
struct Extent {
    std::size_t begin = 0;  // 0: the radial lacks the moment
    std::size_t end = 0;
};

// Adds a moment, if the radial has it. Returns false if its gates are not within the data, or if
// another moment begins among them.
bool add_moment(RadialMessage& message, MomentBlock block, const Gates& gates,
                const std::array<Extent, 3>& extents, std::size_t own,
                std::span<const std::byte> body) {
    const Extent& extent = extents.at(own);
    if (extent.begin == 0) return true;
    if (extent.begin < data_bytes) return false;
    for (const Extent& other : extents) {
        if (other.begin > extent.begin && other.begin < extent.end) return false;
    }
    ByteReader reader{body};
    reader.seek(extent.begin);
    block.first_gate_m = gates.first_m;
    block.gate_spacing_m = gates.spacing_m;
    block.gates = gates.count;
    block.codes = reader.bytes(gates.count);
    return !reader.failed() && message.add(block);
}

// Returns blocks for REF, VEL and SW with their scale, offset and threshold. Velocity has steps of
// 0.5 m/s (resolution 2) or 1 m/s (4).
std::array<MomentBlock, 3> moment_blocks(std::uint16_t velocity_resolution, float threshold_db) {
    std::array<MomentBlock, 3> blocks;
    blocks[0].moment = Moment::ref;
    blocks[1].moment = Moment::vel;
    blocks[2].moment = Moment::sw;
    blocks[0].scale = 2;
    blocks[0].offset = 66;
    blocks[1].scale = velocity_resolution == 4 ? 1.0F : 2.0F;
    blocks[1].offset = 129;
    blocks[2].scale = 2;
    blocks[2].offset = 129;
    for (MomentBlock& block : blocks)
        block.folding_threshold_db = threshold_db;
    return blocks;
}

}  // namespace

RadialResult read_message_1(std::span<const std::byte> body, Framing framing) {
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
    reader.skip(4);  // calibration constant, which is not the dBZ0 of message 31
    std::array<std::uint16_t, 3> pointers{};  // REF, VEL, SW
    for (std::uint16_t& pointer : pointers)
        pointer = reader.u16();
    const std::uint16_t velocity_resolution = reader.u16();
    message.vcp = reader.u16();
    reader.skip(14);
    radial.nyquist_mps = static_cast<float>(reader.i16()) / 100.0F;
    radial.attenuation_db_per_km_thousandths = reader.i16();
    const float threshold_db = static_cast<float>(reader.i16()) / 10.0F;
    radial.spot_blanking = static_cast<std::uint8_t>(reader.u16());
    if (reader.failed()) return tl::unexpected(std::string_view{"message 1 is too short"});

    const std::array<MomentBlock, 3> blocks = moment_blocks(velocity_resolution, threshold_db);
    std::array<Extent, 3> extents;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const std::size_t gates = i == 0 ? surveillance.count : doppler.count;
        if (pointers.at(i) != 0 && gates != 0) {
            extents.at(i) = {pointers.at(i), pointers.at(i) + gates};
        }
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const Gates& gates = i == 0 ? surveillance : doppler;
        if (add_moment(message, blocks.at(i), gates, extents, i, body)) continue;
        constexpr std::string_view reason = "gates reach beyond message 1 or into other gates";
        if (framing == Framing::unproven) return tl::unexpected(reason);
        message.lost_moments.push_back({reason, gates.count});
    }
    if (message.has_lost_all()) return tl::unexpected(message.lost_moments.front().reason);
    return message;
}

}  // namespace stormcellar::level2
