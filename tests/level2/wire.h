// tests/level2/wire.h -- makes Level II bytes by hand, byte by byte as the ICDs describe them.
//
// This code is independent of the writer in stormcellar/level2/encode.h, so that the two cannot
// share a mistake.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace stormcellar::level2::wire {

using Bytes = std::vector<std::byte>;

// Appends big-endian numbers to `bytes`.
class Writer {
  public:
    Writer& u8(unsigned number) { return put(number, 1); }
    Writer& u16(unsigned number) { return put(number, 2); }
    Writer& u32(std::uint32_t number) { return put(number, 4); }
    Writer& f32(float number);
    Writer& text(std::string_view characters);
    Writer& zeros(std::size_t count);
    Writer& raw(std::span<const std::byte> more);

    Bytes bytes;

  private:
    Writer& put(std::uint32_t number, int width);
};

void overwrite_u16(Bytes& bytes, std::size_t at, unsigned number);
void overwrite_u32(Bytes& bytes, std::size_t at, std::uint32_t number);

struct Ray {
    float azimuth_deg = 10;
    float elevation_deg = 0.5F;
    unsigned azimuth_number = 1;
    unsigned elevation_number = 1;
    unsigned status = 1;
    std::uint32_t ms = 3'600'000;
    unsigned gates = 100;
    unsigned fill = 70;  // the code of every gate
};

inline constexpr unsigned day = 19069;  // 2022-03-17

Bytes archive_header(std::string_view filename = "AR2V0006.116", std::string_view icao = "KTLX");
// Returns the 28 bytes before a body. `size_halfwords` counts the body and 16 of these bytes.
Bytes message_header(unsigned type, unsigned size_halfwords, unsigned segments = 1,
                     unsigned segment = 1);
// Returns a frame of 2432 bytes with this body.
Bytes frame(unsigned type, std::span<const std::byte> body = {});
// Returns a radial with REF in 8 bits, RHO in 16 bits, and the volume, elevation and radial blocks.
Bytes message_31(const Ray& ray);
// Returns a message 31 with only this block, for tests of broken blocks.
Bytes message_31_with_block(std::span<const std::byte> block);
// Returns a message 31 with everything after its data header block compressed, by bzip2 (indicator
// 1) or zlib (2) (table XVII-A).
Bytes compressed_message_31(const Bytes& message, int indicator);
// Returns a frame of message 1 with REF, VEL and SW. VEL and SW have twice the number of gates of
// REF.
Bytes message_1(const Ray& ray);
// Returns a frame of message 5 with a pattern of these elevations.
Bytes vcp_frame(unsigned pattern, std::span<const float> elevations_deg);

Bytes bzip2(std::span<const std::byte> bytes, int level = 9);
Bytes unpack_bzip2(std::span<const std::byte> bytes);  // of one stream
Bytes ldm_record(std::span<const std::byte> messages, bool last = false, int level = 9);
Bytes gzip(std::span<const std::byte> bytes);
// Compresses as Unix compress does, with codes of at most `most_width` bits. Clears the table after
// every `clear_every` bytes; 0: never.
Bytes compress(std::span<const std::byte> plain, int most_width, std::size_t clear_every);

Bytes join(std::initializer_list<Bytes> parts);

// Returns messages 31: `sweeps` sweeps of `radials` radials each, with correct statuses.
Bytes radial_messages(unsigned sweeps, unsigned radials, unsigned gates = 100);
// Returns a whole small file: the header, a metadata record, and one record for each sweep.
Bytes ldm_volume(unsigned sweeps, unsigned radials, unsigned gates = 100);

}  // namespace stormcellar::level2::wire
