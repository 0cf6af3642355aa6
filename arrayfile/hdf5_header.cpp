#include "arrayfile/hdf5_header.h"

#include <algorithm>

namespace stormcellar::arrayfile {
namespace {

constexpr std::size_t most_messages = 20'000;
constexpr std::size_t most_blocks = 1'000;
constexpr std::uint8_t shared_flag = 2;

struct Block {
    std::uint64_t address = 0, length = 0;
};

class HeaderReader {
  public:
    explicit HeaderReader(const Hdf5Bytes& file) : file_(file) {}

    Result<std::vector<HeaderMessage>> read(std::uint64_t address) {
        Cursor cursor = file_.at(address);
        const bool is_new = cursor.takes("OHDR");
        if (!is_new) cursor = file_.at(address);
        const bool good = is_new ? begin_new(cursor) : begin_old(cursor);
        if (!good) return damaged("an object header");
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            if (i == most_blocks) return damaged("an object header");
            const Block block = blocks_[i];
            Cursor part = file_.at(block.address);
            if (is_new && (block.length < 8 || !part.takes("OCHK")))
                return damaged("an object header");
            const std::uint64_t length = is_new ? block.length - 8 : block.length;
            Cursor data{part.bytes(length)};
            if (part.failed() || !take(data, is_new)) return damaged("an object header");
        }
        return std::move(messages_);
    }

  private:
    bool begin_old(Cursor& cursor) {
        if (cursor.u8() != 1) return false;
        cursor.skip(1);
        cursor.skip(2 + 4);  // numbers of messages and of links
        const std::uint32_t size = cursor.u32();
        cursor.skip(4);
        // The last message may end in the padding, so a length beyond the file is cut.
        Cursor data{cursor.bytes(size)};
        return !cursor.failed() && take(data, false);
    }

    bool begin_new(Cursor& cursor) {
        if (cursor.u8() != 2) return false;
        const std::uint8_t flags = cursor.u8();
        if ((flags & 0x20) != 0) cursor.skip(16);  // times
        if ((flags & 0x10) != 0) cursor.skip(4);   // limits of the storage of attributes
        has_order_ = (flags & 0x04) != 0;
        const std::uint64_t size = cursor.number(std::size_t{1} << (flags & 3));
        Cursor data{cursor.bytes(size)};
        return !cursor.failed() && take(data, true);
    }

    // Takes the messages of one block.
    bool take(Cursor& data, bool is_new) {
        const std::size_t head = is_new ? (has_order_ ? 6U : 4U) : 8U;
        while (data.remaining() >= head) {
            HeaderMessage message;
            message.type = static_cast<MessageType>(is_new ? data.u8() : data.u16());
            const std::uint16_t size = data.u16();
            message.is_shared = (data.u8() & shared_flag) != 0;
            data.skip(head - (is_new ? 4 : 5));
            message.data = data.bytes(size);
            if (data.failed() || messages_.size() == most_messages) return false;
            if (message.type == MessageType::continuation) {
                Cursor at{message.data};
                const std::uint64_t address = file_.address(at);
                blocks_.push_back({address, file_.length(at)});
                if (at.failed()) return false;
            } else {
                messages_.push_back(message);
            }
        }
        return true;
    }

    const Hdf5Bytes& file_;
    bool has_order_ = false;
    std::vector<Block> blocks_;
    std::vector<HeaderMessage> messages_;
};

}  // namespace

Result<std::vector<HeaderMessage>> read_header(const Hdf5Bytes& file, std::uint64_t address) {
    return HeaderReader{file}.read(address);
}

}  // namespace stormcellar::arrayfile
