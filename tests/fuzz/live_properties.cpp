// Checks the properties that must hold for a growing file and for chunks that arrive in any order.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "level2/containers/archive_header.h"
#include "level2/containers/ldm_framer.h"
#include "stormcellar/level2/growing_volume.h"
#include "stormcellar/level2/live_volume.h"
#include "tests/fuzz/properties.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"

namespace stormcellar::fuzz {
namespace {

using level2::Decoded;
using level2::wire::Bytes;

// Makes random decisions from a seed.
class Choices {
  public:
    explicit Choices(std::uint64_t seed) : state_(seed) {}
    std::size_t below(std::size_t end) {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<std::size_t>(state_ >> 33) % end;
    }

  private:
    std::uint64_t state_;
};

void require_same(const Result<Decoded>& a, const Result<Decoded>& b, std::string_view what) {
    if (a.has_value() != b.has_value()) {
        throw PropertyError(fmt::format("{}: error or not", what));
    }
    if (!a) {
        if (a.error().code != b.error().code || a.error().message != b.error().message) {
            throw PropertyError(
                fmt::format("{}: '{}' and '{}'", what, a.error().message, b.error().message));
        }
        return;
    }
    const std::string where = level2::difference(*a, *b);
    if (!where.empty()) throw PropertyError(fmt::format("{}: differ in {}", what, where));
}

void check_growing(std::span<const std::byte> file, Choices& choices) {
    level2::DecodeOptions options;
    options.output_limit_bytes = output_limit_bytes;
    level2::GrowingVolume growing{options};
    const std::size_t most = 1 + choices.below(1 + file.size());
    for (std::size_t at = 0; at < file.size();) {
        const std::size_t length = std::min(file.size() - at, 1 + choices.below(most));
        if (!growing.append(file.subspan(at, length))) break;
        at += length;
        for (const level2::LiveSweep& live : growing.take_sweeps()) {
            if (live.sweep.radials.empty()) throw PropertyError("a live sweep without radials");
        }
    }
    require_same(growing.finish(), level2::decode(file, options), "a file that grew");
}

// A chunk of a file that is cut at its records. Some chunks are lost, some come twice, and some
// come again cut short.
struct Chunk {
    int number = 0;
    Bytes bytes;
};
std::vector<Chunk> cut_into_chunks(std::span<const std::byte> file, Choices& choices) {
    const bool has_header = level2::read_archive_header(file).has_value();
    const std::size_t head = has_header ? level2::archive_header_bytes : 0;
    level2::LdmFramer framer{file.subspan(head)};
    std::vector<Chunk> chunks;
    std::size_t from = 0;
    while (const auto part = framer.next()) {
        const auto offset = static_cast<std::size_t>(part->bytes.data() - file.data());
        const std::size_t end =
            part->bytes.empty() ? head + part->position : offset + part->bytes.size();
        if (end <= from) continue;
        const auto bytes = file.subspan(from, end - from);
        chunks.push_back({static_cast<int>(chunks.size()) + 1, {bytes.begin(), bytes.end()}});
        from = end;
        if (chunks.size() == 64) break;
    }
    const std::size_t count = chunks.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (choices.below(4) == 0) chunks.push_back(chunks[i]);
        if (choices.below(6) == 0) {
            Chunk short_one = chunks[i];
            short_one.bytes.resize(choices.below(short_one.bytes.size() + 1));
            chunks.push_back(std::move(short_one));
        }
        if (choices.below(8) == 0) chunks[i].number = 0;  // lost
    }
    std::erase_if(chunks, [](const Chunk& chunk) { return chunk.number == 0; });
    return chunks;
}

Result<Decoded> arrive(const std::vector<Chunk>& chunks) {
    level2::LiveOptions options;
    options.decode.output_limit_bytes = output_limit_bytes;
    level2::LiveVolume live{options};
    for (const Chunk& chunk : chunks) {
        (void)live.add(chunk.number, level2::ChunkKind::intermediate, chunk.bytes, {});
        for (const level2::LiveSweep& sweep : live.take_sweeps()) {
            if (sweep.sweep.radials.empty()) throw PropertyError("a live sweep without radials");
            if (sweep.whole && !level2::is_whole(sweep.sweep)) throw PropertyError("not whole");
        }
        (void)live.facts();
        (void)live.is_whole();
    }
    return live.finish();
}

}  // namespace

void check_live(std::span<const std::byte> input) {
    constexpr std::size_t seed_bytes = 8;
    if (input.size() < seed_bytes) return;
    std::uint64_t seed = 0;
    for (const std::byte b : input.first(seed_bytes))
        seed = (seed << 8) | std::to_integer<std::uint64_t>(b);
    Choices choices{seed};
    const auto file = input.subspan(seed_bytes);
    check_growing(file, choices);
    std::vector<Chunk> chunks = cut_into_chunks(file, choices);
    if (chunks.empty()) return;
    const auto first = arrive(chunks);
    for (std::size_t i = chunks.size(); i > 1; --i)
        std::swap(chunks[i - 1], chunks[choices.below(i)]);
    require_same(arrive(chunks), first, "chunks in another order");
}

}  // namespace stormcellar::fuzz
