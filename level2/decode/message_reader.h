// level2/decode/message_reader.h -- walks a stream of messages and keeps whole messages.
//
// A message counts only if the next message begins where this message ends, or if the data end
// there. Otherwise the reader searches for the next place at which a message surely begins. If that
// place is inside the current message, the current message has lost bytes and is dropped too, so
// that no half radial is kept. If the next message begins where a radial ends, even a very odd
// radial is kept, unless its gates cannot be read (docs/level2.md has the table). Strict rules
// apply only to the search after damage.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "level2/decode/fragment_builder.h"
#include "level2/messages/message_header.h"
#include "level2/messages/radial_message.h"

namespace stormcellar::level2 {

class MessageReader {
  public:
    explicit MessageReader(FragmentBuilder& builder) : builder_(builder) {}

    // Reads messages from `data`, which continues where the last call stopped, and returns how many
    // bytes it consumed. `last` means that `data` holds the last bytes of a block. The reader then
    // consumes all of `data`, because messages do not cross the end of an LDM record.
    std::size_t read(std::span<const std::byte> data, bool last);

    // Tells the reader that bytes of the stream are missing here, so that it searches for a message
    // before it accepts anything.
    void lose_sync() { in_sync_ = false; }

    // Returns the offset of the next byte in the message stream, counted from the beginning of the
    // builder's fragment. 24-byte headers inside the stream count.
    [[nodiscard]] std::uint64_t offset() const { return offset_; }
    // Returns the fragment of the messages read so far. Offsets then begin at 0 again. Returns none
    // after dropped bytes until a message follows, because the damage may continue.
    [[nodiscard]] std::optional<Fragment> take_fragment();
    // Returns the limit that stopped the reader, or Failure::none if it has not stopped.
    [[nodiscard]] Fragment::Failure failure() const { return failure_; }

  private:
    // Returns the number of bytes consumed, or 0 if the reader needs more bytes to decide.
    std::size_t step(std::span<const std::byte> rest, bool last);
    std::size_t read_fill(std::span<const std::byte> rest, bool last);
    std::size_t read_message(const MessageHeader& header, std::span<const std::byte> rest,
                             bool last);
    std::size_t resynchronise(std::span<const std::byte> rest, std::size_t from, bool last,
                              std::string reason);
    // `firm` means that is_firm_radial() holds and a message surely follows.
    void take(const MessageHeader& header, std::span<const std::byte> message, Framing framing,
              bool firm);
    [[nodiscard]] bool full() const { return failure_ != Fragment::Failure::none; }
    void take_radial(const MessageHeader& header, std::span<const std::byte> message,
                     Framing framing, bool firm);
    // Returns the body of the message, expanded into `store` if it is compressed. Returns none if
    // that fails; the report then says so.
    std::optional<std::span<const std::byte>> expand(std::span<const std::byte> message,
                                                     std::vector<std::byte>& store);
    void refuse_radial(std::string_view reason, std::size_t bytes);
    void note_oddities(const MessageHeader& header, std::span<const std::byte> message,
                       const RadialMessage& radial, bool firm);
    void close_damage();

    FragmentBuilder& builder_;
    std::uint64_t offset_ = 0;
    bool in_sync_ = true;
    Fragment::Failure failure_ = Fragment::Failure::none;
    struct OpenDamage {
        std::uint64_t offset = 0;    // of the first dropped byte
        std::uint64_t found_at = 0;  // offset where a message was expected and none found
        std::uint64_t bytes = 0;
        std::string reason;
    };
    std::optional<OpenDamage> open_damage_;
};

// Feeds a MessageReader with pieces of any size, and keeps the bytes of an unfinished message.
class MessageFeed {
  public:
    explicit MessageFeed(MessageReader& reader) : reader_(reader) {}

    void append(std::span<const std::byte> bytes);
    void end();  // the block ends after the bytes appended so far

  private:
    MessageReader& reader_;
    std::vector<std::byte> held_;
};

}  // namespace stormcellar::level2
