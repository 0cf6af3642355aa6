// tests/fuzz/properties.h -- the properties that hold for any bytes.
//
// Each function throws a PropertyError that names the property that does not hold. The sanitizers
// find crashes, reads beyond the end and undefined behavior; the fuzzer finds hangs and excessive
// memory.
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

// the limit of decoded bytes
inline constexpr std::uint64_t output_limit_bytes = std::uint64_t{64} << 20;

// A whole file in any container. One thread and two give the same volume, report or error. The
// volume is well formed and can be described and split; if it can be written, it is read back
// unchanged.
void check_container(std::span<const std::byte> file);

// A message stream without the 24-byte header. Packed into an LDM record it gives the same as
// unpacked; good radials before it are kept unchanged.
void check_messages(std::span<const std::byte> stream);

// A file, after eight bytes that decide the order. As it grows it gives what it gives whole. Cut
// into chunks, some of them lost, repeated or damaged, it gives the same in any order.
void check_live(std::span<const std::byte> input);

// A .Z file expands as slow_expand() expands it. The same bytes as plain text survive compression.
void check_compress(std::span<const std::byte> file);

// A tar or zip archive: the output is within its limits, names are unique and lead nowhere else,
// and reading ends.
void check_archive(std::span<const std::byte> file);

// Bytes that determine a bzip2 stream (tests/bunzip/stream_maker.h): valid, odd or damaged. Each
// path of this machine gives the bytes of libbz2 and the same kind of end.
void check_bunzip(std::span<const std::byte> choices);

// A grid file. A refusal names the file and has one of the promised codes. If it opens, every cell
// can be read. If verify() accepts it, its counts and extremes are true, and writing it gives the
// same grid. A file that is cut under the map is an error.
void check_grid_file(std::span<const std::byte> file);

// A request of HTTP: its method and target, and a header in each further line. It is refused with a
// reason, or its path and query are clean and lead nowhere else, and a file that it asks for
// answers with exactly the bytes that the answer says.
void check_request(std::span<const std::byte> input);

}  // namespace stormcellar::fuzz
