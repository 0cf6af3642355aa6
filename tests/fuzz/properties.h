// tests/fuzz/properties.h -- what must hold for any bytes whatever.
//
// Each function throws a PropertyError that says what does not hold. Crashes, reads beyond the end
// and undefined behavior are the sanitizers' to find, hangs and memory the fuzzer's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::fuzz {

class PropertyError : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

template <class... Args>
void require(bool holds, fmt::format_string<Args...> what, Args&&... args) {
    if (!holds) throw PropertyError(fmt::format(what, std::forward<Args>(args)...));
}

// What decoding may give out here.
inline constexpr std::uint64_t output_limit_bytes = std::uint64_t{64} << 20;

// A whole file, in any container. One thread and two give the same volume, report or error; the
// volume is well formed; it can be described and split, and where it can be written it comes back
// to the bit.
void check_container(std::span<const std::byte> file);

// A message stream, without the 24-byte header. Read as it is and packed into an LDM record it
// gives the same; good radials before it are kept to the bit.
void check_messages(std::span<const std::byte> stream);

// A file behind eight bytes that decide the order. As it grows it gives what it gives whole; cut
// into chunks, of which some are lost, repeated or damaged, it gives the same in any order.
void check_live(std::span<const std::byte> input);

// A .Z file: expands as slow_expand() does. The same bytes taken as plain text come back from a
// compressor.
void check_compress(std::span<const std::byte> file);

// A tar or zip archive: what comes out stays within its limits, its names lead nowhere and are each
// its own, and it has an end.
void check_archive(std::span<const std::byte> file);

// Bytes that decide on a bzip2 stream (tests/bunzip/stream_maker.h), valid, odd or damaged. Each
// path of this machine gives what libbz2 gives, byte by byte, and ends as it does.
void check_bunzip(std::span<const std::byte> choices);

// A grid file. What is refused is named and has one of the promised codes; of what opens every cell
// can be read; what verify() passes has true counts and extremes, and comes back from the writer;
// a file that is cut under the map is an error.
void check_grid_file(std::span<const std::byte> file);

}  // namespace stormcellar::fuzz
