#include "tests/hard_cases/message_mutants.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "tests/hard_cases/message_fields.h"
#include "tests/testing/noise.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;
using Random = std::mt19937_64;

// Returns an extreme number: zero, a small number, an end of the range, or a neighbor of `was`; for
// 4 bytes also NaN, infinity or 1e30.
std::uint32_t extreme(std::uint32_t was, std::size_t width, Random& random) {
    const std::uint32_t most = width == 1 ? 0xFFU : width == 2 ? 0xFFFFU : 0xFFFFFFFFU;
    const std::array<std::uint32_t, 13> numbers = {
        0,       1,       2,  most,       most - 1,   most / 2,  most / 2 + 1,
        was + 1, was - 1, 31, 0x7FC00000, 0x7F800000, 0x7149F2CA};
    return numbers[below(random, width == 4 ? 13 : 10)] & most;
}

// Overwrites a field. Its offset counts from `start`. Returns a text about the change, or an empty
// text if the field is beyond the end.
std::string overwrite(Bytes& bytes, std::size_t start, const MessageField& field, Random& random) {
    const std::size_t at = start + field.at;
    if (at + field.width > bytes.size()) return {};
    const std::uint32_t was = number_at(bytes, at, field.width);
    const std::uint32_t is = extreme(was, field.width, random);
    set_number(bytes, at, field.width, is);
    return fmt::format("{} {:#x} becomes {:#x}", field.name, was, is);
}

std::span<const MessageField> own_fields(int type) {
    if (type == 31) return fields_of_31;
    if (type == 1) return fields_of_1;
    if (type == 5 || type == 7) return fields_of_5;
    return header_fields;
}

}  // namespace

MessageMutants::Draft MessageMutants::draft() const {
    Draft draft;
    for (const StreamMessage& message : volume_.messages) {
        const auto bytes = std::span{volume_.stream}.subspan(message.offset, message.length);
        draft.parts.emplace_back(bytes.begin(), bytes.end());
        draft.order.push_back(draft.order.size());
        draft.fates.push_back(Fate::kept);
    }
    return draft;
}

// Returns the elevation number of a radial, or 0 for any other message.
std::uint32_t MessageMutants::elevation_number(std::size_t number) const {
    const StreamMessage& message = volume_.messages[number];
    if (!message.radial) return 0;
    const auto bytes = std::span{volume_.stream}.subspan(message.offset, message.length);
    return message.type == 31 ? number_at(bytes, 50, 1) : number_at(bytes, 44, 2);
}

// Returns true if the decoder can take the radials between these messages for one volume, because
// they are no more than 15 minutes apart (level2/decode/late_radials.h).
bool MessageMutants::is_of_one_volume(std::size_t first_message, std::size_t last_message) const {
    constexpr std::uint32_t longest_ms = 15 * 60'000;
    std::optional<std::uint32_t> first;
    std::uint32_t last = 0;
    for (std::size_t number = first_message; number <= last_message; ++number) {
        const StreamMessage& message = volume_.messages[number];
        if (!message.radial) continue;
        const auto bytes = std::span{volume_.stream}.subspan(message.offset, message.length);
        last = number_at(bytes, 20, 4);
        if (!first) first = last;
    }
    return !first || last - *first <= longest_ms;
}

// Returns the number of a random message. One in eight of these messages is not a radial, if the
// volume has messages that are not radials.
std::size_t MessageMutants::any_message(Random& random) const {
    const bool other = random() % 8 == 0;
    std::size_t message = 0;
    for (int attempt = 0; attempt < 100; ++attempt) {
        message = below(random, volume_.messages.size());
        if (volume_.messages[message].radial.has_value() != other) break;
    }
    return message;
}

void MessageMutants::field(Draft& draft, Random& random) const {
    const std::size_t number = any_message(random);
    Bytes& bytes = draft.parts[number];
    const auto own = own_fields(volume_.messages[number].type);
    const bool of_header = random() % 3 == 0;
    const std::span<const MessageField> fields =
        of_header ? std::span<const MessageField>{header_fields} : own;
    const MessageField& field = fields[below(random, fields.size())];
    const std::string change = overwrite(bytes, 0, field, random);
    if (change.empty()) return;
    draft.fates[number] = Fate::damaged;
    draft.mutant.kind = of_header ? "field of a message header" : "field of a message";
    draft.mutant.what += fmt::format(" message {}: {}", number, change);
}

void MessageMutants::block_field(Draft& draft, Random& random) const {
    const std::size_t number = any_message(random);
    Bytes& bytes = draft.parts[number];
    if (volume_.messages[number].type != 31) return field(draft, random);
    const std::size_t block = below(random, number_at(bytes, 58, 2));
    const std::size_t at = 28 + number_at(bytes, 60 + 4 * block, 4);
    const std::string change = overwrite(
        bytes, at, moment_fields_of_31[below(random, moment_fields_of_31.size())], random);
    if (change.empty()) return;
    draft.fates[number] = Fate::damaged;
    draft.mutant.kind = "field of a data block";
    draft.mutant.what += fmt::format(" message {}, block {}: {}", number, block, change);
}

void MessageMutants::rearranged(Draft& draft, Random& random) const {
    constexpr std::array<const char*, 3> kinds = {"message removed", "message repeated",
                                                  "messages swapped"};
    const std::size_t kind = below(random, kinds.size());
    const std::size_t a = any_message(random);
    std::size_t b = any_message(random);
    // A radial in front of its sweep would begin a new sweep, so swap messages of different sweeps
    // only with their neighbors.
    if (kind == 2 && elevation_number(a) != elevation_number(b))
        b = std::min(a + 1, draft.order.size() - 1);
    std::vector<std::size_t>& order = draft.order;
    if (kind == 0) order.erase(order.begin() + static_cast<std::ptrdiff_t>(a));
    if (kind == 1) order.insert(order.begin() + static_cast<std::ptrdiff_t>(b), a);
    if (kind == 2) std::swap(order[a], order[b]);
    // A copy directly after its radial is not older than the radial, so the decoder keeps both.
    const bool is_beside_itself = kind == 1 && (b == a || b == a + 1);
    draft.is_put_right = !is_beside_itself && is_of_one_volume(std::min(a, b), std::max(a, b));
    draft.mutant.kind = kinds[kind];
    draft.mutant.what += fmt::format(" messages {} and {}", a, b);
}

// Adds bytes to a message or removes some. A radial that has lost bytes must never be returned.
void MessageMutants::resized(Draft& draft, Random& random) const {
    const std::size_t number = any_message(random);
    Bytes& bytes = draft.parts[number];
    const std::size_t at = below(random, bytes.size());
    const std::size_t count = 1 + below(random, random() % 2 == 0 ? 8 : 3000);
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const bool add = random() % 2 == 0;
    if (add) {
        const Bytes noise = testing::noise(count, 256, random);
        bytes.insert(place, noise.begin(), noise.end());
        draft.fates[number] = Fate::damaged;
    } else {
        bytes.erase(place, place + static_cast<std::ptrdiff_t>(std::min(count, bytes.size() - at)));
        const bool radial_follows =
            number + 1 < volume_.messages.size() && volume_.messages[number + 1].radial.has_value();
        draft.fates[number] = radial_follows ? Fate::may_fall : Fate::damaged;
    }
    draft.mutant.kind = add ? "bytes added to a message" : "bytes lost of a message";
    draft.mutant.what += fmt::format(" message {}: {} at {}", number, count, at);
}

void MessageMutants::flipped(Draft& draft, Random& random) const {
    const std::size_t number = any_message(random);
    Bytes& bytes = draft.parts[number];
    std::string where;
    for (std::size_t flips = 1 + below(random, 8); flips > 0; --flips) {
        const std::size_t most =
            random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 120) : bytes.size();
        const std::size_t at = below(random, most);
        bytes[at] ^= static_cast<std::byte>(1U << (random() % 8));
        where += fmt::format(" {}", at);
    }
    draft.fates[number] = Fate::damaged;
    draft.mutant.kind = "bits flipped in a message";
    draft.mutant.what += fmt::format(" message {}, bytes{}", number, where);
}

// Overwrites bytes with noise or zeros, from inside one message on, possibly into the next
// messages.
void MessageMutants::overwritten(Draft& draft, Random& random) const {
    const bool zeros = random() % 2 == 0;
    const std::size_t first = any_message(random);
    std::size_t number = first;
    std::size_t at = below(random, draft.parts[number].size());
    const std::size_t count = 1 + below(random, 12'000);
    for (std::size_t left = count; left > 0 && number < draft.parts.size();) {
        draft.parts[number][at] = zeros ? std::byte{0} : static_cast<std::byte>(random() % 256);
        draft.fates[number] = Fate::damaged;
        --left;
        if (++at == draft.parts[number].size()) {
            ++number;
            at = 0;
        }
    }
    draft.mutant.kind = zeros ? "zeros over messages" : "noise over messages";
    draft.mutant.what += fmt::format(" {} bytes from message {} on", count, first);
}

void MessageMutants::cut(Draft& draft, Random& random) const {
    const std::size_t number = any_message(random);
    Bytes& bytes = draft.parts[number];
    const std::array<std::size_t, 8> places = {
        0, 1, 4, 27, 28, 29, bytes.size() / 2, bytes.size() - 1};
    const std::size_t place = places[below(random, places.size())];
    bytes.resize(std::min(bytes.size(), place));
    draft.fates[number] = Fate::may_fall;
    draft.order.resize(place == 0 ? number : number + 1);
    draft.mutant.kind = "stream cut around a message's start";
    draft.mutant.what += fmt::format(" message {}, {} bytes of it kept", number, place);
}

void MessageMutants::several(Draft& draft, Random& random) const {
    field(draft, random);
    flipped(draft, random);
    block_field(draft, random);
    draft.mutant.kind = "several messages";
}

Mutant MessageMutants::finish(Draft draft, std::uint64_t number) const {
    Mutant& mutant = draft.mutant;
    Bytes stream;
    bool beside_damage = false;
    for (const std::size_t message : draft.order) {
        const Bytes& part = draft.parts[message];
        stream.insert(stream.end(), part.begin(), part.end());
        const auto radial = volume_.messages[message].radial;
        Fate fate = draft.fates[message];
        if (fate == Fate::kept && beside_damage) fate = Fate::beside;
        beside_damage = draft.fates[message] != Fate::kept;
        if (radial) mutant.expected.push_back({radial, fate});
    }
    if (draft.is_put_right) put_in_order(mutant.expected);
    const bool packed = number % 16 == 15;
    const Bytes body = packed ? wire::ldm_record(stream, true, 1) : std::move(stream);
    mutant.file = volume_.header;
    mutant.file.insert(mutant.file.end(), body.begin(), body.end());
    mutant.what = fmt::format("message mutant {}{}: {},{}", number, packed ? ", packed" : "",
                              mutant.kind, mutant.what);
    return mutant;
}

Mutant MessageMutants::make(std::uint64_t number) const {
    using Change = void (MessageMutants::*)(Draft&, Random&) const;
    constexpr std::array<Change, 11> changes = {
        &MessageMutants::field,       &MessageMutants::block_field, &MessageMutants::resized,
        &MessageMutants::cut,         &MessageMutants::field,       &MessageMutants::flipped,
        &MessageMutants::overwritten, &MessageMutants::rearranged,  &MessageMutants::block_field,
        &MessageMutants::resized,     &MessageMutants::several};
    Random random(number);
    Draft draft = this->draft();
    (this->*changes[number % changes.size()])(draft, random);
    return finish(std::move(draft), number);
}

}  // namespace stormcellar::level2
