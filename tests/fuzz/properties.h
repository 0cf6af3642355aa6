// tests/fuzz/properties.h -- checks the properties that must hold for any bytes.
//
// Each function throws a PropertyError, which names the property, if a property does not hold. The
// sanitizers find crashes, reads beyond the end and undefined behavior; the fuzzer finds hangs and
// excessive memory.
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

// DecodeOptions::output_limit_bytes of these checks
inline constexpr std::uint64_t output_limit_bytes = std::uint64_t{64} << 20;

// Checks a whole file in any container. One thread and two threads give the same volume, report or
// error. The volume is well formed and can be described and split. If it can be written, it is read
// back unchanged.
void check_container(std::span<const std::byte> file);

// Checks a message stream without the 24-byte header. The stream gives the same result packed into
// an LDM record as unpacked. Good radials before the stream are kept unchanged.
void check_messages(std::span<const std::byte> stream);

// Checks a file that arrives piece by piece. The first eight bytes of the input decide how the file
// arrives; the file follows them. The growing file gives the same result as the whole file. Its
// chunks, some of them lost, repeated or damaged, give the same result in any order.
void check_live(std::span<const std::byte> input);

// Checks that a .Z file expands to the same bytes as with slow_expand(). Compressed once more, the
// file must expand to itself.
void check_compress(std::span<const std::byte> file);

// Checks a tar or zip archive. Reading ends, and the output is within the limits. Names are unique
// and do not lead out of the archive.
void check_archive(std::span<const std::byte> file);

// Checks the bzip2 stream that `choices` determines (stream_from() in tests/bunzip/stream_maker.h).
// Each path of this machine gives the same bytes as libbz2 and the same kind of end.
void check_bunzip(std::span<const std::byte> choices);

// Checks a grid file. An error names the file and has one of the promised codes. If the file opens,
// every cell can be read. If verify() accepts it, its counts and extremes are true, and the file
// that is written from its grid gives the same grid. If the file is cut while it is mapped,
// check_whole() fails.
void check_grid_file(std::span<const std::byte> file);

// Checks an HTTP request: a line with method and target, and lines with one header each. The
// request is refused with a reason, or its path and query are clean and do not lead out of the
// site. The answer with a file has exactly the bytes that its headers name.
void check_request(std::span<const std::byte> input);

// Checks calls of the C interface, whose order and arguments the bytes decide. Each call returns
// the code of its error, makes an object if and only if it succeeds, and writes only into the
// caller's room. Arrays have the promised size.
void check_calls(std::span<const std::byte> script);

// Checks a file of shapes, as GeoJSON and as a placefile. An error has one of the promised codes.
// Every point is on the earth; widths, labels and the number of points are within their limits.
void check_shapes(std::span<const std::byte> file);

}  // namespace stormcellar::fuzz
