#include "level2/messages/message_5.h"

#include "base/byte_reader.h"
#include "level2/messages/radial_message.h"

namespace stormcellar::level2 {
namespace {

VcpCut read_cut(ByteReader& reader) {
    VcpCut cut;
    cut.elevation_deg = elevation_from_code(reader.u16());
    cut.channel_configuration = reader.u8();
    cut.waveform = reader.u8();
    cut.super_resolution = reader.u8();
    cut.surveillance_prf = reader.u8();
    cut.surveillance_pulses = reader.u16();
    cut.azimuth_rate_code = reader.i16();
    for (std::int16_t& threshold : cut.thresholds_eighth_db)
        threshold = reader.i16();
    // The supplemental flags are between the Doppler sectors 1 and 2.
    for (std::size_t i = 0; i < cut.rest.size(); ++i) {
        if (i == 6) cut.supplemental = reader.u16();
        cut.rest[i] = reader.u8();
    }
    return cut;
}

}  // namespace

std::optional<Vcp> read_vcp(int message_type, std::span<const std::byte> body) {
    ByteReader reader{body};
    Vcp vcp;
    vcp.message_type = message_type;
    reader.skip(2);  // the size, which the message header gives too
    vcp.pattern_type = reader.u16();
    vcp.pattern_number = reader.u16();
    const std::uint16_t cuts = reader.u16();
    vcp.version = reader.u8();
    vcp.clutter_group = reader.u8();
    vcp.doppler_resolution = reader.u8();
    vcp.pulse_width = reader.u8();
    reader.skip(4);
    vcp.sequencing = reader.u16();
    vcp.supplemental = reader.u16();
    reader.skip(2);
    if (reader.failed() || vcp.pattern_number == 0 || cuts == 0) return std::nullopt;
    for (std::uint16_t i = 0; i < cuts && !reader.failed(); ++i)
        vcp.cuts.push_back(read_cut(reader));
    if (reader.failed()) return std::nullopt;
    return vcp;
}

}  // namespace stormcellar::level2
