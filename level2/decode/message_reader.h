// level2/decode/message_reader.h -- walks a stream of messages and keeps what is whole.
//
// A message counts only when the next one begins where it ends (or the data end there). Where that
// fails the reader searches for the next place at which a message surely begins; if that lies
// inside the message before, bytes of it are lost, and it is dropped too: never half a radial.
// Where it holds, a radial is kept whatever is odd about it, but for what makes its gates
// unreadable (docs/level2.md has the table): strictness is for searching after damage.
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

    // Reads messages from the start of `data`, which goes on from where the last call stopped, and
    // says how many bytes are done with. With `last`, `data` are a block's last bytes (messages do
    // not go over the end of an LDM record): all of it is then done with.
    std::size_t read(std::span<const std::byte> data, bool last);

    // Bytes of the stream are missing here: search before anything else is believed.
    void lose_sync() { in_sync_ = false; }

    // Where the next byte stands in the message stream (24-byte headers inside it included),
    // counted from where the builder's fragment begins.
    [[nodiscard]] std::uint64_t offset() const { return offset_; }
    // The fragment up to here, which no damage reaches beyond: none while damage is open. Offsets
    // count from here afterwards.
    [[nodiscard]] std::optional<Fragment> take_fragment();
    // Why no more is read: the fragment would exceed a limit. Else none.
    [[nodiscard]] Fragment::Failure failure() const { return failure_; }

  private:
    // Bytes done with; 0 where more are needed to decide.
    std::size_t step(std::span<const std::byte> rest, bool last);
    std::size_t read_fill(std::span<const std::byte> rest, bool last);
    std::size_t read_message(const MessageHeader& header, std::span<const std::byte> rest,
                             bool last);
    std::size_t resynchronise(std::span<const std::byte> rest, std::size_t from, bool last,
                              std::string reason);
    // `firm`: a radial agrees with its header.
    void take(const MessageHeader& header, std::span<const std::byte> message, Framing framing,
              bool firm);
    [[nodiscard]] bool full() const { return failure_ != Fragment::Failure::none; }
    void take_radial(const MessageHeader& header, std::span<const std::byte> message,
                     Framing framing, bool firm);
    // The message's body, expanded into `store` where it is compressed; none where that fails,
    // which is in the report then.
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
        std::uint64_t offset = 0;    // of the first byte dropped
        std::uint64_t found_at = 0;  // where a message was due and none was
        std::uint64_t bytes = 0;
        std::string reason;
    };
    std::optional<OpenDamage> open_damage_;
};

// Feeds a MessageReader from pieces that are cut anywhere. Holds back less than one message.
class MessageFeed {
  public:
    explicit MessageFeed(MessageReader& reader) : reader_(reader) {}

    void append(std::span<const std::byte> bytes);
    void end();  // what was held back is the last of a block

  private:
    MessageReader& reader_;
    std::vector<std::byte> held_;
};

}  // namespace stormcellar::level2
