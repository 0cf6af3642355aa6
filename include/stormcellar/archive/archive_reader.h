// stormcellar/archive/archive_reader.h -- reads the members of tar and zip archives, one after the
// other.
//
// NCEI delivers orders as tar files, and people send their files as zip. Members are read into
// memory and never unpacked under their own names. Links, devices, directories, encrypted members
// and members whose names lead out of the archive are left out. The members of an archive inside an
// archive are read too, one level deep.
//
// The input is hostile, so `Limits` bounds everything that it can claim. At a bound the reader
// stops and reports it. Data that are unpacked only to be skipped count as well, and so do the
// bytes that one header makes libarchive read (128 KiB, and 4 MiB of long headers together; 16 MiB
// for the directory of a zip). Sparse files are left out. From a damaged archive the reader returns
// the whole members, and those after blocks of zeros, where tars may have been joined. Formats,
// recognized by content with libarchive: tar (also compressed by gzip, bzip2, xz, zstd or compress)
// and zip.
//
// Units     All sizes are in bytes.
// Threads   Each reader may be used by one thread at a time.
// Errors    ArchiveReader returns none; left_out() lists what it cannot return.
//           SourceReader::read() returns those of read_file(), and not_found.
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
    std::size_t members = 100'000;                           // members of any kind
    // of one member: twice the size of any known volume
    std::uint64_t member_bytes = std::uint64_t{256} << 20;
    std::uint64_t all_bytes = std::uint64_t{256} << 30;  // of all members together
    std::uint64_t expansion = 200;  // unpacked bytes for each byte of the archive
    // an archive may unpack to this many bytes, whatever its expansion
    std::uint64_t unbounded_bytes = std::uint64_t{256} << 20;
    // of one call of next(), which may skip much; after that the rest of the archive is not read
    std::chrono::seconds time{std::chrono::hours{24}};
    int nesting = 1;  // how deep archives inside archives are read
    // Allows only codecs that need a few megabytes of memory whatever the input says: gzip, bzip2
    // and compress for tar; deflated or stored members for zip. It excludes xz and zstd.
    bool small_codecs = false;
};

struct Member {
    // as in the archive; "INNER!NAME" for a member of an archive inside the archive
    std::string name;
    std::optional<UtcTime> modified;
    std::vector<std::byte> bytes;
};

// Something in the archive that the reader does not return, with a readable reason.
struct LeftOut {
    std::string name;  // the member's name; empty: the archive itself
    std::string reason;
};

class ArchiveReader {
  public:
    // Opens an archive and reads the descriptor from the start of the file. The descriptor must
    // stay open as long as the reader. Returns none if the file is not an archive. If its start
    // cannot be read, which may be temporary, returns a reader whose is_unreadable() is true.
    [[nodiscard]] static std::optional<ArchiveReader> open(int descriptor, Limits limits = {});
    // Does the same for an archive in memory. The bytes must outlive the reader.
    [[nodiscard]] static std::optional<ArchiveReader> open(std::span<const std::byte> bytes,
                                                           Limits limits = {});
    ArchiveReader(ArchiveReader&&) noexcept;
    ArchiveReader& operator=(ArchiveReader&&) noexcept;
    ~ArchiveReader();

    // Returns the next member that is a file, or none at the end of the archive.
    [[nodiscard]] std::optional<Member> next();
    // Returns the members and parts that have been left out so far.
    [[nodiscard]] const std::vector<LeftOut>& left_out() const;
    // Returns true if the archive ends too early or is damaged, so that members may be missing. The
    // file may still be growing.
    [[nodiscard]] bool is_cut() const;
    // Returns the reason why the members after the last one were not read. Empty: the archive was
    // read to its end, or its end is not reached yet.
    [[nodiscard]] const std::string& why_ended() const;
    // Returns the reason why next() did not return the member of that name.
    [[nodiscard]] std::string why_missing(const std::string& name) const;
    // Returns true if the archive was not read to its end because of a system error, which may be
    // temporary. is_cut() is true then.
    [[nodiscard]] bool is_unreadable() const;
    // Returns true if the last bytes are the end of an uncompressed tar or of a zip. For a
    // compressed archive the end cannot be known before it is read, so the result is true.
    [[nodiscard]] bool may_have_its_end() const;

  private:
    struct Impl;
    explicit ArchiveReader(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// Splits a path such as DIR/a.tar!NAME into the archive and the member, if DIR/a.tar is a file and
// the whole path is not. Returns none for any other path.
[[nodiscard]] std::optional<MemberName> member_path_of(const std::filesystem::path& path);
// Returns the member of that name. The descriptor is used as in open(). Errors: corrupt, with the
// reason, if there is no such member; io if the archive cannot be read.
[[nodiscard]] Result<Member> find_member(int descriptor, const std::string& name,
                                         Limits limits = {});

// Reads files, and members of archives named as "ARCHIVE!MEMBER". Reading members in the order of
// the archive is fastest.
class SourceReader {
  public:
    // Returns the bytes of the file or member. Errors: those of read_file(); not_found if the
    // archive has no such member.
    [[nodiscard]] Result<std::vector<std::byte>> read(const std::filesystem::path& path);

  private:
    std::filesystem::path archive_;
    Descriptor file_;
    std::optional<ArchiveReader> reader_;
};

}  // namespace stormcellar::archive
