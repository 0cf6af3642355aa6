#include "render/gif_lzw.h"

#include <algorithm>

namespace stormcellar::render {
namespace {

constexpr int largest_width = 12;
constexpr std::uint32_t code_limit = 1U << largest_width;

// Codes of any width, low bits first, cut into sub-blocks.
class CodeWriter {
  public:
    explicit CodeWriter(std::vector<std::byte>& out) : out_(&out) {}

    void put(std::uint32_t code, int width) {
        bits_ |= code << bit_count_;
        bit_count_ += width;
        while (bit_count_ >= 8) {
            byte(static_cast<std::uint8_t>(bits_));
            bits_ >>= 8;
            bit_count_ -= 8;
        }
    }
    void finish() {
        if (bit_count_ > 0) byte(static_cast<std::uint8_t>(bits_));
        end_block();
        out_->push_back(std::byte{0});
    }

  private:
    void byte(std::uint8_t value) {
        block_.push_back(std::byte{value});
        if (block_.size() == 255) end_block();
    }
    void end_block() {
        if (block_.empty()) return;
        out_->push_back(std::byte{static_cast<std::uint8_t>(block_.size())});
        out_->insert(out_->end(), block_.begin(), block_.end());
        block_.clear();
    }

    std::vector<std::byte>* out_;
    std::vector<std::byte> block_;
    std::uint32_t bits_ = 0;
    int bit_count_ = 0;
};

// Strings seen: (code of the string without its last index, last index) -> code. A hash table of
// four times the number of codes, so that it never fills.
class Dictionary {
  public:
    Dictionary() : slots_(code_limit * 4) {}

    void clear() { std::ranges::fill(slots_, Slot{}); }

    // The code of the longer string; when there is none, it is entered with `code` and none given.
    static constexpr std::uint32_t none = 0xFFFFFFFF;
    std::uint32_t find_or_enter(std::uint32_t prefix, std::uint8_t index, std::uint32_t code) {
        const std::uint32_t key = (prefix << 8) | index;
        std::size_t place = (key * 2654435761U) >> 18;  // 14 bits
        while (slots_[place].key != none) {
            if (slots_[place].key == key) return slots_[place].code;
            place = (place + 1) % slots_.size();
        }
        slots_[place] = {key, code};
        return none;
    }

  private:
    struct Slot {
        std::uint32_t key = none;
        std::uint32_t code = 0;
    };
    std::vector<Slot> slots_;
};

}  // namespace

void append_gif_lzw(std::span<const std::uint8_t> indices, int index_bits,
                    std::vector<std::byte>& out) {
    const std::uint32_t clear_code = 1U << index_bits;
    const std::uint32_t end_code = clear_code + 1;
    out.push_back(static_cast<std::byte>(index_bits));
    CodeWriter writer(out);
    Dictionary dictionary;
    int width = index_bits + 1;
    std::uint32_t next = end_code + 1;
    writer.put(clear_code, width);
    if (!indices.empty()) {
        std::uint32_t prefix = indices.front();
        for (const std::uint8_t index : indices.subspan(1)) {
            const std::uint32_t longer = dictionary.find_or_enter(prefix, index, next);
            if (longer != Dictionary::none) {
                prefix = longer;
                continue;
            }
            writer.put(prefix, width);
            prefix = index;
            if (next == code_limit) {
                writer.put(clear_code, width);
                dictionary.clear();
                width = index_bits + 1;
                next = end_code + 1;
                continue;
            }
            // The reader enters each string one code later than we do.
            if (next == (1U << width) && width < largest_width) ++width;
            ++next;
        }
        writer.put(prefix, width);
        if (next == (1U << width) && width < largest_width) ++width;
    }
    writer.put(end_code, width);
    writer.finish();
}

}  // namespace stormcellar::render
