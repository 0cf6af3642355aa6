#include "tests/fuzz/mutators.h"

#include <algorithm>
#include <array>
#include <vector>

#include <bzlib.h>

#include "base/byte_reader.h"

namespace stormcellar::fuzz {
namespace {

namespace wire = level2::wire;

constexpr std::size_t header_bytes = 24;
constexpr std::size_t message_header_bytes = 28;
constexpr std::size_t frame_bytes = 2432;
constexpr std::size_t most_unpacked_bytes = std::size_t{1} << 18;

// The parts of a file or stream: records or messages, and other bytes between them.
using Parts = std::vector<Bytes>;

Bytes join(const Parts& parts) {
    Bytes all;
    for (const Bytes& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

// Returns the header, which may be empty, and then the records.
Parts cut_records(std::span<const std::byte> file) {
    const bool has_header = file.size() >= header_bytes && file[0] == std::byte{'A'};
    const auto header = file.first(has_header ? header_bytes : 0);
    Parts parts{{header.begin(), header.end()}};
    std::span<const std::byte> rest = file.subspan(header.size());
    while (!rest.empty()) {
        ByteReader reader{rest};
        const std::int64_t control = reader.i32();
        const auto length = static_cast<std::size_t>(control < 0 ? -control : control) + 4;
        const auto part = rest.first(std::min(rest.size(), length));
        parts.emplace_back(part.begin(), part.end());
        rest = rest.subspan(part.size());
    }
    return parts;
}

Parts cut_messages(std::span<const std::byte> stream) {
    Parts parts;
    while (!stream.empty()) {
        std::size_t length = frame_bytes;
        if (stream[0] == std::byte{'A'}) {
            length = header_bytes;
        } else if (stream.size() >= message_header_bytes && stream[15] == std::byte{31}) {
            ByteReader reader{stream};
            reader.skip(12);
            length = std::max(message_header_bytes, 12 + std::size_t{2} * reader.u16());
        }
        const auto part = stream.first(std::min(stream.size(), length));
        parts.emplace_back(part.begin(), part.end());
        stream = stream.subspan(part.size());
    }
    return parts;
}

// Returns the unpacked contents of a record, or no bytes if the record is damaged or unpacks to
// more than most_unpacked_bytes.
Bytes unpack(const Bytes& record) {
    if (record.size() <= 4) return {};
    Bytes out(most_unpacked_bytes);
    Bytes in{record.begin() + 4, record.end()};
    auto size = static_cast<unsigned>(out.size());
    const int code = BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(out.data()), &size,
                                                reinterpret_cast<char*>(in.data()),
                                                static_cast<unsigned>(in.size()), 0, 0);
    if (code != BZ_OK) return {};
    out.resize(size);
    return out;
}

// Removes, repeats or swaps parts from `first` on.
void rearrange(Parts& parts, std::size_t first, Random& random) {
    if (parts.size() <= first) return;
    const std::size_t count = parts.size() - first;
    const auto a = static_cast<std::ptrdiff_t>(first + below(random, count));
    const auto b = static_cast<std::ptrdiff_t>(first + below(random, count));
    switch (below(random, 3)) {
        case 0:
            parts.erase(parts.begin() + a);
            break;
        case 1: {
            const Bytes copy = parts[static_cast<std::size_t>(a)];
            parts.insert(parts.begin() + b, copy);
            break;
        }
        default:
            std::swap(parts[static_cast<std::size_t>(a)], parts[static_cast<std::size_t>(b)]);
    }
}

// Sets a halfword of a message to an extreme value, most often a halfword of a known field.
void set_field(Bytes& message, Random& random) {
    // The offsets are for the size, the channel and type, and the segments of any message; the
    // azimuth number, azimuth, status, number of blocks and pointers of message 31; the gates and
    // pointers of message 1; and the number of cuts of message 5.
    constexpr std::array<std::size_t, 16> fields = {12, 14, 18, 24, 26, 28, 34, 36,
                                                    38, 40, 48, 54, 58, 62, 64, 68};
    constexpr std::array<unsigned, 14> numbers = {
        0, 1, 2, 8, 28, 255, 256, 1208, 1209, 0x7FFF, 0x8000, 0xFFFE, 0xFFFF, 0x7F80};
    const std::size_t at =
        below(random, 4) == 0 ? below(random, message.size()) : fields[below(random, 16)];
    if (at + 2 > message.size()) return;
    wire::overwrite_u16(message, at, numbers[below(random, numbers.size())]);
}

// Sets the type, the status or the elevation number to another meaningful value.
void set_kind(Bytes& message, Random& random) {
    constexpr std::array<unsigned, 9> types = {0, 1, 2, 5, 7, 15, 29, 31, 33};
    const std::size_t at = below(random, 2) == 0 ? 15 : 49;
    if (message.size() <= at) return;
    const std::size_t kind = at == 15 ? types[below(random, types.size())] : below(random, 7);
    message[at] = static_cast<std::byte>(kind);
}

Bytes new_message(Random& random) {
    wire::Ray ray;
    ray.azimuth_number = static_cast<unsigned>(below(random, 400));
    ray.elevation_number = static_cast<unsigned>(below(random, 4));
    ray.status = static_cast<unsigned>(below(random, 6));
    ray.gates = static_cast<unsigned>(below(random, 40));
    const std::array<float, 3> elevations_deg = {0.5F, 1.5F, -1};
    switch (below(random, 5)) {
        case 0:
            return wire::message_1(ray);
        case 1:
            return wire::vcp_frame(12, elevations_deg);
        case 2:
            return wire::frame(static_cast<unsigned>(below(random, 19)));
        case 3:
            return wire::archive_header();
        default:
            return wire::message_31(ray);
    }
}

void change_control_word(Bytes& record, Random& random) {
    constexpr std::array<std::uint32_t, 6> words = {0, 1, 0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 100};
    if (record.size() < 4) return;
    ByteReader reader{record};
    const std::uint32_t word = reader.u32();
    const std::array<std::uint32_t, 3> near = {word + 1, word - 1, ~word + 1};
    const std::size_t choice = below(random, words.size() + near.size());
    wire::overwrite_u32(record, 0,
                        choice < words.size() ? words[choice] : near[choice - words.size()]);
}

Bytes wrap(const Bytes& file, Random& random) {
    switch (below(random, 3)) {
        case 0:
            return wire::gzip(file);
        case 1:
            return wire::bzip2(file, 1);
        default:
            return wire::compress(file, static_cast<int>(9 + below(random, 8)), 0);
    }
}

void change_messages_of(Bytes& record, std::size_t most, Random& random,
                        const MutateBytes& mutate) {
    const Bytes messages = unpack(record);
    if (messages.empty()) return;
    const std::size_t room = std::max(most, messages.size() + frame_bytes);
    record = wire::ldm_record(mutate_messages(messages, room, random, mutate),
                              record[0] >= std::byte{0x80}, 1);
}

Bytes fitting(Bytes changed, const Bytes& original, std::size_t most, const MutateBytes& mutate) {
    if (!changed.empty() && changed.size() <= most) return changed;
    return mutate(original, most);
}

}  // namespace

Bytes mutate_messages(const Bytes& stream, std::size_t most, Random& random,
                      const MutateBytes& mutate) {
    if (stream.empty() || below(random, 4) == 0) return mutate(stream, most);
    Parts parts = cut_messages(stream);
    Bytes& part = parts[below(random, parts.size())];
    switch (below(random, 8)) {
        case 0:
            rearrange(parts, 0, random);
            break;
        case 1:
            part = new_message(random);
            break;
        case 2: {
            const auto at = static_cast<std::ptrdiff_t>(below(random, parts.size()));
            parts.insert(parts.begin() + at, new_message(random));
            break;
        }
        case 3:
            part.resize(below(random, part.size()));
            break;
        case 4:
            part = mutate(part, part.size() + frame_bytes);
            break;
        case 5:
            set_kind(part, random);
            break;
        default:
            set_field(part, random);
    }
    return fitting(join(parts), stream, most, mutate);
}

Bytes mutate_container(const Bytes& file, std::size_t most, Random& random,
                       const MutateBytes& mutate) {
    if (file.empty() || below(random, 4) == 0) return mutate(file, most);
    Parts parts = cut_records(file);
    if (parts.size() < 2) return mutate(file, most);
    Bytes& record = parts[1 + below(random, parts.size() - 1)];
    switch (below(random, 10)) {
        case 0:
            rearrange(parts, 1, random);
            break;
        case 1:
            change_control_word(record, random);
            break;
        case 2:
            record.resize(below(random, record.size()));
            break;
        case 3:
            return fitting(wrap(file, random), file, most, mutate);
        case 4:
            // Replace the record by a header, or by its unpacked contents.
            record = below(random, 2) == 0 ? wire::archive_header() : unpack(record);
            break;
        default:
            change_messages_of(record, most, random, mutate);
    }
    return fitting(join(parts), file, most, mutate);
}

Bytes mutate_live(const Bytes& input, std::size_t most, Random& random, const MutateBytes& mutate) {
    constexpr std::size_t order_bytes = 8;
    if (input.size() < order_bytes || most <= order_bytes) return mutate(input, most);
    const auto split = input.begin() + order_bytes;
    Bytes order(input.begin(), split);
    Bytes file(split, input.end());
    if (below(random, 3) == 0) {
        order[below(random, order_bytes)] = static_cast<std::byte>(random());
    } else {
        file = mutate_container(file, most - order_bytes, random, mutate);
    }
    return wire::join({order, file});
}

}  // namespace stormcellar::fuzz
