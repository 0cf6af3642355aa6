// archive/archive_format.h -- recognizes archives, and reads the facts that libarchive gives about
// their entries.
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
// Returns true if `start`, the first 512 bytes of a file, may begin an archive. Returns true for
// packed bytes, because only unpacking can decide.
[[nodiscard]] bool may_be_archive(std::span<const std::byte> start);

// Returns a reader of tar and zip, or null if libarchive lacks one of these formats. The reader has
// no filters, because a PackedStream unpacks the data.
[[nodiscard]] Handle new_reader();
[[nodiscard]] bool is_zip(::archive* handle);
[[nodiscard]] bool is_tar(::archive* handle);
// Returns true if the present member of a zip is stored or deflated, which takes little memory;
// always true for tar. The header of the member must have been read.
[[nodiscard]] bool is_small_codec(::archive* handle);
// Returns how many bytes of the tar or zip were read, counted after unpacking.
[[nodiscard]] std::uint64_t place_of(::archive* handle);

[[nodiscard]] std::string name_of(::archive_entry* entry);
// Returns the reason why the entry must be left out, or an empty text if the entry is a file to
// return.
[[nodiscard]] std::string_view refusal_of(::archive_entry* entry, const std::string& name);
[[nodiscard]] std::optional<UtcTime> time_of(::archive_entry* entry);
// Returns the size that the header gives, or 0 if it gives none. The size is only a hint.
[[nodiscard]] std::uint64_t claimed_bytes_of(::archive_entry* entry);

}  // namespace stormcellar::archive
