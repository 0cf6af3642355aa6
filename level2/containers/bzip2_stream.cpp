#include "level2/containers/bzip2_stream.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace stormcellar::level2 {
namespace {

// The marks are decimal digits of pi and of its square root.
constexpr std::uint64_t block_mark = 0x314159265359;
constexpr std::uint64_t end_mark = 0x177245385090;
constexpr std::uint64_t mark_mask = 0xFFFFFFFFFFFF;
constexpr int mark_bits = 48;
constexpr std::uint64_t least_block_bits = 150;  // mark, checksum, pointer, symbols, two tables

std::uint64_t big_endian(std::span<const std::byte> bytes) {
    std::uint64_t number = 0;
    for (const std::byte b : bytes)
        number = (number << 8) | std::to_integer<std::uint64_t>(b);
    return number;
}

// Appends numbers of any width to `out`, without gaps between them.
class BitWriter {
  public:
    explicit BitWriter(std::vector<std::byte>& out) : out_(out) {}
    void put(std::uint64_t number, int bits) {
        for (int bit = bits - 1; bit >= 0; --bit) {
            held_ = (held_ << 1) | static_cast<unsigned>((number >> bit) & 1U);
            if (++held_bits_ == 8) flush_byte();
        }
    }
    void finish() {
        while (held_bits_ != 0)
            put(0, 1);
    }

  private:
    void flush_byte() {
        out_.push_back(static_cast<std::byte>(held_ & 0xFFU));
        held_ = 0;
        held_bits_ = 0;
    }
    std::vector<std::byte>& out_;
    unsigned held_ = 0;
    int held_bits_ = 0;
};

// Returns the eight bytes from `at` on, with zeros beyond the end.
std::uint64_t eight_bytes(std::span<const std::byte> bytes, std::size_t at) {
    std::array<std::byte, 8> raw{};
    if (at < bytes.size()) {
        const auto part = bytes.subspan(at, std::min<std::size_t>(8, bytes.size() - at));
        std::copy(part.begin(), part.end(), raw.begin());
    }
    return big_endian(raw);
}

// Copies the bits from `begin` to `end`: whole bytes to `out`, and the remaining bits to `writer`.
void copy_bits(std::span<const std::byte> bytes, std::uint64_t begin, std::uint64_t end,
               std::vector<std::byte>& out, BitWriter& writer) {
    const auto shift = static_cast<unsigned>(begin % 8);
    std::uint64_t bit = begin;
    for (; bit + 8 <= end; bit += 8) {
        const auto at = static_cast<std::size_t>(bit / 8);
        unsigned pair = std::to_integer<unsigned>(bytes[at]) << 8;
        if (at + 1 < bytes.size()) pair |= std::to_integer<unsigned>(bytes[at + 1]);
        out.push_back(static_cast<std::byte>((pair >> (8 - shift)) & 0xFFU));
    }
    for (; bit < end; ++bit) {
        const unsigned byte = std::to_integer<unsigned>(bytes[static_cast<std::size_t>(bit / 8)]);
        writer.put((byte >> (7 - bit % 8)) & 1U, 1);
    }
}

}  // namespace

bool is_bzip2(std::span<const std::byte> bytes) {
    if (bytes.size() < bzip2_mark_bytes) return false;
    if (std::memcmp(bytes.data(), "BZh", 3) != 0) return false;
    const char level = static_cast<char>(bytes[3]);
    if (level < '1' || level > '9') return false;
    const std::uint64_t mark = big_endian(bytes.subspan(4, 6));
    return mark == block_mark || mark == end_mark;
}

std::optional<std::size_t> find_bzip2(std::span<const std::byte> bytes, std::size_t from) {
    std::size_t at = from;
    while (at + bzip2_mark_bytes <= bytes.size()) {
        const void* found = std::memchr(bytes.data() + at, 'B', bytes.size() - at);
        if (found == nullptr) return std::nullopt;
        at = static_cast<std::size_t>(static_cast<const std::byte*>(found) - bytes.data());
        if (is_bzip2(bytes.subspan(at))) return at;
        ++at;
    }
    return std::nullopt;
}

bool ends_as_bzip2(std::span<const std::byte> bytes) {
    constexpr std::size_t tail_bytes = 11;  // 48 bits of mark, 32 of checksum, up to 7 of padding
    if (bytes.size() < tail_bytes + 4) return false;
    // The window holds the mark and the first 8 bits of the checksum, whatever the padding.
    const std::uint64_t window = big_endian(bytes.last(tail_bytes).first(8));
    for (int padding = 0; padding < 8; ++padding) {
        if (((window >> (8 + padding)) & mark_mask) == end_mark) return true;
    }
    return false;
}

BzipBlocks::BzipBlocks(std::span<const std::byte> bytes, bunzip::Workspace& workspace)
    : bytes_(bytes), workspace_(workspace), mark_(find_mark(0)) {}

std::optional<BzipBlocks::Mark> BzipBlocks::find_mark(std::uint64_t from_bit) const {
    const std::uint64_t all_bits = std::uint64_t{bytes_.size()} * 8;
    std::uint64_t window = eight_bytes(bytes_, static_cast<std::size_t>(from_bit / 8));
    auto at = static_cast<std::size_t>(from_bit / 8);
    for (; at + 6 <= bytes_.size(); ++at) {
        // The window holds the bytes at .. at + 7, which include the mark at all eight bit offsets
        // in the byte at `at`.
        for (int shift = 0; shift < 8; ++shift) {
            const std::uint64_t here = (window >> (64 - mark_bits - shift)) & mark_mask;
            if (here != block_mark && here != end_mark) continue;
            const std::uint64_t bit = std::uint64_t{at} * 8 + static_cast<unsigned>(shift);
            if (bit < from_bit || bit + mark_bits > all_bits) continue;
            return Mark{bit, here == end_mark};
        }
        window <<= 8;
        if (at + 8 < bytes_.size()) window |= std::to_integer<std::uint64_t>(bytes_[at + 8]);
    }
    return std::nullopt;
}

bunzip::Status BzipBlocks::unpack(std::uint64_t begin_bit, std::uint64_t end_bit,
                                  std::size_t limit) {
    // The checksum of the block follows its mark. A stream of one block has the same checksum.
    const std::uint64_t checksum_bit = begin_bit + mark_bits;
    if (end_bit < begin_bit + least_block_bits) return bunzip::Status::truncated;
    const std::uint64_t window = eight_bytes(bytes_, static_cast<std::size_t>(checksum_bit / 8));
    const std::uint64_t checksum = (window >> (32 - checksum_bit % 8)) & 0xFFFFFFFFU;
    stream_.clear();
    stream_.reserve(static_cast<std::size_t>((end_bit - begin_bit) / 8) + 32);
    for (const char c : {'B', 'Z', 'h', '9'})
        stream_.push_back(static_cast<std::byte>(c));
    BitWriter writer{stream_};
    copy_bits(bytes_, begin_bit, end_bit, stream_, writer);
    writer.put(end_mark, mark_bits);
    writer.put(checksum, 32);
    writer.finish();
    const auto result = bunzip::decompress(stream_, output_, limit, workspace_);
    output_bytes_ = result.output_bytes;
    return result.status;
}

std::optional<BzipBlocks::Block> BzipBlocks::next(std::size_t limit) {
    // The bits of a mark can occur inside a block by chance. In that case the block ends at a later
    // mark, so try the next marks too.
    constexpr int most_joined = 3;
    const std::uint64_t all_bits = std::uint64_t{bytes_.size()} * 8;
    while (mark_ && mark_->end_of_stream) {
        ended_ = true;
        mark_ = find_mark(mark_->bit + 1);
    }
    if (!mark_ || bad_blocks_ == max_bad_blocks) return std::nullopt;
    ended_ = false;
    const std::uint64_t begin = mark_->bit;
    const std::optional<Mark> nearest = find_mark(begin + 1);
    std::optional<Mark> end = nearest;
    std::uint64_t wasted_bytes = 0;
    for (int joined = 0; joined < most_joined; ++joined) {
        const std::uint64_t end_bit = end ? end->bit : all_bits;
        const auto position = static_cast<std::size_t>(begin / 8);
        const auto compressed = static_cast<std::size_t>((end_bit - begin) / 8);
        const bunzip::Status status = unpack(begin, end_bit, limit);
        if (status == bunzip::Status::too_large) return Block{status, {}, position, compressed, 0};
        if (status == bunzip::Status::whole) {
            mark_ = end;
            const auto data = std::span<const std::byte>{output_}.first(output_bytes_);
            return Block{status, data, position, compressed, wasted_bytes};
        }
        wasted_bytes += waste_of(output_bytes_);
        if (!end) break;
        end = find_mark(end->bit + 1);
    }
    mark_ = nearest;
    ++bad_blocks_;
    const std::uint64_t end_bit = nearest ? nearest->bit : all_bits;
    return Block{bunzip::Status::corrupt,
                 {},
                 static_cast<std::size_t>(begin / 8),
                 static_cast<std::size_t>((end_bit - begin) / 8),
                 wasted_bytes};
}

}  // namespace stormcellar::level2
