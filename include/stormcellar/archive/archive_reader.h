// stormcellar/archive/archive_reader.h -- the members of tar and zip archives, one after the other.
//
// NCEI's orders come as tar files, and people send what they have as zip. Members are streamed into
// memory, never unpacked under their own names. Links, devices, directories and encrypted members
// are no files and left out, as are names that lead out of the archive. An archive in an archive is
// gone through too, once. What the input can claim is bounded (Limits): at a bound the reader stops
// and says so; what is unpacked to be passed over counts, too. Of a damaged archive it gives what
// is whole. Formats: tar (also compressed: gzip, bzip2, xz, zstd, compress) and zip, by content,
// with libarchive. Thread contract: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::archive {

struct Limits {
    std::size_t members = 100'000;                             // of any kind
    std::uint64_t member_bytes = std::uint64_t{256} << 20;     // of one: twice any known volume
    std::uint64_t all_bytes = std::uint64_t{256} << 30;        // of all together
    std::uint64_t expansion = 200;                             // times the archive's own bytes
    std::uint64_t unbounded_bytes = std::uint64_t{256} << 20;  // that no expansion counts for
    int nesting = 1;  // archives in archives that are gone through
    // Only codecs that take a few megabytes of memory whatever the input says: of tar gzip, bzip2
    // and compress, of zip what is deflated or stored. Not xz and zstd.
    bool small_codecs = false;
};

struct Member {
    std::string name;  // as the archive has it; "INNER!NAME" where an archive lies in the archive
    std::optional<UtcTime> modified;
    std::vector<std::byte> bytes;
};

// Something of the archive that is not given, and why, for a person.
struct LeftOut {
    std::string name;  // of the member; empty: the archive
    std::string reason;
};

class ArchiveReader {
  public:
    // None where the file is no archive. The descriptor must stay open; it is read from its start.
    [[nodiscard]] static std::optional<ArchiveReader> open(int descriptor, Limits limits = {});
    // The bytes must outlive the reader.
    [[nodiscard]] static std::optional<ArchiveReader> open(std::span<const std::byte> bytes,
                                                           Limits limits = {});
    ArchiveReader(ArchiveReader&&) noexcept;
    ArchiveReader& operator=(ArchiveReader&&) noexcept;
    ~ArchiveReader();

    // The next member that is a file; none at the end.
    [[nodiscard]] std::optional<Member> next();
    // Up to here.
    [[nodiscard]] const std::vector<LeftOut>& left_out() const;
    // The archive ends too early or is damaged, so members may be missing; it may still be growing.
    [[nodiscard]] bool is_cut() const;
    // Whether the end of a tar that is not packed, or of a zip, is there, by its last bytes. Of a
    // packed one nobody knows before it was read: true.
    [[nodiscard]] bool may_have_its_end() const;

  private:
    struct Impl;
    explicit ArchiveReader(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// The archive and the member that a path names: DIR/a.tar is a file and the path itself is none.
[[nodiscard]] std::optional<MemberName> member_path_of(const std::filesystem::path& path);
// The member of that name; none where the archive has none. The descriptor as in open().
[[nodiscard]] std::optional<Member> find_member(int descriptor, const std::string& name,
                                                Limits limits = {});

// Reads files, and members of archives that are named as "ARCHIVE!MEMBER"; members are fastest in
// their order. Thread contract: one thread at a time.
class SourceReader {
  public:
    // Errors: those of read_file(); not_found where the archive has no such member.
    [[nodiscard]] Result<std::vector<std::byte>> read(const std::filesystem::path& path);

  private:
    std::filesystem::path archive_;
    Descriptor file_;
    std::optional<ArchiveReader> reader_;
};

}  // namespace stormcellar::archive
