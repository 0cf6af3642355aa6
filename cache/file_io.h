// cache/file_io.h -- reads a file that may change while it is read. Used only inside the cache
// room.
//
// Messages do not name the file, because the caller adds its path with with_path().
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

#include <sys/stat.h>

#include "cache/map_registry.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cache {

// A read-only map of a whole file, registered with the guard of cache/map_guard.h. A map must start
// at a multiple of the machine's page size, which may be larger than the page size of the format,
// so the map starts at the beginning of the file.
class Map {
  public:
    static Result<Map> of(const Descriptor& file, std::uint64_t size);
    Map(Map&& other) noexcept
        : start_(std::exchange(other.start_, nullptr)),
          size_(std::exchange(other.size_, 0)),
          registration_(std::move(other.registration_)) {}
    Map& operator=(Map&&) = delete;
    Map(const Map&) = delete;
    Map& operator=(const Map&) = delete;
    ~Map();
    [[nodiscard]] std::span<const std::byte> bytes() const { return {start_, size_}; }
    // Returns true if the guard has replaced the contents of the map by zeros.
    [[nodiscard]] bool was_cut() const { return registration_.was_cut(); }

  private:
    Map(const std::byte* start, std::size_t size)
        : start_(start), size_(size), registration_(start, size) {}
    const std::byte* start_;
    std::size_t size_;
    MapRegistration registration_;
};

// Opens a file for reading. Never blocks on a FIFO.
[[nodiscard]] Result<Descriptor> open_for_reading(const std::filesystem::path& path);

// Returns the facts of a regular file. Errors: not_a_file for anything else.
[[nodiscard]] Result<struct stat> facts_of(const Descriptor& file);

// Fills all of `bytes` from the file. Errors: truncated if the file ends too early.
[[nodiscard]] Status read_at(const Descriptor& file, std::uint64_t offset,
                             std::span<std::byte> bytes);

// Compares sizes. Errors: truncated if fewer bytes were found than expected, corrupt if more.
[[nodiscard]] Status check_size(std::uint64_t found, std::uint64_t expected);

[[nodiscard]] tl::unexpected<Error> with_path(const std::filesystem::path& path,
                                              const Error& error);

}  // namespace stormcellar::cache
