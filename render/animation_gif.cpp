// GIF, straight: FFmpeg's writer has no comments and would bring a palette a frame.
// Source: GIF89a specification (CompuServe 1990); the loop count is Netscape's application block.
//
// The palette is known when the last frame is, so until then frames are held, deflated.
#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>

#include <zlib.h>

#include "render/animation_format.h"
#include "render/frame_change.h"
#include "render/gif_lzw.h"
#include "render/palette.h"

namespace stormcellar::render {
namespace {

constexpr std::size_t most_colours = 255;  // one entry is left for "as before"
constexpr double ticks_per_second = 100;
constexpr std::int64_t shortest_ticks = 2;  // viewers take less for "unset" and show it slowly

using Bytes = std::vector<std::byte>;

Result<std::vector<std::uint8_t>> deflated(const std::vector<std::uint8_t>& bytes) {
    uLongf size = compressBound(bytes.size());
    std::vector<std::uint8_t> packed(size);
    if (compress2(packed.data(), &size, bytes.data(), bytes.size(), Z_BEST_SPEED) != Z_OK) {
        return fail(ErrorCode::internal, "GIF: a frame cannot be kept");
    }
    packed.resize(size);
    packed.shrink_to_fit();
    return packed;
}

Status inflate_into(const std::vector<std::uint8_t>& packed, std::vector<std::uint8_t>& bytes) {
    uLongf size = bytes.size();
    if (uncompress(bytes.data(), &size, packed.data(), packed.size()) != Z_OK ||
        size != bytes.size()) {
        return fail(ErrorCode::internal, "GIF: a kept frame cannot be read");
    }
    return {};
}

class Writer {
  public:
    void u8(std::size_t value) { bytes_.push_back(static_cast<std::byte>(value)); }
    void u16(std::int64_t value) {
        u8(static_cast<std::size_t>(value & 0xFF));
        u8(static_cast<std::size_t>((value >> 8) & 0xFF));
    }
    void text(std::string_view text) {
        for (const char c : text)
            u8(static_cast<unsigned char>(c));
    }
    void comment(std::string_view comment) {
        u8(0x21);
        u8(0xFE);
        while (!comment.empty()) {
            const auto part = comment.substr(0, 255);
            u8(part.size());
            text(part);
            comment.remove_prefix(part.size());
        }
        u8(0);
    }
    [[nodiscard]] Bytes& bytes() { return bytes_; }

  private:
    Bytes bytes_;
};

class GifEncoder final : public FrameEncoder {
  public:
    explicit GifEncoder(const AnimationOptions& options) : options_(options) {}

    [[nodiscard]] int largest_side() const override { return 65535; }

    Status add(const Image& frame) override {
        width_ = frame.width;
        height_ = frame.height;
        histogram_.add(frame);
        auto kept = deflated(frame.rgba);
        if (!kept) return pass_on(kept);
        kept_.push_back(std::move(*kept));
        return {};
    }

    Result<Bytes> finish() override {
        PaletteMap map(histogram_.palette(most_colours));
        // The entry after the colours stands for "as before"; the table's size is a power of two.
        const int index_bits = std::max(2, static_cast<int>(std::bit_width(map.palette().size())));
        Writer file;
        write_head(file, map.palette(), index_bits);
        Image frame(width_, height_, {});
        std::vector<std::uint8_t> before;
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            if (auto read = inflate_into(kept_[i], frame.rgba); !read) return pass_on(read);
            auto indices = map.indices(frame);
            write_frame(file, i, before, indices, index_bits,
                        static_cast<std::uint8_t>(map.palette().size()));
            before = std::move(indices);
        }
        file.u8(0x3B);
        return std::move(file.bytes());
    }

  private:
    void write_head(Writer& file, const std::vector<Rgb8>& palette, int index_bits) const {
        file.text("GIF89a");
        file.u16(width_);
        file.u16(height_);
        file.u8(0xF0U | static_cast<unsigned>(index_bits - 1));  // global table, 8 bits a channel
        file.u8(0);                                              // background
        file.u8(0);                                              // square pixels
        for (std::size_t i = 0; i < (std::size_t{1} << index_bits); ++i) {
            for (const std::uint8_t channel : i < palette.size() ? palette[i] : Rgb8{})
                file.u8(channel);
        }
        file.u8(0x21);
        file.u8(0xFF);
        file.u8(11);
        file.text("NETSCAPE2.0");
        file.u8(3);
        file.u8(1);
        file.u16(0);  // for ever
        file.u8(0);
        if (!options_.metadata.empty()) file.comment(metadata_text(options_));
    }

    // The changed rectangle, with what did not change in it left out.
    void write_frame(Writer& file, std::size_t index, const std::vector<std::uint8_t>& before,
                     const std::vector<std::uint8_t>& indices, int index_bits,
                     std::uint8_t as_before) const {
        const bool first = before.empty();
        const Rectangle part = first ? Rectangle{0, 0, width_, height_}
                                     : changed_rectangle(before, indices, width_, height_, 1);
        const auto delay =
            frame_duration(options_, index, index + 1 == kept_.size(), ticks_per_second);
        file.u8(0x21);
        file.u8(0xF9);
        file.u8(4);
        file.u8(first ? 0x04 : 0x05);  // leave it standing; with or without transparency
        file.u16(std::max(shortest_ticks, delay));
        file.u8(first ? 0 : as_before);
        file.u8(0);
        file.u8(0x2C);
        file.u16(part.x);
        file.u16(part.y);
        file.u16(part.width);
        file.u16(part.height);
        file.u8(0);  // no table of its own, rows in order
        std::vector<std::uint8_t> pixels;
        for (int y = part.y; y < part.y + part.height; ++y) {
            for (int x = part.x; x < part.x + part.width; ++x) {
                const std::size_t i =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x);
                pixels.push_back(!first && before[i] == indices[i] ? as_before : indices[i]);
            }
        }
        append_gif_lzw(pixels, index_bits, file.bytes());
    }

    AnimationOptions options_;
    int width_ = 0, height_ = 0;
    ColourHistogram histogram_;
    std::vector<std::vector<std::uint8_t>> kept_;
};

}  // namespace

std::unique_ptr<FrameEncoder> make_gif_encoder(const AnimationOptions& options) {
    return std::make_unique<GifEncoder>(options);
}

}  // namespace stormcellar::render
