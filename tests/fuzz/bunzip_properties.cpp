#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "bunzip/bunzip.h"
#include "tests/bunzip/stream_maker.h"
#include "tests/fuzz/properties.h"

namespace stormcellar::fuzz {
namespace {

using bunzip::LibraryOutcome;
using bunzip::Path;

// Checks a Reader that reads in pieces of `piece` bytes: its output and its kind of end must be the
// same as from libbz2.
void check_path(std::span<const std::byte> stream, const LibraryOutcome& wanted, Path path,
                std::size_t piece, std::size_t limit) {
    static thread_local bunzip::Workspace workspace;
    bunzip::Reader reader(stream, workspace, path);
    std::vector<std::byte> buffer(piece);
    std::size_t made = 0;
    const auto fail = [&](const std::string& what) {
        throw PropertyError(fmt::format("{}: {}, after {} bytes of {}", name_of(path), what, made,
                                        wanted.bytes.size()));
    };
    while (!reader.ended() && made < limit) {
        const std::size_t room = std::min(piece, limit - made);
        const std::size_t now = reader.read(std::span{buffer}.first(room));
        if (now < room && !reader.ended()) fail("it stopped");
        const std::size_t begin = std::min(made, wanted.bytes.size());
        const auto known = std::span{wanted.bytes}.subspan(begin);
        const auto given = std::span{buffer}.first(std::min(now, known.size()));
        if (!std::equal(given.begin(), given.end(), known.begin())) fail("other bytes");
        made += now;
    }
    std::byte surplus{};
    const bool is_longer = !reader.ended() && reader.read({&surplus, 1}) > 0;
    const bunzip::Status status = !is_longer ? reader.status() : bunzip::Status::too_large;
    const int end = static_cast<int>(status), wanted_end = static_cast<int>(wanted.status);
    if (end != wanted_end) fail(fmt::format("it ends as {} and not as {}", end, wanted_end));
    // If a corrupt block ends inside a run, libbz2 returns more or fewer bytes of the run,
    // depending on its output pieces.
    if (status != bunzip::Status::corrupt && made != wanted.bytes.size()) fail("its output ends");
    if (status == bunzip::Status::whole && reader.input_bytes() != wanted.input_bytes)
        fail("the stream took other bytes");
}

// Checks decompress() with room for a part of the output, or for exactly all of it.
void check_limit(std::span<const std::byte> stream, const LibraryOutcome& unlimited, Path path,
                 std::size_t limit) {
    static thread_local bunzip::Workspace workspace;
    const LibraryOutcome wanted = bunzip::decompressed(stream, limit);
    std::vector<std::byte> out;
    const bunzip::Outcome outcome = bunzip::decompress(stream, out, limit, workspace, path);
    const auto fail = [&](const char* what) {
        throw PropertyError(fmt::format("{}, at most {} bytes: {}, {} bytes as {} and not {} as {}",
                                        name_of(path), limit, what, outcome.output_bytes,
                                        static_cast<int>(outcome.status), wanted.bytes.size(),
                                        static_cast<int>(wanted.status)));
    };
    const auto made = std::span{out}.first(outcome.output_bytes);
    const std::size_t both = std::min(made.size(), wanted.bytes.size());
    if (made.size() > limit) fail("too many");
    if (!std::equal(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(both),
                    wanted.bytes.begin())) {
        fail("others");
    }
    // In a damaged stream, bunzip and libbz2 may find the damage on different sides of the limit.
    if (unlimited.status == LibraryOutcome::Status::corrupt) return;
    if (static_cast<int>(outcome.status) != static_cast<int>(wanted.status)) fail("another end");
    if (made.size() != wanted.bytes.size()) fail("others");
}

}  // namespace

void check_bunzip(std::span<const std::byte> choices) {
    constexpr std::size_t limit = std::size_t{8} << 20;
    const auto stream = bunzip::stream_from(choices);
    const LibraryOutcome wanted = bunzip::decompressed(stream, limit);
    const std::size_t pieces[] = {std::size_t{1} << 20, 4096, 997, 1 + choices.size() % 300};
    const std::size_t piece =
        pieces[choices.empty() ? 0 : std::to_integer<std::size_t>(choices.back()) % 4];
    for (const Path path : bunzip::all_paths) {
        if (!bunzip::is_available(path)) continue;
        check_path(stream, wanted, path, piece, limit);
        check_limit(stream, wanted, path, wanted.bytes.size() * (choices.size() % 4) / 3);
    }
}

}  // namespace stormcellar::fuzz
