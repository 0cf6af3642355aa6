#include "tests/level2/wire.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <stdexcept>

#include <bzlib.h>
#include <zlib.h>

namespace stormcellar::level2::wire {

Writer& Writer::put(std::uint32_t number, int width) {
    for (int shift = 8 * (width - 1); shift >= 0; shift -= 8)
        bytes.push_back(static_cast<std::byte>((number >> shift) & 0xFFU));
    return *this;
}

Writer& Writer::f32(float number) {
    return u32(std::bit_cast<std::uint32_t>(number));
}

Writer& Writer::text(std::string_view characters) {
    for (const char c : characters)
        bytes.push_back(static_cast<std::byte>(c));
    return *this;
}

Writer& Writer::zeros(std::size_t count) {
    bytes.resize(bytes.size() + count);
    return *this;
}

Writer& Writer::raw(std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return *this;
}

void overwrite_u16(Bytes& bytes, std::size_t at, unsigned number) {
    bytes.at(at) = static_cast<std::byte>((number >> 8) & 0xFFU);
    bytes.at(at + 1) = static_cast<std::byte>(number & 0xFFU);
}

void overwrite_u32(Bytes& bytes, std::size_t at, std::uint32_t number) {
    overwrite_u16(bytes, at, number >> 16);
    overwrite_u16(bytes, at + 2, number & 0xFFFFU);
}

Bytes archive_header(std::string_view filename, std::string_view icao) {
    return Writer{}.text(filename).u32(day).u32(3'600'000).text(icao).bytes;
}

Bytes message_header(unsigned type, unsigned size_halfwords, unsigned segments, unsigned segment) {
    Writer writer;
    writer.zeros(12).u16(size_halfwords).u8(8).u8(type).u16(7).u16(day).u32(3'600'000);
    return writer.u16(segments).u16(segment).bytes;
}

Bytes frame(unsigned type, std::span<const std::byte> body) {
    Bytes bytes = type == 0 ? Bytes(28) : message_header(type, 1208);
    bytes.insert(bytes.end(), body.begin(), body.end());
    bytes.resize(2432);
    return bytes;
}

namespace {

Bytes with_length(const Bytes& body) {
    Bytes bytes = message_header(31, static_cast<unsigned>((body.size() + 16) / 2));
    bytes.insert(bytes.end(), body.begin(), body.end());
    return bytes;
}

// Writes the 32 bytes of a message 31 before the pointers.
Writer radial_header(const Ray& ray, unsigned blocks) {
    Writer writer;
    writer.text("KTLX").u32(ray.ms).u16(day).u16(ray.azimuth_number).f32(ray.azimuth_deg);
    writer.u8(0).u8(0).u16(0).u8(2).u8(ray.status).u8(ray.elevation_number).u8(0);
    return writer.f32(ray.elevation_deg).u8(0).u8(0).u16(blocks);
}

Bytes moment_block(std::string_view name, const Ray& ray, unsigned bits, float scale,
                   float offset) {
    Writer writer;
    writer.text(name).u32(0).u16(ray.gates).u16(2125).u16(250).u16(50).u16(16).u8(0).u8(bits);
    writer.f32(scale).f32(offset);
    for (unsigned gate = 0; gate < ray.gates; ++gate) {
        if (bits == 8) {
            writer.u8(ray.fill);
        } else {
            writer.u16(ray.fill + 256 * (gate % 3));
        }
    }
    if (writer.bytes.size() % 2 != 0) writer.u8(0);
    return writer.bytes;
}

Bytes volume_block() {
    Writer writer;
    writer.text("RVOL").u16(44).u8(1).u8(0).f32(35.3333F).f32(-97.2778F).u16(370).u16(20);
    return writer.f32(-44.5F).f32(700).f32(700).f32(0.1F).f32(60).u16(212).u16(3).bytes;
}

Bytes radial_block() {
    Writer writer;
    writer.text("RRAD").u16(28).u16(4660).f32(-80).f32(-81).u16(832).u16(0);
    return writer.f32(-44.25F).f32(-44.5F).bytes;
}

Bytes elevation_block() {
    return Writer{}.text("RELV").u16(12).u16(0xFFF4).f32(-44.25F).bytes;
}

}  // namespace

Bytes message_31(const Ray& ray) {
    const std::vector<Bytes> blocks = {volume_block(), elevation_block(), radial_block(),
                                       moment_block("DREF", ray, 8, 2, 66),
                                       moment_block("DRHO", ray, 16, 300, -60.5F)};
    Writer body = radial_header(ray, static_cast<unsigned>(blocks.size()));
    std::size_t at = 32 + 4 * blocks.size();
    for (const Bytes& block : blocks) {
        body.u32(static_cast<std::uint32_t>(at));
        at += block.size();
    }
    for (const Bytes& block : blocks)
        body.raw(block);
    return with_length(body.bytes);
}

Bytes message_31_with_block(std::span<const std::byte> block) {
    return with_length(radial_header({}, 1).u32(36).raw(block).bytes);
}

namespace {

// Returns an angle in units of 180/32768 degree; negative angles wrap around.
unsigned angle(float deg) {
    return static_cast<unsigned>(static_cast<int>(deg / 180.0F * 32768.0F)) & 0xFFFFU;
}

}  // namespace

Bytes message_1(const Ray& ray) {
    Writer body;
    body.u32(ray.ms).u16(day).u16(4660).u16(angle(ray.azimuth_deg)).u16(ray.azimuth_number);
    body.u16(ray.status).u16(angle(ray.elevation_deg)).u16(ray.elevation_number);
    body.u16(0).u16(0xFE89).u16(1000).u16(250).u16(ray.gates).u16(2 * ray.gates).u16(1).u32(0);
    body.u16(100).u16(100 + ray.gates).u16(100 + 3 * ray.gates).u16(4).u16(21).zeros(14);
    body.u16(2632).u16(12).u16(50).u16(0).zeros(32);
    for (unsigned gate = 0; gate < 5 * ray.gates; ++gate)
        body.u8(ray.fill);
    return frame(1, body.bytes);
}

Bytes vcp_frame(unsigned pattern, std::span<const float> elevations_deg) {
    Writer body;
    body.u16(0).u16(2).u16(pattern).u16(static_cast<unsigned>(elevations_deg.size()));
    body.u8(1).u8(2).u8(4).u8(2).u32(0).u16(3).u16(0x1003).u16(0);
    for (const float elevation_deg : elevations_deg) {
        body.u16(angle(elevation_deg));
        body.u8(2).u8(1).u8(11).u8(3).u16(28).u16(0xFFFE);
        for (unsigned threshold = 16; threshold < 22; ++threshold)
            body.u16(threshold);
        body.u16(1).u16(2).u16(3).u16(0x0213).u16(4).u16(5).u16(6).u16(7);
        body.u16(8).u16(9).u16(10).u16(11);
    }
    return frame(5, body.bytes);
}

Bytes bzip2(std::span<const std::byte> bytes, int level) {
    auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 50 + 700);
    Bytes out(size);
    Bytes in{bytes.begin(), bytes.end()};
    if (BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &size,
                                 reinterpret_cast<char*>(in.data()),
                                 static_cast<unsigned>(in.size()), level, 0, 0) != BZ_OK) {
        throw std::runtime_error("bzip2 failed");
    }
    out.resize(size);
    return out;
}

Bytes unpack_bzip2(std::span<const std::byte> bytes) {
    Bytes out(std::size_t{4} << 20);
    Bytes in{bytes.begin(), bytes.end()};
    for (;;) {
        auto size = static_cast<unsigned>(out.size());
        const int code = BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(out.data()), &size,
                                                    reinterpret_cast<char*>(in.data()),
                                                    static_cast<unsigned>(in.size()), 0, 0);
        if (code == BZ_OK) {
            out.resize(size);
            return out;
        }
        if (code != BZ_OUTBUFF_FULL) throw std::runtime_error("not a bzip2 stream");
        out.resize(2 * out.size());
    }
}

Bytes ldm_record(std::span<const std::byte> messages, bool last, int level) {
    const Bytes stream = bzip2(messages, level);
    const auto length = static_cast<std::uint32_t>(stream.size());
    return Writer{}.u32(last ? ~length + 1 : length).raw(stream).bytes;
}

namespace {

// Writes codes as compress does: low bits first, in groups of eight codes of one width.
class CodeWriter {
  public:
    explicit CodeWriter(Bytes& out) : out_(out) {}

    void put(std::uint32_t code, int width) {
        for (int bit = 0; bit < width; ++bit) {
            if (bits_ % 8 == 0) out_.push_back(std::byte{0});
            out_.back() |= static_cast<std::byte>(((code >> bit) & 1U) << (bits_ % 8));
            ++bits_;
        }
        codes_ = (codes_ + 1) % 8;
    }
    void end_group(int width) {
        while (codes_ != 0)
            put(0, width);
    }

  private:
    Bytes& out_;
    std::size_t bits_ = 0;
    int codes_ = 0;
};

}  // namespace

Bytes compress(std::span<const std::byte> plain, int most_width, std::size_t clear_every) {
    constexpr std::uint32_t clear_code = 256;
    Bytes out = {std::byte{0x1F}, std::byte{0x9D}, static_cast<std::byte>(0x80 | most_width)};
    CodeWriter writer(out);
    // entries[code][byte] is the code of the string of `code` followed by `byte`; 0: none
    std::vector<std::array<std::uint32_t, 256>> entries(clear_code + 1);
    int width = 9;
    std::size_t cleared_at = 0;
    const auto emit = [&](std::uint32_t code) {
        writer.put(code, width);
        // compress widens codes to 10 bits even if the limit is 9.
        if (width < std::max(most_width, 10) && entries.size() >= (1U << width))
            writer.end_group(width++);
    };
    std::optional<std::uint32_t> string;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const auto literal = std::to_integer<std::uint32_t>(plain[i]);
        if (!string) {
            string = literal;
            continue;
        }
        if (const std::uint32_t known = entries[*string][literal]; known != 0) {
            string = known;
            continue;
        }
        emit(*string);
        if (entries.size() < (1U << most_width)) {
            entries[*string][literal] = static_cast<std::uint32_t>(entries.size());
            entries.emplace_back();
        }
        string = literal;
        if (clear_every != 0 && i - cleared_at >= clear_every) {
            emit(*string);
            string.reset();
            writer.put(clear_code, width);
            writer.end_group(width);
            width = 9;
            entries.assign(clear_code + 1, {});
            cleared_at = i;
        }
    }
    if (string) emit(*string);
    return out;
}

Bytes gzip(std::span<const std::byte> bytes) {
    z_stream z{};
    if (deflateInit2(&z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
        throw std::runtime_error("gzip failed");
    }
    Bytes in{bytes.begin(), bytes.end()};
    Bytes out(deflateBound(&z, in.size()) + 64);
    z.next_in = reinterpret_cast<Bytef*>(in.data());
    z.avail_in = static_cast<uInt>(in.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    const int code = deflate(&z, Z_FINISH);
    out.resize(z.total_out);
    deflateEnd(&z);
    if (code != Z_STREAM_END) throw std::runtime_error("gzip failed");
    return out;
}

Bytes compressed_message_31(const Bytes& message, int indicator) {
    constexpr std::size_t head = 28, first_pointer_at = 32;
    Bytes body(message.begin() + head, message.end());
    const auto low = [&](std::size_t at) { return std::to_integer<std::size_t>(body[at]); };
    const std::size_t plain = (low(first_pointer_at + 2) << 8) | low(first_pointer_at + 3);
    overwrite_u16(body, 18, static_cast<unsigned>(body.size()));
    body[16] = static_cast<std::byte>(indicator);
    const Bytes data(body.begin() + static_cast<std::ptrdiff_t>(plain), body.end());
    Bytes packed = bzip2(data);
    if (indicator == 2) {
        packed.resize(compressBound(data.size()));
        uLongf size = packed.size();
        const auto* from = reinterpret_cast<const Bytef*>(data.data());
        if (::compress(reinterpret_cast<Bytef*>(packed.data()), &size, from, data.size()) != Z_OK) {
            throw std::runtime_error("zlib failed");
        }
        packed.resize(size);
    }
    body.resize(plain);
    body.insert(body.end(), packed.begin(), packed.end());
    if (body.size() % 2 != 0) body.push_back(std::byte{0});
    return with_length(body);
}

Bytes join(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const Bytes& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

Bytes radial_messages(unsigned sweeps, unsigned radials, unsigned gates) {
    Writer all;
    for (unsigned sweep = 0; sweep < sweeps; ++sweep) {
        for (unsigned i = 0; i < radials; ++i) {
            Ray ray;
            ray.azimuth_deg = static_cast<float>(i % 360);
            ray.azimuth_number = i + 1;
            ray.elevation_number = sweep + 1;
            ray.elevation_deg = 0.5F + static_cast<float>(sweep);
            ray.gates = gates;
            ray.fill = 2 + (7 * i + sweep) % 200;
            if (i == 0) ray.status = sweep == 0 ? 3 : 0;
            if (i + 1 == radials) ray.status = sweep + 1 == sweeps ? 4 : 2;
            all.raw(message_31(ray));
        }
    }
    return all.bytes;
}

Bytes ldm_volume(unsigned sweeps, unsigned radials, unsigned gates) {
    std::vector<float> elevations_deg;
    for (unsigned sweep = 0; sweep < sweeps; ++sweep)
        elevations_deg.push_back(0.5F + static_cast<float>(sweep));
    const Bytes metadata = join({frame(0), vcp_frame(212, elevations_deg), frame(2)});
    Bytes all = join({archive_header(), ldm_record(metadata)});
    const Bytes messages = radial_messages(sweeps, radials, gates);
    const std::size_t sweep_bytes = messages.size() / std::max(sweeps, 1U);
    for (unsigned sweep = 0; sweep < sweeps; ++sweep) {
        const auto part = std::span{messages}.subspan(sweep * sweep_bytes, sweep_bytes);
        all = join({all, ldm_record(part, sweep + 1 == sweeps)});
    }
    return all;
}

}  // namespace stormcellar::level2::wire
