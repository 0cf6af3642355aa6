// archive/archive_format.h -- what libarchive and the first bytes say of an archive and its
// entries.
//
// Only the archive room uses this.
//
// Threads   One thread at a time for each handle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "archive/packed_stream.h"
#include "stormcellar/base/utc_time.h"

struct archive_entry;

namespace stormcellar::archive {

inline constexpr std::size_t tar_block_bytes = 512;
inline constexpr std::size_t most_name_bytes = 1024;

[[nodiscard]] bool begins_with(std::span<const std::byte> bytes, std::string_view text);
// Returns true if the first 512 bytes may begin an archive. A packed archive must be unpacked to
// decide.
[[nodiscard]] bool may_be_archive(std::span<const std::byte> start);

// Returns a reader of tar and zip; null if libarchive lacks one of them. There are no filters,
// because packed data come through a PackedStream.
[[nodiscard]] Handle new_reader();
[[nodiscard]] bool is_zip(::archive* handle);
[[nodiscard]] bool is_tar(::archive* handle);
// Returns true if the codec of a zip's member needs little memory, by the library's name for it.
// The member's header must have been read.
[[nodiscard]] bool is_small_codec(::archive* handle);
// Returns how many bytes of the tar or zip itself were read, after unpacking.
[[nodiscard]] std::uint64_t place_of(::archive* handle);

[[nodiscard]] std::string name_of(::archive_entry* entry);
// Returns the reason why an entry is not returned as a file; empty if it is returned.
[[nodiscard]] std::string_view refusal_of(::archive_entry* entry, const std::string& name);
[[nodiscard]] std::optional<UtcTime> time_of(::archive_entry* entry);
// Returns the size in the header, which is only a hint; 0: unknown.
[[nodiscard]] std::uint64_t claimed_bytes_of(::archive_entry* entry);

}  // namespace stormcellar::archive
