#include "bunzip/bunzip.h"

#include <algorithm>
#include <bit>
#include <new>
#include <optional>

#include "bunzip/bit_reader.h"
#include "bunzip/block_decoder.h"
#include "bunzip/bzip2_checksum.h"
#include "bunzip/bzip2_format.h"
#include "bunzip/library_stream.h"
#include "bunzip/run_expander.h"

namespace stormcellar::bunzip {
namespace {

constexpr std::size_t first_buffer_bytes = std::size_t{5} << 18;
// The checksum of output is computed in pieces of this size, so that a piece is still in the
// first-level cache.
constexpr std::size_t checked_piece = std::size_t{16} << 10;

Status status_of(Found found) {
    return found == Found::cut ? Status::truncated : Status::corrupt;
}

// Compares the next `count` bytes with `bytes`, one by one as libbz2 does, so that a wrong byte is
// reported before missing bytes.
Found expect_bytes(BitReader& reader, std::uint64_t bytes, unsigned count) {
    for (unsigned i = count; i > 0; --i) {
        const auto byte = reader.read(8);
        if (!byte) return Found::cut;
        if (*byte != (bytes >> (8 * (i - 1)) & 0xFF)) return Found::bad;
    }
    return Found::good;
}

}  // namespace

Workspace::Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;

struct Reader::State {
    State(std::span<const std::byte> stream, BlockDecoder* decoder, Path way)
        : input(stream), bits(stream), blocks(decoder), path(way) {}

    void end(Status how) {
        ended = true;
        status = how;
    }
    [[nodiscard]] Found read_header();
    void read_mark();
    void read_block();
    void read_end();
    void end_block();
    void hand_over();
    [[nodiscard]] std::size_t expand(std::span<std::byte> out);

    std::span<const std::byte> input;
    BitReader bits;
    BlockDecoder* blocks;
    Path path;
    std::uint32_t most_bytes = 0;  // largest size of a block; 0 before the header
    bool in_block = false;
    RunExpander expander;
    std::uint32_t block_checksum = 0, stated_checksum = 0, all_checksums = 0;
    std::uint64_t made = 0;
    std::optional<LibraryStream> library;  // if set, it reads the stream
    bool ended = false;
    Status status = Status::whole;
};

Found Reader::State::read_header() {
    if (const Found found = expect_bytes(bits, 0x425A68, 3); found != Found::good) return found;
    const auto level = bits.read(8);
    if (!level) return Found::cut;
    if (*level < '1' || *level > '9') return Found::bad;
    most_bytes = (*level - '0') * block_unit;
    return Found::good;
}

void Reader::State::read_mark() {
    if (most_bytes == 0) {
        if (const Found found = read_header(); found != Found::good) return end(status_of(found));
    }
    const bool is_end = bits.bits_left() >= 8 && bits.peek() >> 56 == end_mark >> 40;
    const Found found = expect_bytes(bits, is_end ? end_mark : block_mark, mark_bits / 8);
    if (found != Found::good) return end(status_of(found));
    if (is_end) {
        read_end();
    } else {
        read_block();
    }
}

void Reader::State::read_end() {
    const auto stated = bits.read(32);
    if (!stated) return end(Status::truncated);
    end(*stated == all_checksums ? Status::whole : Status::corrupt);
}

void Reader::State::read_block() {
    const auto stated = bits.read(32);
    if (!stated) return end(Status::truncated);
    stated_checksum = *stated;
    const Found found = blocks->read(bits, most_bytes, path);
    if (found == Found::randomised) return hand_over();
    if (found != Found::good) return end(status_of(found));
    expander.begin(blocks->bytes_and_one_more(), path);
    block_checksum = checksum_begin;
    in_block = true;
}

void Reader::State::end_block() {
    in_block = false;
    if (expander.bad() || ~block_checksum != stated_checksum) return end(Status::corrupt);
    all_checksums = std::rotl(all_checksums, 1) ^ stated_checksum;
}

// Lets libbz2 read the stream from its beginning, and drops the bytes that were already returned.
void Reader::State::hand_over() {
    library.emplace(input);
    std::vector<std::byte> dropped(checked_piece);
    for (std::uint64_t left = made; left > 0 && !library->ended();) {
        const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(left, dropped.size()));
        left -= library->read(std::span{dropped}.first(piece));
    }
}

std::size_t Reader::State::expand(std::span<std::byte> out) {
    const auto piece = out.first(std::min(out.size(), checked_piece));
    const std::span bytes{reinterpret_cast<std::uint8_t*>(piece.data()), piece.size()};
    const std::size_t count = expander.read(bytes);
    block_checksum = checksum_by(path)(block_checksum, bytes.first(count));
    made += count;
    return count;
}

Reader::Reader(std::span<const std::byte> stream, Workspace& workspace, Path path) {
    if (path != Path::libbz2 && !workspace.blocks_)
        workspace.blocks_ = std::make_unique<BlockDecoder>();
    state_ = std::make_unique<State>(stream, workspace.blocks_.get(), path);
    if (path == Path::libbz2) state_->library.emplace(stream);
}
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;
Reader::~Reader() = default;

std::size_t Reader::read(std::span<std::byte> out) {
    State& state = *state_;
    std::size_t count = 0;
    // After the last byte of a block, read the next mark at once, even if there is no room left. So
    // the call that returns the last byte of a stream also ends it.
    while (!state.ended && !out.empty() && !state.library) {
        if (!state.in_block) {
            state.read_mark();
        } else if (state.expander.ended()) {
            state.end_block();
        } else if (count == out.size()) {
            break;
        } else {
            count += state.expand(out.subspan(count));
        }
    }
    if (state.library && !state.ended) {
        count += state.library->read(out.subspan(count));
        if (state.library->ended()) state.end(state.library->status());
    }
    return count;
}

bool Reader::ended() const {
    return state_->ended;
}

Status Reader::status() const {
    return state_->status;
}

std::size_t Reader::input_bytes() const {
    return state_->library ? state_->library->input_bytes() : state_->bits.bytes_taken();
}

Outcome decompress(std::span<const std::byte> stream, std::vector<std::byte>& buffer,
                   std::size_t limit, Workspace& workspace, Path path) {
    Reader reader(stream, workspace, path);
    if (buffer.empty()) buffer.resize(std::min(limit, first_buffer_bytes));
    std::size_t made = 0;
    for (;;) {
        // An earlier stream may have made the buffer larger than the limit.
        const std::size_t room = std::min(buffer.size(), limit);
        made += reader.read(std::span{buffer}.first(room).subspan(made));
        if (reader.ended()) return {reader.status(), made, reader.input_bytes()};
        if (made >= limit) {
            // libbz2 stops when the room is full, and a reader without room reads nothing. So read
            // one byte more to see if the output is longer or the stream ends.
            std::byte surplus{};
            const bool is_longer = reader.read({&surplus, 1}) > 0;
            return {is_longer ? Status::too_large : reader.status(), made, reader.input_bytes()};
        }
        if (made == buffer.size()) buffer.resize(std::min(limit, 2 * buffer.size()));
    }
}

}  // namespace stormcellar::bunzip
