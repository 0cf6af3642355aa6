#include "tests/hard_cases/container_mutants.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <zlib.h>

#include "base/byte_reader.h"
#include "tests/testing/noise.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;
using Random = std::mt19937_64;

constexpr std::size_t control_word_bytes = 4;

std::int32_t control_of(const Bytes& record) {
    return ByteReader{record}.i32();
}

void set_control(Bytes& record, std::int32_t control) {
    wire::overwrite_u32(record, 0, static_cast<std::uint32_t>(control));
}

// Returns the number of bytes, equal to the start of `plain`, that can be unpacked from the damaged
// gzip file.
std::size_t readable_start(const Bytes& damaged, const Bytes& plain) {
    z_stream z{};
    if (inflateInit2(&z, 15 + 16) != Z_OK) return 0;
    Bytes in = damaged;
    Bytes out(plain.size());
    z.next_in = reinterpret_cast<Bytef*>(in.data());
    z.avail_in = static_cast<uInt>(in.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    inflate(&z, Z_SYNC_FLUSH);
    out.resize(out.size() - z.avail_out);
    inflateEnd(&z);
    const auto [at, same] = std::mismatch(out.begin(), out.end(), plain.begin());
    return static_cast<std::size_t>(at - out.begin());
}

std::string damage_gzip(Bytes& packed, Random& random) {
    const std::size_t at = below(random, packed.size());
    if (random() % 3 == 0) {
        packed.resize(at);
        return fmt::format("cut at {}", at);
    }
    packed[at] ^= static_cast<std::byte>(1U << (random() % 8));
    return fmt::format("bit flipped at {}", at);
}

}  // namespace

std::vector<std::size_t> ContainerMutants::all_records() const {
    std::vector<std::size_t> order(volume_.records.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
}

std::vector<ExpectedRadial> ContainerMutants::expect(const std::vector<std::size_t>& order,
                                                     std::optional<std::size_t> soft) const {
    std::vector<std::size_t> first(volume_.records.size() + 1, 0);
    for (std::size_t i = 0; i < volume_.records.size(); ++i)
        first[i + 1] = first[i] + volume_.radials_of_record[i];
    std::vector<ExpectedRadial> expected;
    for (const std::size_t record : order) {
        const Fate fate = record == soft ? Fate::may_fall : Fate::kept;
        for (std::size_t radial = first[record]; radial < first[record + 1]; ++radial)
            expected.push_back({radial, fate});
    }
    return expected;
}

Mutant ContainerMutants::with_record(std::string kind, std::size_t record,
                                     const Bytes& bytes) const {
    Mutant mutant;
    mutant.kind = std::move(kind);
    mutant.what = fmt::format("record {}", record);
    mutant.file = volume_.header;
    for (std::size_t i = 0; i < volume_.records.size(); ++i) {
        const Bytes& part = i == record ? bytes : volume_.records[i];
        mutant.file.insert(mutant.file.end(), part.begin(), part.end());
    }
    mutant.expected = expect(all_records(), record);
    return mutant;
}

// Changes a control word. The stream after it is intact, so nothing may be lost.
Mutant ContainerMutants::control_word(Random& random) const {
    constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    const std::size_t record = below(random, volume_.records.size());
    Bytes bytes = volume_.records[record];
    const std::int32_t control = control_of(bytes);
    const std::int32_t length = static_cast<std::int32_t>(bytes.size()) - 4;
    const std::array<std::int32_t, 11> words = {
        0, 1, -1, least, most, length + 1, length - 1, -length - 1, length / 2, 100, -control};
    const std::int32_t word = words[below(random, words.size())];
    set_control(bytes, word);
    Mutant mutant = with_record("control word", record, bytes);
    mutant.what += fmt::format(": {} becomes {}", control, word);
    mutant.expected = expect(all_records(), std::nullopt);
    mutant.always_named = word != control && word != -control;
    return mutant;
}

Mutant ContainerMutants::rearranged(Random& random) const {
    constexpr std::array<const char*, 3> kinds = {"record removed", "record repeated",
                                                  "records swapped"};
    const std::size_t kind = below(random, kinds.size());
    std::vector<std::size_t> order = all_records();
    const std::size_t a = below(random, order.size());
    const std::size_t b = below(random, order.size());
    if (kind == 0 && order.size() > 1) order.erase(order.begin() + static_cast<std::ptrdiff_t>(a));
    if (kind == 1) order.insert(order.begin() + static_cast<std::ptrdiff_t>(b), a);
    if (kind == 2) std::swap(order[a], order[b]);
    Mutant mutant;
    mutant.kind = kinds[kind];
    mutant.what = fmt::format("records {} and {}", a, b);
    mutant.file = volume_.header;
    for (const std::size_t record : order) {
        const Bytes& bytes = volume_.records[record];
        mutant.file.insert(mutant.file.end(), bytes.begin(), bytes.end());
    }
    mutant.expected = expect(order, std::nullopt);
    put_in_order(mutant.expected);
    return mutant;
}

// Cuts the file at or near the start of a record, or in the middle of the record.
Mutant ContainerMutants::cut(Random& random) const {
    const std::size_t record = below(random, volume_.records.size());
    std::size_t start = volume_.header.size();
    for (std::size_t i = 0; i < record; ++i)
        start += volume_.records[i].size();
    const std::size_t size = volume_.records[record].size();
    const std::array<std::size_t, 6> places = {start - 1, start,      start + 1,
                                               start + 4, start + 14, start + size / 2};
    const std::size_t place = start == 0 ? size / 2 : places[below(random, places.size())];
    Mutant mutant;
    mutant.kind = "cut around a record's start";
    mutant.what = fmt::format("at {}, record {} begins at {}", place, record, start);
    mutant.file = volume_.ldm_file();
    mutant.file.resize(place);
    std::vector<std::size_t> order = all_records();
    order.resize(place > start ? record + 1 : record);
    // The last record is cut, unless the cut is exactly between two records.
    mutant.expected = expect(
        order, place == start || order.empty() ? std::nullopt : std::optional{order.size() - 1});
    return mutant;
}

Mutant ContainerMutants::flipped(Random& random) const {
    const std::size_t record = below(random, volume_.records.size());
    Bytes bytes = volume_.records[record];
    std::string where;
    for (std::size_t flips = 1 + below(random, 3); flips > 0; --flips) {
        const std::size_t at = control_word_bytes + below(random, bytes.size() - 4);
        bytes[at] ^= static_cast<std::byte>(1U << (random() % 8));
        where += fmt::format(" {}", at);
    }
    Mutant mutant = with_record("bits flipped in a record", record, bytes);
    mutant.what += ", bytes" + where;
    return mutant;
}

Mutant ContainerMutants::resized(Random& random) const {
    const std::size_t record = below(random, volume_.records.size());
    Bytes bytes = volume_.records[record];
    const std::size_t at = control_word_bytes + below(random, bytes.size() - 4);
    const std::size_t count = 1 + below(random, 1000);
    const bool add = random() % 2 == 0;
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    if (add) {
        const Bytes noise = testing::noise(count, 256, random);
        bytes.insert(place, noise.begin(), noise.end());
    } else {
        bytes.erase(place, place + static_cast<std::ptrdiff_t>(std::min(count, bytes.size() - at)));
    }
    Mutant mutant =
        with_record(add ? "bytes added to a record" : "bytes lost of a record", record, bytes);
    mutant.what += fmt::format(": {} at {}", count, at);
    return mutant;
}

Mutant ContainerMutants::overwritten(Random& random) const {
    const std::size_t record = below(random, volume_.records.size());
    Bytes bytes = volume_.records[record];
    const std::size_t at = below(random, bytes.size());
    const std::size_t count = std::min(bytes.size() - at, 1 + below(random, 4096));
    const bool zeros = random() % 2 == 0;
    for (std::size_t i = at; i < at + count; ++i)
        bytes[i] = zeros ? std::byte{0} : static_cast<std::byte>(random() % 256);
    Mutant mutant =
        with_record(zeros ? "zeros over a record" : "noise over a record", record, bytes);
    mutant.what += fmt::format(": {} at {}", count, at);
    return mutant;
}

// Damages the gzip layer around records. Records that are unpacked before the damage are kept;
// checksums of bzip2 guard the other records.
Mutant ContainerMutants::gzip(Random& random) const {
    Mutant mutant;
    mutant.kind = "gzip around records";
    const Bytes plain = volume_.ldm_file();
    mutant.file = wire::gzip(plain);
    mutant.what = damage_gzip(mutant.file, random);
    const std::size_t readable = readable_start(mutant.file, plain);
    mutant.expected = expect(all_records(), std::nullopt);
    std::size_t end = volume_.header.size();
    std::size_t radial = 0;
    for (std::size_t i = 0; i < volume_.records.size(); ++i) {
        end += volume_.records[i].size();
        for (std::size_t j = 0; j < volume_.radials_of_record[i]; ++j, ++radial) {
            if (end > readable) mutant.expected[radial].fate = Fate::may_fall;
        }
    }
    return mutant;
}

Mutant ContainerMutants::make(std::uint64_t number) const {
    using Make = Mutant (ContainerMutants::*)(Random&) const;
    constexpr std::array<Make, 12> makers = {
        &ContainerMutants::control_word, &ContainerMutants::cut,
        &ContainerMutants::flipped,      &ContainerMutants::rearranged,
        &ContainerMutants::resized,      &ContainerMutants::control_word,
        &ContainerMutants::overwritten,  &ContainerMutants::cut,
        &ContainerMutants::flipped,      &ContainerMutants::rearranged,
        &ContainerMutants::resized,      &ContainerMutants::gzip};
    Random random(number);
    Mutant mutant = (this->*makers[number % makers.size()])(random);
    mutant.what = fmt::format("container mutant {}: {}, {}", number, mutant.kind, mutant.what);
    return mutant;
}

Mutant gzip_mutant(const UnpackedVolume& volume, std::uint64_t number) {
    Random random(number);
    Mutant mutant;
    mutant.kind = "gzip around messages";
    const Bytes plain = volume.plain_file();
    mutant.file = wire::gzip(plain);
    mutant.what = fmt::format("gzip mutant {}: {}", number, damage_gzip(mutant.file, random));
    const std::size_t readable = readable_start(mutant.file, plain);
    for (const StreamMessage& message : volume.messages) {
        if (message.radial && volume.header.size() + message.end() <= readable)
            mutant.expected.push_back({*message.radial, Fate::kept});
    }
    // After the damage anything may follow, because gzip checks its contents only at the end of the
    // file.
    mutant.anything_after = true;
    return mutant;
}

}  // namespace stormcellar::level2
