// An APNG file is a PNG file with further frames in private chunks. stormcellar/render/png_file.h
// encodes each frame as a picture of its own, and the code here takes that picture apart again.
//
// Source: W3C PNG specification, third edition, sections 5.6 and 11.3.6 (acTL, fcTL, fdAT).
#include <algorithm>
#include <optional>
#include <span>
#include <string_view>

#include "base/byte_reader.h"
#include "base/checksum.h"
#include "render/animation/animation_format.h"
#include "render/animation/frame_change.h"
#include "stormcellar/render/png_file.h"

namespace stormcellar::render {
namespace {

constexpr double apng_ticks_per_second = 500;  // delays have 16 bits: at most 131 s
constexpr std::uint8_t dispose_none = 0, blend_source = 0, blend_over = 1;

using Bytes = std::vector<std::byte>;

class Writer {
  public:
    void u8(std::uint8_t value) { bytes_.push_back(std::byte{value}); }
    void u16(std::uint32_t value) {
        u8(static_cast<std::uint8_t>(value >> 8));
        u8(static_cast<std::uint8_t>(value));
    }
    void u32(std::uint32_t value) {
        u16(value >> 16);
        u16(value & 0xFFFF);
    }
    void append(std::span<const std::byte> more) {
        bytes_.insert(bytes_.end(), more.begin(), more.end());
    }
    // Writes a chunk: length, type, data, and the CRC of type and data.
    void chunk(std::string_view type, std::span<const std::byte> data) {
        u32(static_cast<std::uint32_t>(data.size()));
        const auto name = std::as_bytes(std::span(type.data(), type.size()));
        append(name);
        append(data);
        u32(crc32(data, crc32(name)));
    }
    [[nodiscard]] Bytes take() { return std::move(bytes_); }

  private:
    Bytes bytes_;
};

// Returns the part of a picture that is inside a rectangle.
Image cut(const Image& frame, const Rectangle& part) {
    Image image(part.width, part.height, {});
    for (int y = 0; y < part.height; ++y) {
        const auto* row = frame.rgba.data() + (static_cast<std::size_t>(part.y + y) *
                                                   static_cast<std::size_t>(frame.width) +
                                               static_cast<std::size_t>(part.x)) *
                                                  4;
        std::copy_n(row, static_cast<std::size_t>(part.width) * 4,
                    image.rgba.data() +
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) * 4);
    }
    return image;
}

bool opaque(const Image& image) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        if (image.rgba[i] != 255) return false;
    }
    return true;
}

// Makes the pixels that did not change transparent, because equal pixels compress to almost
// nothing.
void clear_unchanged(Image& part, const Image& before) {
    for (std::size_t i = 0; i < part.rgba.size(); i += 4) {
        const auto pixel = std::span(part.rgba).subspan(i, 4);
        if (std::ranges::equal(pixel, std::span(before.rgba).subspan(i, 4))) {
            std::ranges::fill(pixel, std::uint8_t{0});
        }
    }
}

struct Frame {
    Rectangle part;
    std::uint8_t blend = blend_source;
    Bytes data;  // content of the chunk IDAT or fdAT
};

class ApngEncoder final : public FrameEncoder {
  public:
    explicit ApngEncoder(const AnimationOptions& options) : options_(options) {}

    [[nodiscard]] int largest_side() const override { return 1 << 20; }

    Status add(const Image& image) override {
        Frame frame;
        frame.part = {0, 0, image.width, image.height};
        Image picture = image;
        if (!frames_.empty()) {
            frame.part = changed_rectangle(before_.rgba, image.rgba, image.width, image.height, 4);
            picture = cut(image, frame.part);
            if (opaque(picture)) {
                clear_unchanged(picture, cut(before_, frame.part));
                frame.blend = blend_over;
            }
        }
        // All frames share one header, so even an opaque frame must keep its alpha.
        const auto png = encode_png(picture, frames_.empty() ? options_.metadata : no_metadata_,
                                    PngAlpha::always);
        if (!png) return pass_on(png);
        frame.data = take_apart(*png);
        frames_.push_back(std::move(frame));
        before_ = image;
        return {};
    }

    Result<Bytes> finish() override {
        Writer file;
        file.append(head_);
        Writer control;
        control.u32(static_cast<std::uint32_t>(frames_.size()));
        control.u32(0);  // number of plays; 0: without end
        file.chunk("acTL", control.take());
        file.append(before_data_);
        std::uint32_t sequence = 0;
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            file.chunk("fcTL", frame_control(i, sequence++));
            if (i == 0) {
                file.chunk("IDAT", frames_[i].data);
                continue;
            }
            Writer data;
            data.u32(sequence++);
            data.append(frames_[i].data);
            file.chunk("fdAT", data.take());
        }
        file.chunk("IEND", {});
        return file.take();
    }

  private:
    // Returns the image data of a PNG file in one piece. For the first frame, also keeps the other
    // chunks: signature and header, which come before acTL, and what else comes before the data.
    Bytes take_apart(std::span<const std::byte> png) {
        constexpr std::size_t signature_size = 8;
        Bytes data;
        ByteReader reader(png);
        reader.skip(signature_size);
        while (reader.remaining() > 0 && !reader.failed()) {
            const std::size_t start = reader.position();
            const std::uint32_t length = reader.u32();
            const std::string_view type = reader.text(4);
            const auto content = reader.bytes(length);
            reader.skip(4);
            const auto whole = png.subspan(start, reader.position() - start);
            if (type == "IDAT") {
                data.insert(data.end(), content.begin(), content.end());
            } else if (frames_.empty() && type == "IHDR") {
                const auto head = png.first(reader.position());
                head_.assign(head.begin(), head.end());
            } else if (frames_.empty() && type != "IEND") {
                before_data_.insert(before_data_.end(), whole.begin(), whole.end());
            }
        }
        return data;
    }

    [[nodiscard]] Bytes frame_control(std::size_t index, std::uint32_t sequence) const {
        const Frame& frame = frames_[index];
        const auto delay =
            frame_duration(options_, index, index + 1 == frames_.size(), apng_ticks_per_second);
        Writer control;
        control.u32(sequence);
        control.u32(static_cast<std::uint32_t>(frame.part.width));
        control.u32(static_cast<std::uint32_t>(frame.part.height));
        control.u32(static_cast<std::uint32_t>(frame.part.x));
        control.u32(static_cast<std::uint32_t>(frame.part.y));
        control.u16(static_cast<std::uint32_t>(delay));
        control.u16(static_cast<std::uint32_t>(apng_ticks_per_second));
        control.u8(dispose_none);
        control.u8(frame.blend);
        return control.take();
    }

    AnimationOptions options_;
    const std::vector<std::pair<std::string, std::string>> no_metadata_;
    Bytes head_, before_data_;
    std::vector<Frame> frames_;
    Image before_;
};

}  // namespace

std::unique_ptr<FrameEncoder> make_apng_encoder(const AnimationOptions& options) {
    return std::make_unique<ApngEncoder>(options);
}

}  // namespace stormcellar::render
