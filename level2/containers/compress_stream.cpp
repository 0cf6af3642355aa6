#include "level2/containers/compress_stream.h"

#include <algorithm>

namespace stormcellar::level2 {
namespace {

constexpr std::size_t head_bytes = 3;
constexpr std::uint32_t clear_code = 256;
constexpr std::uint32_t literals = 256;

}  // namespace

bool is_compress(std::span<const std::byte> bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte{0x1F} && bytes[1] == std::byte{0x9D};
}

CompressStream::CompressStream(std::span<const std::byte> bytes) : bytes_(bytes) {
    if (bytes.size() < head_bytes) {
        end_ = CompressEnd::truncated;
        return;
    }
    const auto flags = std::to_integer<unsigned>(bytes[2]);
    limit_ = static_cast<int>(flags & 0x1FU);
    clears_ = (flags & 0x80U) != 0;
    if (limit_ < least_width || limit_ > most_width) {
        end_ = CompressEnd::corrupt;
        return;
    }
    bytes_ = bytes.subspan(head_bytes);
    next_entry_ = clears_ ? clear_code + 1 : literals;
    prefixes_.resize(std::size_t{1} << limit_);
    lasts_.resize(std::size_t{1} << limit_);
    for (std::size_t i = 0; i < literals; ++i)
        lasts_[i] = static_cast<std::byte>(i);
}

std::size_t CompressStream::position() const {
    return std::min<std::size_t>(head_bytes + bytes_.size(), head_bytes + (bit_ + 7) / 8);
}

std::optional<std::uint32_t> CompressStream::next_code() {
    if (bit_ + static_cast<unsigned>(width_) > bytes_.size() * 8) return std::nullopt;
    std::uint32_t bits = 0;
    const std::size_t at = bit_ / 8;
    for (std::size_t i = 0; i < 3 && at + i < bytes_.size(); ++i)
        bits |= std::to_integer<std::uint32_t>(bytes_[at + i]) << (8 * i);
    bits >>= bit_ % 8;
    bit_ += static_cast<unsigned>(width_);
    return bits & ((1U << width_) - 1);
}

void CompressStream::begin_group(int width) {
    const std::uint64_t group_bits = std::uint64_t{8} * static_cast<unsigned>(width_);
    const std::uint64_t groups = (bit_ - group_start_ + group_bits - 1) / group_bits;
    bit_ = group_start_ + groups * group_bits;
    group_start_ = bit_;
    width_ = width;
}

void CompressStream::enter(std::uint32_t prefix, std::byte last) {
    if (next_entry_ >= prefixes_.size()) return;  // the table is full, so it does not change
    prefixes_[next_entry_] = static_cast<std::uint16_t>(prefix);
    lasts_[next_entry_] = last;
    ++next_entry_;
}

std::byte CompressStream::expand(std::uint32_t code) {
    const std::size_t start = output_.size();
    // A prefix is always an earlier entry, so the loop ends.
    for (; code >= literals; code = prefixes_[code])
        output_.push_back(lasts_[code]);
    output_.push_back(lasts_[code]);
    std::reverse(output_.begin() + static_cast<std::ptrdiff_t>(start), output_.end());
    return output_[start];
}

void CompressStream::take(std::uint32_t code) {
    if (clears_ && code == clear_code) {
        begin_group(least_width);
        next_entry_ = clear_code + 1;
        previous_.reset();
        return;
    }
    const bool own = previous_ && code == next_entry_ && next_entry_ < prefixes_.size();
    if (!own && code >= (previous_ ? next_entry_ : literals)) {
        end_ = CompressEnd::corrupt;
        return;
    }
    if (own) {
        // The code names the entry that this step adds: the previous string followed by its own
        // first byte.
        enter(*previous_, first_of_previous_);
        first_of_previous_ = expand(code);
    } else {
        const std::byte first = expand(code);
        if (previous_) enter(*previous_, first);
        first_of_previous_ = first;
    }
    previous_ = code;
}

std::span<const std::byte> CompressStream::next() {
    output_.clear();
    while (end_ == CompressEnd::none && output_.size() < piece_bytes) {
        // The writer widens its codes once the table fills their width. compress does so even if
        // the largest width is 9 bits, although no code then needs the tenth bit.
        if (width_ < std::max(limit_, least_width + 1) && next_entry_ >= (1U << width_))
            begin_group(width_ + 1);
        const auto code = next_code();
        if (!code) {
            end_ = CompressEnd::whole;
            break;
        }
        take(*code);
    }
    return output_;
}

}  // namespace stormcellar::level2
