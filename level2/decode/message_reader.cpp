#include "level2/decode/message_reader.h"

#include <algorithm>

#include <fmt/format.h>

#include "level2/containers/archive_header.h"
#include "level2/messages/message_2.h"
#include "level2/messages/message_5.h"
#include "level2/messages/radial_compression.h"
#include "level2/messages/radial_message.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

// The size of a radial has 16 bits and counts halfwords. Message 29 has a size of 32 bits, but no
// known file contains one.
constexpr std::size_t longest_radial_bytes = std::size_t{1} << 18;
constexpr std::size_t longest_message_bytes = std::size_t{1} << 22;
// The length of an uncompressed radial has 16 bits.
constexpr std::size_t longest_expanded_bytes = std::size_t{1} << 16;

// Returns true if the next bytes prove that a message ends there: another message, a fill frame, a
// further volume header, or the end.
bool surely_follows(std::span<const std::byte> next, bool last, bool after_radial) {
    if (next.size() < message_header_bytes) return last && all_zero(next);
    if (read_archive_header(next)) return true;
    // Zeros after a radial are more likely gates below threshold of the next radial than a fill
    // frame.
    if (all_zero(next.first(message_header_bytes))) return !after_radial;
    return is_surely_message(next);
}

bool is_radial(const MessageHeader& header) {
    return header.type == 1 || header.type == 31;
}

// Returns true if these bytes can follow a message that contains no other message: they surely
// follow, or they are an odd radial, or zeros.
bool plausibly_follows(std::span<const std::byte> next, bool last) {
    if (next.size() < message_header_bytes) return last && all_zero(next);
    if (all_zero(next.first(message_header_bytes)) || read_archive_header(next)) return true;
    return is_surely_message(next) || places_its_gates(read_message_header(next), next);
}

// Returns true if these bytes can be the header of a message although one of its fields is
// impossible. The bytes after the message must confirm it.
bool may_be_odd(const MessageHeader& header, std::span<const std::byte> bytes) {
    if (is_radial(header)) return places_its_gates(header, bytes);
    return header.type != 0 && !header.has_own_length() && is_known_message_type(header.type) &&
           header.size_halfwords >= 8 &&
           header.size_halfwords <= (frame_bytes - terminal_manager_bytes) / 2 &&
           all_zero(bytes.first(terminal_manager_bytes));
}

std::size_t longest(int type) {
    return type == 31 ? longest_radial_bytes : longest_message_bytes;
}

}  // namespace

// Reads message by message. A message never crosses the end of a block. So damage ends with the
// block, and the next block begins with a message.
std::size_t MessageReader::read(std::span<const std::byte> data, bool last) {
    std::size_t at = 0;
    while (at < data.size() && !full()) {
        const std::size_t done = step(data.subspan(at), last);
        if (done == 0) break;
        at += done;
        offset_ += done;
    }
    if (last) {
        close_damage();
        in_sync_ = true;
    }
    return full() ? data.size() : at;
}

// Takes one step at the start of `rest`: a volume header, a fill frame, or a message. If none of
// these can begin here, the reader searches for the next message. Returns 0 if there are too few
// bytes to decide and more may come.
std::size_t MessageReader::step(std::span<const std::byte> rest, bool last) {
    if (!last && rest.size() < frame_bytes + sure_message_bytes) return 0;
    if (!in_sync_) return resynchronise(rest, 0, last, "bytes of the message stream are missing");
    if (const auto header = read_archive_header(rest)) {
        close_damage();
        builder_.further_header(*header);
        builder_.report().add(Severity::note, "further_volume_header",
                              fmt::format("a further volume header, {}", header->filename),
                              offset_);
        builder_.report_data().message_bytes += archive_header_bytes;
        return archive_header_bytes;
    }
    if (rest.size() < message_header_bytes) {
        if (all_zero(rest)) {
            builder_.report_data().message_bytes += rest.size();
            return rest.size();
        }
        return resynchronise(rest, rest.size(), last, "message header cut by the end of the data");
    }
    if (all_zero(rest.first(message_header_bytes))) return read_fill(rest, last);
    const MessageHeader header = read_message_header(rest.first(message_header_bytes));
    const std::size_t length = header.length_bytes();
    const bool may_be = is_plausible(header) || may_be_odd(header, rest);
    if (!may_be || length < message_header_bytes || length > longest(header.type)) {
        return resynchronise(rest, 1, last, "no message header where one is due");
    }
    return read_message(header, rest, last);
}

std::size_t MessageReader::read_fill(std::span<const std::byte> rest, bool last) {
    const auto frame = rest.first(std::min(rest.size(), frame_bytes));
    if (!all_zero(frame)) {
        return resynchronise(rest, 1, last, "type 0 frame with non-zero content");
    }
    close_damage();
    if (frame.size() == frame_bytes) ++builder_.report_data().message_counts[0];
    builder_.report_data().message_bytes += frame.size();
    return frame.size();
}

// Reads a message whose header is plausible or may be odd, and checks that the message really ends
// where its header says.
std::size_t MessageReader::read_message(const MessageHeader& header,
                                        std::span<const std::byte> rest, bool last) {
    const std::size_t length = header.length_bytes();
    if (rest.size() < length) {
        if (!last) return 0;
        return resynchronise(
            rest, message_header_bytes, last,
            fmt::format("message of type {} cut by the end of the data", header.type));
    }
    if (!last && rest.size() < length + sure_message_bytes) return 0;
    const auto message = rest.first(length);
    // A message is firm if it is a radial that agrees with its header and its length, and a message
    // surely follows. Nearly all radials are firm and need no further check.
    const bool firm = is_firm_radial(header, message) &&
                      surely_follows(rest.subspan(length), last, is_radial(header));
    if (!firm) {
        // If another message begins inside this message, then this message has lost bytes, or its
        // header is not a header.
        const auto search = rest.first(std::min(rest.size(), length + sure_message_bytes));
        const auto next = find_message(search, message_header_bytes);
        if (next && *next < length) {
            if (!open_damage_) {
                open_damage_ = OpenDamage{
                    offset_, offset_ + length, 0,
                    fmt::format("message of type {} has lost some of its bytes", header.type)};
            }
            return resynchronise(rest, *next, last, {});
        }
    }
    // No other message begins inside this message, so it has lost nothing. The message is framed if
    // the next bytes are at least plausible. An unframed message must have a plausible header, and
    // its content is read more strictly.
    const bool framed = firm || ((!is_radial(header) || places_its_gates(header, message)) &&
                                 plausibly_follows(rest.subspan(length), last));
    if (!framed && !is_plausible(header)) {
        return resynchronise(rest, 1, last, "no message header where one is due");
    }
    close_damage();
    take(header, message, framed ? Framing::proven : Framing::unproven, firm);
    builder_.report_data().message_bytes += length;
    return length;
}

// Drops the bytes up to the first sure message at or after `from`, or to the end.
std::size_t MessageReader::resynchronise(std::span<const std::byte> rest, std::size_t from,
                                         bool last, std::string reason) {
    if (!open_damage_) open_damage_ = OpenDamage{offset_, offset_, 0, std::move(reason)};
    std::size_t dropped = rest.size();
    if (const auto found = find_message(rest, from)) {
        dropped = *found;
        in_sync_ = true;
    } else {
        in_sync_ = false;
        // A message may begin in the last bytes, so keep them and read them again with the next
        // bytes.
        if (!last) dropped -= std::min(rest.size(), sure_message_bytes);
    }
    open_damage_->bytes += dropped;
    builder_.report_data().message_bytes += dropped;
    if (dropped == 0 && in_sync_) return step(rest, last);
    return dropped;
}

std::optional<Fragment> MessageReader::take_fragment() {
    if (open_damage_) return std::nullopt;
    offset_ = 0;
    return builder_.take();
}

void MessageReader::close_damage() {
    if (!open_damage_) return;
    if (open_damage_->bytes == 0) {
        open_damage_.reset();
        return;
    }
    builder_.report().damage("damaged_messages", std::move(open_damage_->reason),
                             open_damage_->offset, open_damage_->bytes, open_damage_->found_at);
    open_damage_.reset();
}

void MessageReader::take(const MessageHeader& header, std::span<const std::byte> message,
                         Framing framing, bool firm) {
    if (is_radial(header)) {
        take_radial(header, message, framing, firm);
        return;
    }
    if (!is_plausible(header)) {
        builder_.report().oddity(Severity::note, "odd_message",
                                 "messages other than radials have an impossible header", offset_);
    }
    if (!is_known_message_type(header.type)) {
        builder_.report().oddity(Severity::note, "unknown_message",
                                 fmt::format("message of unknown type {} skipped", header.type),
                                 offset_);
        return;
    }
    ++builder_.report_data().message_counts[header.type];
    // Bytes after the message's own length only fill the frame.
    const std::size_t own_bytes = terminal_manager_bytes + std::size_t{2} * header.size_halfwords;
    const auto body =
        message.first(std::min(message.size(), own_bytes)).subspan(message_header_bytes);
    if (header.type == 2) {
        // A frame of zeros holds no status.
        auto status = all_zero(body) ? std::nullopt : read_rda_status(header, body);
        if (status) builder_.report_data().rda_status = std::move(*status);
    }
    if (header.type == 5 || header.type == 7) {
        auto vcp = read_vcp(header.type, body);
        if (vcp) {
            if (!builder_.add_pattern(std::move(*vcp))) {
                failure_ = Fragment::Failure::too_large_arrays;
            }
        } else if (!all_zero(body.first(std::min(body.size(), vcp_header_bytes)))) {
            builder_.report().add(
                Severity::warning, "bad_pattern",
                fmt::format("message {} does not hold the cuts that it counts", header.type),
                offset_);
        }
    }
}

void MessageReader::refuse_radial(std::string_view reason, std::size_t bytes) {
    builder_.report().refuse("bad_radial", reason, offset_, bytes);
}

std::optional<std::span<const std::byte>> MessageReader::expand(std::span<const std::byte> message,
                                                                std::vector<std::byte>& store) {
    const auto body = message.subspan(message_header_bytes);
    auto whole = expand_message_31(body);
    // Damaged data count too, because expanding them took time.
    if (!builder_.add_expanded(whole ? whole->size() : longest_expanded_bytes)) {
        failure_ = Fragment::Failure::too_much_output;
        return std::nullopt;
    }
    if (!whole) {
        refuse_radial(whole.error(), message.size());
        return std::nullopt;
    }
    store = std::move(*whole);
    return store;
}

void MessageReader::note_oddities(const MessageHeader& header, std::span<const std::byte> message,
                                  const RadialMessage& radial, bool firm) {
    const auto body = message.subspan(message_header_bytes);
    const auto note = [&](std::string_view oddity) {
        builder_.report().oddity(Severity::note, "odd_radials", oddity, offset_);
    };
    if (!builder_.station().empty() && !radial.icao.empty() && radial.icao != builder_.station()) {
        const auto name = icao_of(radial.icao);
        if (name && *name != builder_.station())
            note("radials name another station than the first");
    }
    if (!is_plausible(header) || (!firm && !is_credible_radial(header, body))) {
        for (const std::string_view oddity : oddities_of(header, body))
            note(oddity);
    }
    for (const std::string_view oddity : radial.oddities)
        note(oddity);
    for (const RadialMessage::LostMoment& lost : radial.lost_moments)
        builder_.report().refuse("lost_moment", lost.reason, offset_, lost.bytes);
}

// Reads a radial: expands it if it is compressed, reads its blocks, notes its oddities, and passes
// it to the builder.
void MessageReader::take_radial(const MessageHeader& header, std::span<const std::byte> message,
                                Framing framing, bool firm) {
    auto body = message.subspan(message_header_bytes);
    if (framing == Framing::unproven && !is_credible_radial(header, body)) {
        refuse_radial("a radial contradicts its header", message.size());
        return;
    }
    const bool is_31 = header.type == 31;
    const int compression = is_31 ? message_31_compression(body) : 0;
    std::vector<std::byte> expanded;
    if (compression != 0) {
        // A radial that claims to be compressed may still be plain.
        const bool is_plain = framing == Framing::proven && read_message_31(body).has_value();
        if (is_plain) {
            builder_.report().oddity(Severity::note, "odd_radials",
                                     "radials say that they are compressed and are not", offset_);
        } else {
            const auto whole = expand(message, expanded);
            if (!whole) return;
            body = *whole;
        }
    }
    const RadialResult radial =
        is_31 ? read_message_31(body, framing) : read_message_1(body, framing);
    if (!radial) {
        refuse_radial(radial.error(), message.size());
        return;
    }
    ++builder_.report_data().message_counts[header.type];
    if (is_31) ++builder_.report_data().radial_compression[compression];
    note_oddities(header, message, *radial, firm);
    if (!builder_.add(*radial)) failure_ = Fragment::Failure::too_large_arrays;
}

void MessageFeed::append(std::span<const std::byte> bytes) {
    if (held_.empty()) {
        bytes = bytes.subspan(reader_.read(bytes, false));
        held_.assign(bytes.begin(), bytes.end());
        return;
    }
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    const std::size_t done = reader_.read(held_, false);
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(done));
}

void MessageFeed::end() {
    reader_.read(held_, true);
    held_.clear();
}

}  // namespace stormcellar::level2
