// base/checksum.h -- the two checksums that this project writes and compares.
//
// Threads   Pure functions. An Xxh3Stream may be used by one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace stormcellar {

// Returns the XXH3 hash of 64 bits with seed 0 (xxHash 0.8). This project uses the hash to find
// damage in its own files and changes of raw files.
[[nodiscard]] std::uint64_t xxh3_64(std::span<const std::byte> bytes);

// Computes the hash of xxh3_64() for bytes that come in pieces of any size.
class Xxh3Stream {
  public:
    Xxh3Stream();
    Xxh3Stream(Xxh3Stream&&) noexcept;
    Xxh3Stream& operator=(Xxh3Stream&&) noexcept;
    ~Xxh3Stream();

    void append(std::span<const std::byte> bytes);
    [[nodiscard]] std::uint64_t value() const;  // of all bytes so far

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Returns the CRC-32 of zlib, continued from `previous` (0 at the start). For an empty span,
// returns `previous`.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t previous = 0);

}  // namespace stormcellar
