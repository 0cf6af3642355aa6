// stormcellar/archive/archive_reader.h -- reads the members of tar and zip archives in order.
//
// NCEI delivers orders as tar files, and people send their files as zip. Members are read into
// memory and never written to disk under their own names. The reader skips directories. It leaves
// out links, devices, sparse files, encrypted members, and members whose name is an absolute path
// or contains `..`. It also reads the members of archives inside the archive, by default one level
// deep.
//
// The input is hostile, so `Limits` bounds all counts and sizes. When the input exceeds a bound,
// the reader stops and reports the bound. Bytes that are unpacked only to skip a member count too.
// Fixed bounds limit headers: a header has at most 128 KiB, and the directory of a zip 16 MiB. The
// bytes by which headers exceed 8 KiB may add up to 4 MiB. From a damaged archive the reader
// returns the whole members that libarchive finds. Joined tars are read to the end, although blocks
// of zeros divide them. libarchive recognizes the formats by content: tar (also compressed by gzip,
// bzip2, xz, zstd or compress) and zip.
//
// Units     All sizes are in bytes.
// Threads   Each reader may be used by one thread at a time.
// Errors    ArchiveReader returns no errors; left_out() lists what it cannot return. find_member()
//           and SourceReader::read() state their errors.
#pragma once

#include <chrono>
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
    std::uint64_t archive_bytes = std::uint64_t{256} << 30;  // of the archive itself
    std::size_t members = 100'000;  // of any kind, including members that are left out
    // of one member; twice the size of any known volume
    std::uint64_t member_bytes = std::uint64_t{256} << 20;
    std::uint64_t all_bytes = std::uint64_t{256} << 30;  // of all members together
    std::uint64_t expansion = 200;  // unpacked bytes for each byte of the archive
    // unpacked bytes that are allowed in addition, so that small archives may expand more
    std::uint64_t unbounded_bytes = std::uint64_t{256} << 20;
    // for one call of next(), which may skip many bytes; after this time the reader stops
    std::chrono::seconds time{std::chrono::hours{24}};
    int nesting = 1;  // levels of archives inside archives that are read
    // Allows only codecs that need a few megabytes of memory whatever the input says: gzip, bzip2
    // and compress for tar; deflated or stored members for zip. So xz and zstd are excluded.
    bool small_codecs = false;
};

struct Member {
    // as in the archive, with "#2" and so on after a repeated name; "INNER!NAME" for a member of an
    // archive inside the archive
    std::string name;
    std::optional<UtcTime> modified;
    std::vector<std::byte> bytes;
};

// A member, or the rest of the archive, that the reader does not return, and the reason.
struct LeftOut {
    std::string name;  // the member's name; empty: the archive itself
    std::string reason;
};

class ArchiveReader {
  public:
    // Opens the archive in the file of a descriptor, which must stay open as long as the reader.
    // Reads from the start of the file, whatever the position of the descriptor. Returns none if
    // the file is not an archive, or is packed by a codec that `limits` excludes. If the start of
    // the file cannot be read, which may be temporary, returns a reader whose is_unreadable() is
    // true.
    [[nodiscard]] static std::optional<ArchiveReader> open(int descriptor, Limits limits = {});
    // Opens an archive in memory. Returns none if the bytes are not an archive. The bytes must
    // outlive the reader.
    [[nodiscard]] static std::optional<ArchiveReader> open(std::span<const std::byte> bytes,
                                                           Limits limits = {});
    ArchiveReader(ArchiveReader&&) noexcept;
    ArchiveReader& operator=(ArchiveReader&&) noexcept;
    ~ArchiveReader();

    // Returns the next member that is a file. Returns none at the end of the archive, or if the
    // reader has stopped (why_ended()).
    [[nodiscard]] std::optional<Member> next();
    // Returns the members and parts left out so far. After 100 entries, further members are not
    // listed.
    [[nodiscard]] const std::vector<LeftOut>& left_out() const;
    // Returns true if the archive ends too early, is damaged or cannot be read, so that members may
    // be missing. A file that is still growing ends too early.
    [[nodiscard]] bool is_cut() const;
    // Returns the reason why reading ended before the end of the archive. Returns an empty text if
    // the archive was read to its end, or if reading has not ended.
    [[nodiscard]] const std::string& why_ended() const;
    // Returns the reason why next() has not returned a member of this name. Call it when next() has
    // returned none.
    [[nodiscard]] std::string why_missing(const std::string& name) const;
    // Returns true if a system error, which may be temporary, kept the reader from reading the
    // file.
    [[nodiscard]] bool is_unreadable() const;
    // Returns false if the last bytes are not the end of an uncompressed tar or of a zip. The end
    // of a compressed archive is unknown before it is read, so the result is true.
    [[nodiscard]] bool may_have_its_end() const;

  private:
    struct Impl;
    explicit ArchiveReader(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// Splits a path such as DIR/a.tar!NAME into the archive and the member, if DIR/a.tar is a file and
// nothing exists at the whole path. Returns none for any other path.
[[nodiscard]] std::optional<MemberName> member_path_of(const std::filesystem::path& path);
// Returns the member of this name. The descriptor is used as in ArchiveReader::open(). Errors:
// corrupt, with the reason, if the reader returns no such member; io if the archive cannot be read.
[[nodiscard]] Result<Member> find_member(int descriptor, const std::string& name,
                                         Limits limits = {});

// Reads files, and members of archives by paths such as "ARCHIVE!MEMBER". It is fastest to read
// members in the order of the archive.
class SourceReader {
  public:
    // Returns the bytes of the file or member. Errors: those of read_file(); not_found, with the
    // reason, if the reader returns no such member.
    [[nodiscard]] Result<std::vector<std::byte>> read(const std::filesystem::path& path);

  private:
    std::filesystem::path archive_;
    Descriptor file_;
    std::optional<ArchiveReader> reader_;
};

}  // namespace stormcellar::archive
