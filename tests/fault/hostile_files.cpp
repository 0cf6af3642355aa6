#include "tests/fault/hostile_files.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::fault {
namespace {

namespace wire = level2::wire;
using wire::Writer;

constexpr unsigned radials_per_record = 125;

// The radial status: the place of a radial within its sweep.
enum class Mark : unsigned {
    begins_sweep = 0,
    within = 1,
    ends_sweep = 2,
    begins_volume = 3,
    ends_volume = 4
};

Bytes moment_block(const Claims& claims, unsigned radial) {
    Writer block;
    block.text("DREF").u32(0).u16(claims.gates).u16(2125).u16(250).u16(0).u16(0).u8(0);
    block.u8(claims.word_bits).f32(claims.scale).f32(claims.offset);
    const unsigned code = claims.is_varied ? 60 + (radial * 37) % 120 : claims.code;
    const std::array<std::byte, 2> wide = {static_cast<std::byte>(code >> 8U),
                                           static_cast<std::byte>(code)};
    const std::size_t begin = block.bytes.size();
    const std::size_t width = claims.word_bits / 8;
    block.bytes.resize(begin + claims.gates * width, wide[1]);
    for (std::size_t at = begin; width == 2 && at < block.bytes.size(); at += 2)
        block.bytes[at] = wide[0];
    if (block.bytes.size() % 2 != 0) block.u8(0);
    return block.bytes;
}

Bytes volume_block(const Claims& claims) {
    Writer block;
    block.text("RVOL").u16(44).u8(1).u8(0).f32(claims.latitude_deg).f32(claims.longitude_deg);
    return block.u16(300).u16(20).zeros(20).u16(212).u16(0).bytes;
}

Bytes radial_block() {
    Writer block;
    block.text("RRAD").u16(28).u16(4600).f32(-80).f32(-80).u16(800).u16(0).f32(0).f32(0);
    return block.bytes;
}

struct Place {
    unsigned sweep = 0, radial = 0, of = 360;
    Mark mark = Mark::within;
};

void put_message(Writer& out, const Claims& claims, const Place& place) {
    const std::array<Bytes, 3> blocks = {volume_block(claims), radial_block(),
                                         moment_block(claims, place.radial)};
    std::size_t size = 32 + 4 * blocks.size();
    for (const Bytes& block : blocks)
        size += block.size();
    const std::uint32_t ms = claims.time.milliseconds + 10'000 * place.sweep + 20 * place.radial;
    out.zeros(12).u16(static_cast<unsigned>((16 + size) / 2)).u8(0).u8(31).u16(1);
    out.u16(claims.time.day).u32(ms).u16(1).u16(1);
    out.text(claims.station).u32(ms).u16(claims.time.day).u16(place.radial % 999 + 1);
    out.f32(static_cast<float>(place.radial % place.of) * 360.0F / static_cast<float>(place.of));
    out.u8(0)
        .u8(0)
        .u16(static_cast<unsigned>(size))
        .u8(2)
        .u8(static_cast<unsigned>(place.mark))
        .u8(place.sweep + 1);
    out.u8(1).f32(0.5F + static_cast<float>(place.sweep)).u8(0).u8(0).u16(blocks.size());
    std::size_t at = 32 + 4 * blocks.size();
    for (const Bytes& block : blocks) {
        out.u32(static_cast<std::uint32_t>(at));
        at += block.size();
    }
    for (const Bytes& block : blocks)
        out.raw(block);
}

Bytes all_messages(const Claims& claims) {
    Bytes all;
    for (unsigned sweep = 0; sweep < claims.sweeps; ++sweep) {
        const Bytes messages = sweep_messages(claims, sweep);
        all.insert(all.end(), messages.begin(), messages.end());
    }
    return all;
}

}  // namespace

Claims claims_of(std::string_view known_station, UtcTime start) {
    const auto station = find_station(known_station);
    if (!station) throw std::runtime_error("no station of the table");
    Claims claims;
    claims.station = std::string{known_station};
    claims.time = nexrad_from_time(start);
    claims.latitude_deg = static_cast<float>(station->latitude_deg);
    claims.longitude_deg = static_cast<float>(station->longitude_deg);
    return claims;
}

std::string invented_station(std::size_t number) {
    const auto letter = [](std::size_t n) { return static_cast<char>('A' + n % 26); };
    return {'X', letter(number / 676), letter(number / 26), letter(number)};
}

Claims invented_claims(std::size_t number, UtcTime start) {
    Claims claims;
    claims.station = invented_station(number);
    claims.time = nexrad_from_time(start);
    claims.latitude_deg = static_cast<float>(10 + number % 60);
    claims.longitude_deg = static_cast<float>(20 + number % 300) - 180;
    return claims;
}

Bytes file_header(const Claims& claims, int number) {
    Writer header;
    header.text(fmt::format("AR2V0006.{:03}", number));
    header.u32(claims.time.day).u32(claims.time.milliseconds).text(claims.station);
    return header.bytes;
}

Bytes sweep_messages(const Claims& claims, unsigned sweep) {
    Writer all;
    for (unsigned radial = 0; radial < claims.radials; ++radial) {
        Mark mark = Mark::within;
        if (radial + 1 == claims.radials)
            mark = sweep + 1 == claims.sweeps ? Mark::ends_volume : Mark::ends_sweep;
        if (radial == 0) mark = sweep == 0 ? Mark::begins_volume : Mark::begins_sweep;
        put_message(all, claims, {sweep, radial, claims.radials, mark});
    }
    return all.bytes;
}

Bytes volume_bytes(const Claims& claims) {
    return wire::join({file_header(claims),
                       wire::ldm_record(all_messages(claims), true, claims.radials < 90 ? 1 : 9)});
}

Bytes plain_volume_bytes(const Claims& claims) {
    return wire::join({file_header(claims), all_messages(claims)});
}

Bytes endless_bytes(Claims claims, unsigned radials, unsigned gates) {
    claims.gates = gates;
    claims.word_bits = 16;
    claims.code = 0x0404;  // two equal bytes, because equal bytes are compressed fastest
    // Repeat the second record instead of making more, because making records takes most of a
    // test's time.
    const auto record = [&](Mark first) {
        Writer messages;
        for (unsigned radial = 0; radial < radials_per_record; ++radial)
            put_message(messages, claims, {0, radial, 720, radial == 0 ? first : Mark::within});
        return wire::ldm_record(messages.bytes);
    };
    Bytes all = wire::join({file_header(claims), record(Mark::begins_volume)});
    if (radials <= radials_per_record) return all;
    const Bytes further = record(Mark::within);
    for (unsigned radial = radials_per_record; radial < radials; radial += radials_per_record)
        all.insert(all.end(), further.begin(), further.end());
    return all;
}

Bytes begun_record(std::uint32_t bytes) {
    Writer record;
    record.u32(bytes).text("BZh9").u8(0x31).u8(0x41).u8(0x59).u8(0x26).u8(0x53).u8(0x59);
    return record.bytes;
}

Bytes overflowing_bytes(Claims claims) {
    claims.gates = 10;
    claims.radials = 4;
    claims.scale = 1e-38F;
    claims.offset = 1e38F;
    return volume_bytes(claims);
}

}  // namespace stormcellar::fault
