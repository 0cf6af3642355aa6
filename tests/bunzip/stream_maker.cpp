#include "tests/bunzip/stream_maker.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <map>

#include <bzlib.h>

namespace stormcellar::bunzip {
namespace {

class BitWriter {
  public:
    void put(std::uint64_t number, unsigned bits) {
        for (unsigned bit = bits; bit-- > 0;) {
            if (used_ % 8 == 0) bytes_.push_back(std::byte{0});
            if ((number >> bit & 1U) != 0) bytes_.back() |= std::byte{0x80} >> (used_ % 8);
            ++used_;
        }
    }
    [[nodiscard]] Bytes take() { return std::move(bytes_); }

  private:
    Bytes bytes_;
    std::size_t used_ = 0;
};

// Returns the words of a canonical code. If the lengths do not form a code, words are cut to their
// length.
std::vector<std::uint32_t> words_of(std::span<const std::uint8_t> lengths) {
    std::vector<std::uint32_t> words(lengths.size());
    std::uint32_t word = 0;
    for (unsigned length = 1; length <= 20; ++length, word *= 2) {
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
            if (lengths[symbol] == length) words[symbol] = word++;
        }
    }
    return words;
}

void put_bytes_there(BitWriter& to, std::span<const std::uint8_t> bytes) {
    std::array<std::uint16_t, 16> ranges{};
    for (const std::uint8_t byte : bytes)
        ranges[byte / 16] |= static_cast<std::uint16_t>(0x8000U >> (byte % 16));
    for (const std::uint16_t range : ranges)
        to.put(range != 0 ? 1 : 0, 1);
    for (const std::uint16_t range : ranges) {
        if (range != 0) to.put(range, 16);
    }
}

void put_lengths(BitWriter& to, std::span<const std::uint8_t> lengths) {
    unsigned now = lengths.empty() ? 1 : lengths.front();
    to.put(now, 5);
    for (const unsigned length : lengths) {
        for (; now < length; ++now)
            to.put(2, 2);
        for (; now > length; --now)
            to.put(3, 2);
        to.put(0, 1);
    }
}

void put_symbols(BitWriter& to, const BlockPlan& block) {
    std::vector<std::uint8_t> order(block.lengths.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = static_cast<std::uint8_t>(i);
    std::vector<std::vector<std::uint32_t>> words;
    for (const auto& lengths : block.lengths)
        words.push_back(words_of(lengths));
    for (std::size_t i = 0; i < block.symbols.size(); ++i) {
        if (i % 50 == 0 && i / 50 < block.selectors.size()) {
            const std::size_t place = block.selectors[i / 50];
            if (place < order.size())
                std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(place),
                            order.begin() + static_cast<std::ptrdiff_t>(place) + 1);
        }
        if (order.empty()) return;
        const auto& lengths = block.lengths[order[0]];
        const std::size_t symbol = block.symbols[i];
        if (symbol < lengths.size()) to.put(words[order[0]][symbol], lengths[symbol]);
    }
}

void put_block(BitWriter& to, const BlockPlan& block) {
    to.put(0x314159265359, 48);
    to.put(block.checksum, 32);
    to.put(block.randomised ? 1 : 0, 1);
    to.put(block.origin, 24);
    put_bytes_there(to, block.bytes);
    to.put(block.lengths.size(), 3);
    to.put(block.stated_selectors.value_or(static_cast<std::uint32_t>(block.selectors.size())), 15);
    for (const std::uint8_t selector : block.selectors)
        to.put((1U << (selector + 1)) - 2, selector + 1U);
    for (const auto& lengths : block.lengths)
        put_lengths(to, lengths);
    put_symbols(to, block);
}

// Returns the bytes that determine a stream, one after the other, and then zeros.
class Choices {
  public:
    explicit Choices(std::span<const std::byte> bytes) : bytes_(bytes) {}
    [[nodiscard]] bool empty() const { return bytes_.empty(); }
    unsigned byte() {
        if (bytes_.empty()) return 0;
        const auto value = std::to_integer<unsigned>(bytes_.front());
        bytes_ = bytes_.subspan(1);
        return value;
    }
    unsigned below(unsigned end) { return (byte() << 8 | byte()) % end; }
    std::span<const std::byte> rest() const { return bytes_; }

  private:
    std::span<const std::byte> bytes_;
};

// Returns contents with runs, periods and random pieces.
Bytes contents_from(Choices& choices) {
    const std::size_t most = choices.byte() % 16 == 0 ? 300'000 : 20'000;
    Bytes bytes;
    while (!choices.empty() && bytes.size() < most) {
        const unsigned length = 1 + choices.byte() % 32;
        const unsigned kind = choices.byte();
        const unsigned times = 1 + (kind < 128 ? kind % 8 : choices.below(20'000));
        Bytes piece;
        for (unsigned i = 0; i < length; ++i)
            piece.push_back(
                static_cast<std::byte>(kind % 3 == 0 ? choices.byte() % 4 : choices.byte()));
        for (unsigned i = 0; i < times && bytes.size() < most; ++i)
            bytes.insert(bytes.end(), piece.begin(), piece.end());
    }
    return bytes;
}

std::vector<std::uint8_t> lengths_from(Choices& choices, std::size_t symbols) {
    std::vector<std::uint8_t> lengths;
    const unsigned kind = choices.byte() % 4;
    for (std::size_t i = 0; i < symbols; ++i) {
        // The lengths are all equal, or grow by one up to the longest, or are random, or nearly
        // equal.
        const auto even = static_cast<unsigned>(std::bit_width(symbols - 1));
        const unsigned comb = std::min<unsigned>(20, static_cast<unsigned>(i) + 1);
        const unsigned length = kind == 0   ? even
                                : kind == 1 ? comb
                                : kind == 2 ? 1 + choices.byte() % 20
                                            : even + choices.byte() % 3;
        lengths.push_back(static_cast<std::uint8_t>(std::clamp(length, 1U, 20U)));
    }
    return lengths;
}

BlockPlan plan_from(Choices& choices) {
    BlockPlan block;
    block.randomised = choices.byte() == 77;
    block.origin = choices.below(choices.byte() % 2 == 0 ? 4 : 2000);
    const unsigned step = 1 + choices.byte() % 64;
    for (unsigned byte = choices.byte() % 8; byte < 256; byte += step)
        block.bytes.push_back(static_cast<std::uint8_t>(byte));
    const std::size_t symbols = block.bytes.size() + 2;
    const unsigned codes = choices.byte() % 32 == 0 ? choices.byte() % 8 : 2 + choices.byte() % 5;
    for (unsigned i = 0; i < codes; ++i)
        block.lengths.push_back(lengths_from(choices, symbols));
    const unsigned selectors = choices.below(choices.byte() % 16 == 0 ? 20'000 : 40);
    for (unsigned i = 0; i < selectors; ++i)
        block.selectors.push_back(static_cast<std::uint8_t>(
            codes == 0 ? 0 : choices.byte() % (codes + (choices.byte() == 9 ? 1 : 0))));
    if (choices.byte() == 5) block.stated_selectors = choices.below(32'768);
    while (!choices.empty() && block.symbols.size() < 50'000) {
        const unsigned kind = choices.byte();
        const auto any = static_cast<std::uint16_t>(choices.below(static_cast<unsigned>(symbols)));
        const auto digit = static_cast<std::uint16_t>(any & 1U);
        const unsigned times = kind % 4 == 0 ? 1 + kind / 4 % 24 : 1;
        for (unsigned i = 0; i < times; ++i)
            block.symbols.push_back(kind % 4 == 0 ? digit : any);
    }
    if (block.origin % 16 != 3) block.symbols.push_back(static_cast<std::uint16_t>(symbols - 1));
    return block;
}

}  // namespace

Bytes bytes_of(std::string_view text) {
    Bytes bytes;
    for (const char c : text)
        bytes.push_back(static_cast<std::byte>(c));
    return bytes;
}

Bytes compressed(std::span<const std::byte> bytes, int level) {
    Bytes out(bytes.size() + bytes.size() / 100 + 600);
    auto size = static_cast<unsigned>(out.size());
    // libbz2 does not write to its input, and refuses a null pointer even for zero bytes.
    char nothing = 0;
    auto* const from =
        bytes.empty() ? &nothing : const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    if (BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &size, from,
                                 static_cast<unsigned>(bytes.size()), level, 0, 0) != BZ_OK) {
        std::abort();
    }
    out.resize(size);
    return out;
}

LibraryOutcome decompressed(std::span<const std::byte> stream, std::size_t limit) {
    using Status = LibraryOutcome::Status;
    bz_stream bz{};
    if (BZ2_bzDecompressInit(&bz, 0, 0) != BZ_OK) std::abort();
    bz.next_in = const_cast<char*>(reinterpret_cast<const char*>(stream.data()));
    bz.avail_in = static_cast<unsigned>(stream.size());
    LibraryOutcome outcome{Status::whole, {}, 0};
    int code = BZ_OK;
    for (;;) {
        const std::size_t made = outcome.bytes.size();
        // One byte of room beyond the limit shows if the output is longer.
        outcome.bytes.resize(std::min(limit + 1, made + 65'536));
        bz.next_out = reinterpret_cast<char*>(outcome.bytes.data() + made);
        const auto room = static_cast<unsigned>(outcome.bytes.size() - made);
        bz.avail_out = room;
        code = BZ2_bzDecompress(&bz);
        outcome.bytes.resize(made + room - bz.avail_out);
        if (outcome.bytes.size() > limit) {
            outcome.bytes.pop_back();
            outcome.status = Status::too_large;
            break;
        }
        if (code == BZ_OK && bz.avail_out == 0) continue;
        outcome.status = code == BZ_STREAM_END ? Status::whole
                         : code == BZ_OK       ? Status::truncated
                                               : Status::corrupt;
        break;
    }
    outcome.input_bytes = stream.size() - bz.avail_in;
    BZ2_bzDecompressEnd(&bz);
    return outcome;
}

std::uint32_t slow_checksum(std::span<const std::byte> bytes) {
    std::uint32_t state = 0xFFFFFFFF;
    for (const std::byte byte : bytes) {
        state ^= std::to_integer<std::uint32_t>(byte) << 24;
        for (int bit = 0; bit < 8; ++bit)
            state = state << 1 ^ ((state >> 31) != 0 ? 0x04C11DB7U : 0U);
    }
    return ~state;
}

Bytes stream_of(char level, std::span<const BlockPlan> blocks, std::optional<std::uint32_t> end) {
    BitWriter to;
    for (const char c : {'B', 'Z', 'h', level})
        to.put(static_cast<std::uint8_t>(c), 8);
    for (const BlockPlan& block : blocks)
        put_block(to, block);
    if (end) {
        to.put(0x177245385090, 48);
        to.put(*end, 32);
    }
    return to.take();
}

Bytes mended_stream(char level, BlockPlan block) {
    constexpr std::size_t most = std::size_t{8} << 20;
    const Bytes first = stream_of(level, std::span{&block, 1}, 0);
    block.checksum = slow_checksum(decompressed(first, most).bytes);
    return stream_of(level, std::span{&block, 1}, block.checksum);
}

Bytes stream_from(std::span<const std::byte> input) {
    Choices choices(input);
    const unsigned kind = choices.byte() % 4;
    if (kind == 0) return {choices.rest().begin(), choices.rest().end()};
    if (kind == 3) {
        const unsigned first = choices.byte();
        const unsigned cut = first < 234 ? 0 : choices.byte();
        Bytes stream = mended_stream(static_cast<char>('1' + first % 9), plan_from(choices));
        if (cut > 0) stream.resize(stream.size() - std::min<std::size_t>(cut, stream.size()));
        return stream;
    }
    const int level = 1 + static_cast<int>(choices.byte() % 9);
    // Make up to three changes at places that `choices` determines.
    std::map<unsigned, std::byte> changes;
    if (kind == 2) {
        for (unsigned i = choices.byte() % 4; i > 0; --i)
            changes[choices.below(65'536)] = static_cast<std::byte>(choices.byte());
    }
    const unsigned cut = kind == 2 ? choices.byte() : 0;
    Bytes stream = compressed(contents_from(choices), level);
    for (const auto& [at, change] : changes)
        stream[at % stream.size()] ^= change;
    if (cut > 200) stream.resize(stream.size() * (cut - 200) / 56);
    return stream;
}

}  // namespace stormcellar::bunzip
