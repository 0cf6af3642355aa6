#include "stormcellar/archive/archive_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <map>
#include <utility>

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "archive/archive_format.h"
#include "archive/packed_stream.h"
#include "archive/plain_source.h"
#include "base/memory.h"
#include "base/steady_time.h"

namespace stormcellar::archive {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 20;
constexpr std::size_t most_left_out = 100;  // at most this many members are listed
// Most bytes that libarchive may read for one header, give or take a block. A header with a long
// name takes a few kilobytes. The limit mainly bounds time, because libarchive compares each entry
// of an access list with all previous entries.
constexpr std::uint64_t most_header_bytes = std::uint64_t{128} << 10;
// Most bytes of the directory of a zip, which libarchive reads with the first header. Each member
// takes about 100 bytes.
constexpr std::uint64_t most_directory_bytes = std::uint64_t{16} << 20;

}  // namespace

struct ArchiveReader::Impl {
    Limits limits;
    ReadBudget header, of_source;          // for headers; for the codec of a packed archive
    std::unique_ptr<PlainSource> plain;    // the bytes of the archive
    std::unique_ptr<PackedStream> packed;  // null: the archive is not packed
    Handle handle;                         // must end before `plain` and `packed`
    // size of the archive; 0: unknown, so limits use the number of bytes read so far
    std::uint64_t source_bytes = 0;
    ::archive_entry* first = nullptr;  // the header that opening has already read
    std::size_t members = 0;
    std::uint64_t given_bytes = 0;
    std::map<std::string, int> names;  // how many members had each name
    std::vector<LeftOut> left_out;
    bool is_cut = false;
    bool at_end = false;
    bool never_begun = false;  // the first bytes of the archive cannot be read
    std::string why_ended;     // empty: the archive was read to its end, or the end is not reached
    // Returns the last 512 bytes of the archive. In a complete tar that is not compressed, they are
    // zeros.
    std::function<std::vector<std::byte>()> tail;
    int nesting = 0;  // nesting depth of this archive
    // An archive inside this archive, while its members are read.
    std::string inner_name;
    std::vector<std::byte> inner_bytes;
    std::unique_ptr<Impl> inner;
    std::uint64_t given_before_inner = 0;
    SteadyTime deadline = SteadyTime::max();

    void set_deadline(SteadyTime time) {
        deadline = time;
        header.set_deadline(time);
        of_source.set_deadline(time);
    }

    // Begins to read. Returns false if the bytes are no archive. libarchive may take zeros for an
    // empty archive, so packed zeros are refused.
    bool begin(std::span<const std::byte> start, PlainSource::ReadAt read_at) {
        handle = new_reader();
        if (!handle) return false;
        if (source_bytes > limits.archive_bytes) {
            end_with(fmt::format("has more than {} bytes: it is not read", limits.archive_bytes));
            return true;
        }
        const bool packs = is_packed(start);
        plain = std::make_unique<PlainSource>(std::move(read_at), source_bytes,
                                              packs ? of_source : header);
        if (packs) {
            packed = PackedStream::open(
                start, [this](::archive* of) { return plain->feed(of); }, of_source,
                limits.small_codecs, [this](std::uint64_t read) { return most_bytes(read); });
        }
        if (packs ? !packed || !packed->feed(handle.get(), header) : !plain->feed(handle.get()))
            return false;
        const bool may_be_zip = begins_with(start, "PK");
        const int code = read_header(first, may_be_zip ? most_directory_bytes : most_header_bytes);
        if (packed && packed->begins_with_zero()) return false;
        if (end_at_bound()) return true;
        return code >= ARCHIVE_WARN && code != ARCHIVE_EOF;
    }

    // Reads a header of at most `most` bytes. The caller must first skip the data of the previous
    // member, so that these data do not count.
    int read_header(::archive_entry*& entry, std::uint64_t most) {
        const std::uint64_t start = place_of(handle.get());
        header.begin(most);
        const int code = archive_read_next_header(handle.get(), &entry);
        header.end();
        // libarchive jumps in a zip, so its position cannot give the length of a header. Headers in
        // a zip are never long.
        if (!is_zip(handle.get())) header.add(std::max(start, place_of(handle.get())) - start);
        if (!header.is_spent()) return code;
        entry = nullptr;
        return ARCHIVE_FATAL;
    }

    void leave_out(const std::string& name, std::string reason) {
        if (left_out.size() == most_left_out) {
            left_out.push_back({{}, "more members are left out than are named here"});
        } else if (left_out.size() < most_left_out) {
            left_out.push_back({name.substr(0, most_name_bytes), std::move(reason)});
        }
    }
    // Ends reading, and records the reason even if left_out is full.
    void end_with(std::string reason) {
        left_out.push_back({{}, reason});
        why_ended = std::move(reason);
        at_end = true;
    }
    void cut_with(std::string reason) {
        is_cut = true;
        end_with(std::move(reason));
    }

    [[nodiscard]] bool is_unread() const { return never_begun || (plain && plain->has_failed()); }
    void end_unread() {
        never_begun = true;
        cut_with("cannot be read");
    }

    ::archive_entry* next_entry() {
        if (at_end) return nullptr;
        if (first != nullptr) return std::exchange(first, nullptr);
        ::archive_entry* entry = nullptr;
        const bool passed = archive_read_data_skip(handle.get()) >= ARCHIVE_WARN;
        const int code = passed ? read_header(entry, most_header_bytes) : ARCHIVE_FATAL;
        // Any other code, except ARCHIVE_EOF, means a damaged header. A search might find the next
        // header, but the reader stops instead.
        if (code == ARCHIVE_OK || code == ARCHIVE_WARN) return entry;
        at_end = true;
        const bool is_behind_all = code == ARCHIVE_EOF || (passed && has_no_room_left());
        if (is_behind_all && has_its_end()) return nullptr;
        if (code == ARCHIVE_EOF) {
            cut_with("the archive has no end");
            return nullptr;
        }
        if (end_at_bound()) return nullptr;
        cut_with(is_unread() ? "the archive cannot be read"
                             : "the archive is cut or damaged: " + error_text_of(handle.get()));
        return nullptr;
    }

    // Returns true if the rest of a tar is shorter than a header.
    [[nodiscard]] bool has_no_room_left() const {
        const std::uint64_t read = place_of(handle.get());
        return !packed && !is_zip(handle.get()) && !is_unread() &&
               source_bytes - std::min(source_bytes, read) < tar_block_bytes;
    }

    // Returns true, and records the reason, if reading ended because a packed archive unpacked to
    // too many bytes, a header was too long, or the time was over.
    bool end_at_bound() {
        if (header.is_spent() || of_source.is_spent()) {
            end_with(
                "has a header that is too long, too many long ones, or zeros in place of one: the "
                "rest is not read");
            return true;
        }
        if (header.is_late() || of_source.is_late()) {
            end_with("takes too long to read: the rest is not read");
            return true;
        }
        if (!packed || packed->met_bound() == 0) return false;
        end_with(fmt::format("unpacks to more than {} bytes: the rest is not read",
                             packed->met_bound()));
        return true;
    }

    // Implements ArchiveReader::may_have_its_end(). A zip ends with its directory, whose last
    // record has 22 bytes and maybe a comment.
    [[nodiscard]] bool may_have_its_end() const {
        if (never_begun || (at_end && !is_cut)) return true;
        return is_zip(handle.get()) ? !tail || has_directory() : has_its_end();
    }
    [[nodiscard]] bool has_directory() const {
        if (!tail) return false;
        const std::vector<std::byte> last = tail();
        const std::string_view text{reinterpret_cast<const char*>(last.data()), last.size()};
        return text.find("PK\x05\x06") != std::string_view::npos;
    }
    // Returns true if a member may have to be unpacked to find its end.
    [[nodiscard]] bool is_streamed_zip() const {
        return is_zip(handle.get()) && (packed || !has_directory());
    }

    // Returns false if a tar that is not compressed does not end with zeros. In all other cases
    // libarchive itself reports a missing end.
    [[nodiscard]] bool has_its_end() const {
        if (packed || !is_tar(handle.get()) || !tail) return true;
        const std::vector<std::byte> last = tail();
        return last.size() == tar_block_bytes &&
               std::ranges::all_of(last, [](std::byte b) { return b == std::byte{0}; });
    }

    // Returns how many bytes the archive may unpack to after this many of its bytes were read.
    [[nodiscard]] std::uint64_t most_bytes(std::uint64_t read) const {
        return std::min(limits.all_bytes,
                        limits.unbounded_bytes + limits.expansion * std::max(source_bytes, read));
    }
    [[nodiscard]] std::uint64_t most_bytes() const {
        return most_bytes(static_cast<std::uint64_t>(
            std::max<la_int64_t>(0, archive_filter_bytes(handle.get(), -1))));
    }

    // Reads up to `room` more bytes of the entry's data into `into`. Returns their number, or 0 at
    // the end. Returns none, and records the reason, if the data are cut, damaged or beyond a
    // limit.
    std::optional<std::size_t> read_on(const std::string& name, std::byte* into, std::size_t room) {
        const la_ssize_t got = archive_read_data(handle.get(), into, room);
        if (got < 0) {
            if (end_at_bound()) return std::nullopt;
            const std::string reason = is_unread()
                                           ? "cannot be read"
                                           : "is cut or damaged: " + error_text_of(handle.get());
            leave_out(name, reason);
            if (got == ARCHIVE_FATAL) {
                is_cut = at_end = true;
                why_ended = fmt::format("the archive cannot be read behind {}, which {}",
                                        name.substr(0, most_name_bytes), reason);
            }
            return std::nullopt;
        }
        given_bytes += static_cast<std::uint64_t>(got);
        if (given_bytes > most_bytes()) {
            end_with(
                fmt::format("unpacks to more than {} bytes: the rest is not read", most_bytes()));
            return std::nullopt;
        }
        return static_cast<std::size_t>(got);
    }

    // Returns the data of the entry. Returns none, and records the reason, if the data are cut,
    // damaged or beyond a limit.
    std::optional<std::vector<std::byte>> data_of(const std::string& name,
                                                  std::uint64_t size_hint) {
        std::vector<std::byte> bytes;
        bytes.reserve(static_cast<std::size_t>(std::min(size_hint, limits.member_bytes)) +
                      piece_bytes);
        for (;;) {
            const std::size_t at = bytes.size();
            bytes.resize(at + piece_bytes);
            const auto got = read_on(name, bytes.data() + at, piece_bytes);
            if (!got) return std::nullopt;
            bytes.resize(at + *got);
            if (bytes.size() > limits.member_bytes) {
                leave_out(name, fmt::format("has more than {} bytes", limits.member_bytes));
                (void)own_name(name);  // so that the next member of this name gets a number
                free_array(bytes);
                pass_over(name);
                return std::nullopt;
            }
            if (*got == 0) return bytes;
        }
    }

    // Skips to the end of a member of a zip. libarchive may have to unpack the member to find its
    // end, so read it here, where its bytes are counted.
    void pass_over(const std::string& name) {
        if (!is_zip(handle.get())) return;
        std::vector<std::byte> piece(piece_bytes);
        for (auto got = read_on(name, piece.data(), piece.size()); got && *got > 0;)
            got = read_on(name, piece.data(), piece.size());
    }

    // Returns a unique name for a member: `name`, with a number after it if another member has it.
    std::string own_name(const std::string& name) {
        int& count = names[name];
        if (++count == 1) return name;
        for (;; ++count) {
            std::string own = fmt::format("{}#{}", name, count);
            if (names.emplace(own, 1).second) return own;
        }
    }

    // Begins to read the member as an archive. Returns false if the member is not an archive, or is
    // nested too deep.
    bool begin_inner(const std::string& name, std::vector<std::byte>& bytes) {
        if (nesting >= limits.nesting) return false;
        auto reader = make(bytes, limits);
        if (!reader) return false;
        reader->nesting = nesting + 1;
        inner_name = own_name(name);
        inner_bytes = std::move(bytes);
        inner = std::move(reader);
        given_before_inner = given_bytes;
        return true;
    }

    std::optional<Member> next_inner() {
        inner->set_deadline(deadline);
        auto member = inner->next();
        if (member) {
            given_bytes += member->bytes.size();
            member->name = inner_name + member_mark + member->name;
            if (given_bytes > most_bytes()) {
                inner.reset();
                end_with("unpacks to too many bytes: the rest is not read");
                return std::nullopt;
            }
            return member;
        }
        for (LeftOut& one : inner->left_out) {
            if (one.name.empty() && one.reason == inner->why_ended) continue;
            leave_out(one.name.empty() ? inner_name : inner_name + member_mark + one.name,
                      std::move(one.reason));
        }
        if (!inner->why_ended.empty()) leave_out(inner_name, inner->why_ended);
        is_cut = is_cut || inner->is_cut;
        // Bytes that the inner archive unpacked and skipped count as well.
        const std::uint64_t unpacked = inner->packed ? inner->packed->unpacked() : 0;
        given_bytes =
            std::max(given_bytes, given_before_inner + std::max(unpacked, inner->given_bytes));
        inner.reset();
        free_array(inner_bytes);
        if (given_bytes > most_bytes()) end_with("unpacks to too many bytes: the rest is not read");
        return std::nullopt;
    }

    std::optional<Member> next() {
        for (;;) {
            if (inner) {
                if (auto member = next_inner()) return member;
                continue;
            }
            ::archive_entry* const entry = next_entry();
            if (entry == nullptr) return std::nullopt;
            if (++members > limits.members) {
                end_with(
                    fmt::format("has more than {} members: the rest is not read", limits.members));
                return std::nullopt;
            }
            const std::string name = name_of(entry);
            if (archive_entry_filetype(entry) == AE_IFDIR) continue;
            if (archive_entry_is_encrypted(entry) != 0) {
                leave_out(name, "is encrypted");
                continue;
            }
            if (limits.small_codecs && !is_small_codec(handle.get())) {
                leave_out(name, "is packed in a way that may take much memory");
                if (!is_streamed_zip()) continue;
                end_with("has a member that may take much memory: the rest is not read");
                return std::nullopt;
            }
            if (const auto refusal = refusal_of(entry, name); !refusal.empty()) {
                leave_out(name, std::string{refusal});
                pass_over(name);
                continue;
            }
            const std::optional<UtcTime> modified = time_of(entry);
            const std::uint64_t claimed = claimed_bytes_of(entry);
            const bool is_plain = !packed && !is_zip(handle.get());
            auto bytes = data_of(name, is_plain ? std::min(claimed, source_bytes) : 0);
            if (!bytes) continue;
            if (begin_inner(name, *bytes)) continue;
            return Member{own_name(name), modified, std::move(*bytes)};
        }
    }

    static std::unique_ptr<Impl> make(std::span<const std::byte> bytes, const Limits& limits) {
        const auto start = bytes.first(std::min(bytes.size(), tar_block_bytes));
        if (!may_be_archive(start)) return nullptr;
        auto impl = std::make_unique<Impl>();
        impl->limits = limits;
        impl->source_bytes = bytes.size();
        impl->tail = [bytes] {
            const auto last = bytes.last(std::min(bytes.size(), tar_block_bytes));
            return std::vector<std::byte>(last.begin(), last.end());
        };
        const bool begun = impl->begin(start, [bytes](std::uint64_t at, std::span<std::byte> into) {
            const auto rest = bytes.subspan(std::min<std::uint64_t>(bytes.size(), at));
            const auto piece = rest.first(std::min(rest.size(), into.size()));
            std::ranges::copy(piece, into.begin());
            return static_cast<std::int64_t>(piece.size());
        });
        return begun ? std::move(impl) : nullptr;
    }
};

ArchiveReader::ArchiveReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ArchiveReader::ArchiveReader(ArchiveReader&&) noexcept = default;
ArchiveReader& ArchiveReader::operator=(ArchiveReader&&) noexcept = default;
ArchiveReader::~ArchiveReader() = default;

std::optional<ArchiveReader> ArchiveReader::open(std::span<const std::byte> bytes, Limits limits) {
    auto impl = Impl::make(bytes, limits);
    if (!impl) return std::nullopt;
    return ArchiveReader(std::move(impl));
}

std::optional<ArchiveReader> ArchiveReader::open(int descriptor, Limits limits) {
    std::array<std::byte, tar_block_bytes> start{};
    auto impl = std::make_unique<Impl>();
    impl->limits = limits;
    const ssize_t got = ::pread(descriptor, start.data(), start.size(), 0);
    const bool has_no_places = got < 0 && (errno == EISDIR || errno == ESPIPE || errno == EINVAL);
    if (got < 0 && !has_no_places) {
        impl->end_unread();
        return ArchiveReader(std::move(impl));
    }
    const auto head = std::span{start}.first(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
    if (!may_be_archive(head)) return std::nullopt;
    struct stat whole {};
    if (::fstat(descriptor, &whole) == 0) {
        impl->source_bytes = static_cast<std::uint64_t>(std::max<off_t>(0, whole.st_size));
    }
    impl->tail = [descriptor] {
        std::vector<std::byte> last(tar_block_bytes);
        struct stat facts {};
        const bool known = ::fstat(descriptor, &facts) == 0;
        const off_t at = facts.st_size - static_cast<off_t>(tar_block_bytes);
        const ssize_t count =
            known && at >= 0 ? ::pread(descriptor, last.data(), last.size(), at) : 0;
        last.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        return last;
    };
    const bool begun = impl->begin(head, [descriptor](std::uint64_t at, std::span<std::byte> into) {
        return ::pread(descriptor, into.data(), into.size(), static_cast<off_t>(at));
    });
    if (!begun && !impl->is_unread()) return std::nullopt;
    if (!begun) impl->end_unread();
    return ArchiveReader(std::move(impl));
}

std::optional<Member> ArchiveReader::next() {
    impl_->set_deadline(steady_now() + impl_->limits.time);
    return impl_->next();
}

const std::vector<LeftOut>& ArchiveReader::left_out() const {
    return impl_->left_out;
}

bool ArchiveReader::may_have_its_end() const {
    return impl_->may_have_its_end();
}

bool ArchiveReader::is_cut() const {
    return impl_->is_cut;
}

const std::string& ArchiveReader::why_ended() const {
    return impl_->why_ended;
}

std::string ArchiveReader::why_missing(const std::string& name) const {
    const auto own = std::ranges::find(impl_->left_out, name, &LeftOut::name);
    if (!name.empty() && own != impl_->left_out.end()) return own->reason;
    return impl_->why_ended.empty() ? "is not in the archive" : impl_->why_ended;
}

bool ArchiveReader::is_unreadable() const {
    return impl_->is_unread();
}

}  // namespace stormcellar::archive
