// Reads message 31, digital radar data in the generic format (ICD 2620002, tables XVII-A to
// XVII-I).
#include <algorithm>
#include <array>
#include <cmath>

#include "base/byte_reader.h"
#include "base/floating_point.h"
#include "level2/messages/radial_message.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t volume_block_bytes = 44;        // of the first version
constexpr std::size_t radial_block_short_bytes = 20;  // without calibration
constexpr std::size_t radial_block_full_bytes = 28;
constexpr std::uint16_t most_blocks = 32;  // the known maximum is 10
// Most bytes after the gates of a moment; TDWRs leave up to 7.
constexpr std::size_t most_padding_bytes = 16;

std::optional<float> finite(float number) {
    return std::isfinite(number) ? std::optional{number} : std::nullopt;
}

// The reason for a fault in a block, or none. The functions that read blocks return it.
using Reason = std::optional<std::string_view>;

Reason read_radial_block(Radial& radial, std::span<const std::byte> block) {
    ByteReader reader{block};
    reader.skip(4);
    const std::uint16_t size = reader.u16();
    const auto range_m = static_cast<float>(reader.u16()) * 100.0F;
    const std::optional<float> horizontal_dbm = finite(reader.f32());
    const std::optional<float> vertical_dbm = finite(reader.f32());
    const auto nyquist_mps = static_cast<float>(reader.u16()) / 100.0F;
    const std::uint16_t flags = reader.u16();
    if (reader.failed() || size < radial_block_short_bytes) return "radial block is too short";
    radial.unambiguous_range_m = range_m;
    radial.horizontal_noise_dbm = horizontal_dbm;
    radial.vertical_noise_dbm = vertical_dbm;
    radial.nyquist_mps = nyquist_mps;
    radial.radial_flags = flags;
    if (size >= radial_block_full_bytes && reader.remaining() >= 8) {
        radial.calibration_dbz = finite(reader.f32());
        radial.vertical_calibration_dbz = finite(reader.f32());
    }
    return std::nullopt;
}

Reason read_elevation_block(Radial& radial, std::span<const std::byte> block) {
    ByteReader reader{block};
    reader.skip(6);
    const std::int16_t attenuation = reader.i16();
    const std::optional<float> calibration_db = finite(reader.f32());
    if (reader.failed()) return "elevation block is too short";
    radial.attenuation_db_per_km_thousandths = attenuation;
    radial.elevation_calibration_db = calibration_db;
    return std::nullopt;
}

// Reads the block of a moment. `bytes` ends where the next block begins.
Reason read_moment_block(RadialMessage& message, Moment moment, std::span<const std::byte> bytes) {
    ByteReader reader{bytes};
    reader.skip(8);
    MomentBlock block;
    block.moment = moment;
    block.gates = reader.u16();
    block.first_gate_m = reader.i16();
    block.gate_spacing_m = reader.u16();
    block.folding_threshold_db = static_cast<float>(reader.i16()) / 10.0F;
    block.snr_threshold_db = static_cast<float>(reader.i16()) / 8.0F;
    block.control_flags = reader.u8();
    block.word_size_bits = reader.u8();
    block.scale = reader.f32();
    block.offset = reader.f32();
    if (reader.failed()) return "moment block is too short";
    if (block.gates == 0) return std::nullopt;
    if (block.word_size_bits != 8 && block.word_size_bits != 16) return "gates are not 8 or 16 bit";
    if (!std::isfinite(block.scale) || !std::isfinite(block.offset)) {
        return "scale or offset is not a number";
    }
    const std::size_t wide = std::size_t{2} * block.gates;
    if (block.word_size_bits == 8 && reader.remaining() >= wide &&
        reader.remaining() <= wide + most_padding_bytes) {
        return "gates have 16 bits, but their block says 8";
    }
    block.codes = reader.bytes(block.word_size_bits == 8 ? wide / 2 : wide);
    if (reader.failed()) return "gates reach beyond the end of their block";
    if (!message.add(block)) return "a moment comes twice";
    if (reader.remaining() > most_padding_bytes) {
        message.oddities.emplace_back("blocks are longer than the gates that they count");
    }
    return std::nullopt;
}

// The part of a radial that is lost by a fault in a block.
enum class Loss : std::uint8_t { nothing, moment, radial };

struct Fault {
    Loss loss = Loss::nothing;
    std::string_view reason;
};
using BlockFault = std::optional<Fault>;

BlockFault fault_of(Loss loss, const Reason& reason) {
    return reason ? BlockFault{Fault{loss, *reason}} : std::nullopt;
}

void read_volume_block_facts(RadialMessage& message, std::span<const std::byte> block) {
    message.volume_block = block;
    ByteReader reader{block};
    reader.skip(4);
    const std::uint16_t size = reader.u16();
    reader.skip(34);
    const std::uint16_t vcp = reader.u16();
    if (!reader.failed()) message.vcp = vcp;
    if (reader.remaining() < 2 || size < volume_block_bytes) {
        message.oddities.emplace_back("volume block is too short");
    }
}

BlockFault read_block(RadialMessage& message, std::span<const std::byte> block) {
    ByteReader reader{block};
    const std::string_view name = reader.text(4);
    if (reader.failed()) return Fault{Loss::radial, "a block lies outside message 31"};
    if (name == "RVOL") {
        read_volume_block_facts(message, block);
        return std::nullopt;
    }
    if (name == "RELV") return fault_of(Loss::nothing, read_elevation_block(message.radial, block));
    if (name == "RRAD") return fault_of(Loss::nothing, read_radial_block(message.radial, block));
    std::string_view moment = name.substr(1);
    while (moment.ends_with(' '))
        moment.remove_suffix(1);
    const std::optional<Moment> known = moment_from_name(moment);
    if (name.front() == 'D' && known) {
        return fault_of(Loss::moment, read_moment_block(message, *known, block));
    }
    // A later build may have blocks with unknown names. If the name is not even text, a pointer is
    // wrong.
    for (const char c : name) {
        if (c < ' ' || c > '~') return Fault{Loss::radial, "a block's name is not text"};
    }
    ++message.unknown_blocks;
    return std::nullopt;
}

// The pointers of a message 31, and the size of its body.
struct BlockPlaces {
    std::array<std::uint32_t, most_blocks> pointers{};
    std::size_t count = 0;
    std::size_t body_bytes = 0;

    [[nodiscard]] std::span<const std::uint32_t> all() const { return {pointers.data(), count}; }
    [[nodiscard]] std::size_t end_of(std::uint32_t pointer) const {
        std::size_t end = body_bytes;
        for (const std::uint32_t other : all()) {
            if (other > pointer) end = std::min<std::size_t>(end, other);
        }
        return end;
    }
};

tl::expected<BlockPlaces, std::string_view> read_places(ByteReader& reader, std::uint16_t blocks,
                                                        std::size_t body_bytes) {
    if (blocks > most_blocks) {
        return tl::unexpected(std::string_view{"message 31 counts more than 32 blocks"});
    }
    BlockPlaces places;
    places.body_bytes = body_bytes;
    for (std::uint16_t i = 0; i < blocks; ++i) {
        const std::uint32_t pointer = reader.u32();
        if (reader.failed()) return tl::unexpected(std::string_view{"block pointers are cut"});
        if (pointer == 0) continue;  // the radial lacks this block
        if (pointer >= body_bytes) {
            return tl::unexpected(std::string_view{"a block lies outside message 31"});
        }
        places.pointers.at(places.count++) = pointer;
    }
    return places;
}

}  // namespace

RadialResult read_message_31(std::span<const std::byte> body, Framing framing) {
    ByteReader reader{body};
    RadialMessage message;
    Radial& radial = message.radial;
    message.icao = reader.text(4);
    const std::uint32_t ms = reader.u32();
    const std::uint16_t date = reader.u16();
    radial.time = time_from_nexrad(date, ms);
    radial.azimuth_number = reader.u16();
    radial.azimuth_deg = reader.f32();
    reader.skip(4);  // compression, spare, radial length
    const std::uint8_t spacing = reader.u8();
    message.azimuth_spacing_deg = spacing == 1 ? 0.5F : (spacing == 2 ? 1.0F : 0.0F);
    radial.status = reader.u8();
    message.elevation_number = reader.u8();
    radial.cut_sector = reader.u8();
    radial.elevation_deg = reader.f32();
    radial.spot_blanking = reader.u8();
    radial.azimuth_indexing = reader.u8();
    const std::uint16_t blocks = reader.u16();
    if (reader.failed()) return tl::unexpected(std::string_view{"message 31 is too short"});
    // is_within() is false for NaN.
    const bool angles_possible = is_within(radial.azimuth_deg, 0.0F, 360.0F) &&
                                 is_within(radial.elevation_deg, -90.0F, 90.0F);
    if (!angles_possible) return tl::unexpected(std::string_view{"angles are impossible"});

    const auto places = read_places(reader, blocks, body.size());
    if (!places) return tl::unexpected(places.error());
    for (const std::uint32_t pointer : places->all()) {
        const std::size_t bytes = places->end_of(pointer) - pointer;
        const BlockFault fault = read_block(message, body.subspan(pointer, bytes));
        if (!fault) continue;
        if (fault->loss == Loss::radial || framing == Framing::unproven) {
            return tl::unexpected(fault->reason);
        }
        if (fault->loss == Loss::moment) {
            message.lost_moments.push_back({fault->reason, bytes});
        } else {
            message.oddities.push_back(fault->reason);
        }
    }
    if (message.has_lost_all()) return tl::unexpected(message.lost_moments.front().reason);
    return message;
}

std::optional<VolumeBlock> read_volume_block(std::span<const std::byte> bytes) {
    ByteReader reader{bytes};
    VolumeBlock block;
    reader.skip(4);
    block.size_bytes = reader.u16();
    block.version_major = reader.u8();
    block.version_minor = reader.u8();
    block.latitude_deg = reader.f32();
    block.longitude_deg = reader.f32();
    block.site_height_m = reader.i16();
    block.tower_height_m = reader.u16();
    block.calibration_db = reader.f32();
    block.horizontal_power_kw = reader.f32();
    block.vertical_power_kw = reader.f32();
    block.differential_reflectivity_db = reader.f32();
    block.initial_differential_phase_deg = reader.f32();
    block.vcp = reader.u16();
    block.processing_status = reader.u16();
    if (reader.failed() || block.size_bytes < volume_block_bytes) return std::nullopt;
    for (const std::byte b : reader.bytes(block.size_bytes - volume_block_bytes)) {
        block.rest.push_back(std::to_integer<std::uint8_t>(b));
    }
    if (reader.failed()) return std::nullopt;
    return block;
}

}  // namespace stormcellar::level2
