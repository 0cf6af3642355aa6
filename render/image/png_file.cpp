#include "stormcellar/render/png_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <span>

#include <png.h>

namespace stormcellar::render {
namespace {

struct Sink {
    std::vector<std::byte> bytes;
    std::string error;
};

void append(png_structp png, png_bytep data, png_size_t size) {
    auto& sink = *static_cast<Sink*>(png_get_io_ptr(png));
    const auto part = std::as_bytes(std::span(data, size));
    sink.bytes.insert(sink.bytes.end(), part.begin(), part.end());
}

void flush_nothing(png_structp /*png*/) {}

[[noreturn]] void remember_error(png_structp png, png_const_charp message) {
    static_cast<Sink*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

// Uses only C calls and objects without destructors, because libpng calls longjmp when it fails.
bool write_png(png_structp png, png_infop info, const Image& image, bool opaque, png_textp texts,
               int text_count) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), 8,
                 opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // For frames, this takes an eighth of the default's time and gives a sixth more bytes.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_set_compression_level(png, 1);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (text_count > 0) png_set_text(png, info, texts, text_count);
    png_write_info(png, info);
    if (opaque) png_set_filler(png, 0, PNG_FILLER_AFTER);
    const std::size_t stride = static_cast<std::size_t>(image.width) * 4;
    for (int y = 0; y < image.height; ++y) {
        png_write_row(png, image.rgba.data() + static_cast<std::size_t>(y) * stride);
    }
    png_write_end(png, info);
    return true;
}

Status check(const Image& image, const std::vector<std::pair<std::string, std::string>>& texts) {
    if (image.width < 1 || image.height < 1 ||
        image.rgba.size() !=
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4) {
        return fail(ErrorCode::bad_argument, "PNG: an image of {} by {} pixels with {} bytes",
                    image.width, image.height, image.rgba.size());
    }
    for (const auto& [keyword, text] : texts) {
        if (keyword.empty() || keyword.size() > 79) {
            return fail(ErrorCode::bad_argument, "PNG: a keyword has 1 to 79 characters, not {}",
                        keyword.size());
        }
        if (keyword.find('\0') != std::string::npos || text.find('\0') != std::string::npos) {
            return fail(ErrorCode::bad_argument, "PNG: a zero byte in the text of '{}'",
                        keyword.c_str());
        }
    }
    return {};
}

// The colors of an image, and for each pixel the number of its color.
struct Palette {
    std::vector<Rgba8> colors;
    std::vector<std::uint8_t> pixels;
};

// Finds the colors of an image. Finds none if there are more than 256.
class PaletteFinder {
  public:
    [[nodiscard]] std::optional<Palette> find(const Image& image) {
        Palette found;
        found.pixels.resize(image.rgba.size() / 4);
        std::uint32_t last = 0;
        std::uint8_t number = 0;
        for (std::size_t i = 0; i < found.pixels.size(); ++i) {
            std::uint32_t color = 0;
            std::memcpy(&color, image.rgba.data() + 4 * i, sizeof color);
            if (i == 0 || color != last) {
                const auto known = number_of(color);
                if (!known) return std::nullopt;
                number = *known;
                last = color;
            }
            found.pixels[i] = number;
        }
        for (const std::uint32_t color : colors_)
            found.colors.push_back(std::bit_cast<Rgba8>(color));
        return found;
    }

  private:
    static constexpr std::size_t slots = 1024;  // size of a hash table with open addressing

    std::optional<std::uint8_t> number_of(std::uint32_t color) {
        for (std::size_t slot = (color * 2654435761U) >> 22;; slot = (slot + 1) % slots) {
            if (table_[slot] == 0) {
                if (colors_.size() == 256) return std::nullopt;
                colors_.push_back(color);
                table_[slot] = static_cast<std::uint16_t>(colors_.size());
            }
            const std::size_t number = table_[slot] - 1U;
            if (colors_[number] == color) return static_cast<std::uint8_t>(number);
        }
    }

    std::array<std::uint16_t, slots> table_{};  // 0: free, else the color's number plus one
    std::vector<std::uint32_t> colors_;
};

struct PaletteChunks {
    std::array<png_color, 256> colors{};
    std::array<png_byte, 256> alphas{};
    int count = 0;
};

PaletteChunks chunks_of(const Palette& palette) {
    PaletteChunks chunks;
    chunks.count = static_cast<int>(palette.colors.size());
    for (std::size_t i = 0; i < palette.colors.size(); ++i) {
        const auto& [red, green, blue, alpha] = palette.colors[i];
        chunks.colors[i] = {red, green, blue};
        chunks.alphas[i] = alpha;
    }
    return chunks;
}

int bits_for(int colors) {
    return colors <= 2 ? 1 : colors <= 4 ? 2 : colors <= 16 ? 4 : 8;
}

// Uses only C calls and objects without destructors, like write_png().
bool write_palette_png(png_structp png, png_infop info, int width, int height,
                       const PaletteChunks& chunks, const std::uint8_t* pixels) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                 bits_for(chunks.count), PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_level(png, 2);
    png_set_PLTE(png, info, chunks.colors.data(), chunks.count);
    png_set_tRNS(png, info, chunks.alphas.data(), chunks.count, nullptr);
    png_write_info(png, info);
    png_set_packing(png);
    for (int y = 0; y < height; ++y)
        png_write_row(png, pixels + static_cast<std::size_t>(y) * static_cast<std::size_t>(width));
    png_write_end(png, info);
    return true;
}

// A writer that is destroyed with its scope. `png` is null if libpng does not start.
class PngWriter {
  public:
    PngWriter()
        : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, remember_error,
                                      ignore_warning)),
          info(png == nullptr ? nullptr : png_create_info_struct(png)) {
        if (info != nullptr) png_set_write_fn(png, &sink, append, flush_nothing);
    }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }

    [[nodiscard]] bool has_started() const { return info != nullptr; }

    Sink sink;
    png_structp png;
    png_infop info;
};

}  // namespace

Result<std::vector<std::byte>> encode_png(
    const Image& image, const std::vector<std::pair<std::string, std::string>>& texts,
    PngAlpha alpha) {
    if (auto checked = check(image, texts); !checked) return pass_on(checked);

    std::vector<png_text> chunks;
    for (const auto& [keyword, text] : texts) {
        png_text chunk{};
        chunk.compression = PNG_TEXT_COMPRESSION_NONE;
        // libpng only reads the text, although its structure does not say const.
        chunk.key = const_cast<png_charp>(keyword.c_str());
        chunk.text = const_cast<png_charp>(text.c_str());
        chunk.text_length = text.size();
        chunks.push_back(chunk);
    }

    PngWriter writer;
    if (!writer.has_started()) return fail(ErrorCode::internal, "PNG: libpng does not start");
    bool opaque = alpha == PngAlpha::when_needed;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        opaque = opaque && image.rgba[i] == 255;
    if (!write_png(writer.png, writer.info, image, opaque, chunks.data(),
                   static_cast<int>(chunks.size())))
        return fail(ErrorCode::internal, "PNG: {}", writer.sink.error);
    return std::move(writer.sink.bytes);
}

Result<std::vector<std::byte>> encode_png_of_few_colors(const Image& image) {
    if (auto checked = check(image, {}); !checked) return pass_on(checked);
    const auto palette = PaletteFinder().find(image);
    if (!palette) return encode_png(image, {}, PngAlpha::always);
    const PaletteChunks chunks = chunks_of(*palette);
    PngWriter writer;
    if (!writer.has_started()) return fail(ErrorCode::internal, "PNG: libpng does not start");
    if (!write_palette_png(writer.png, writer.info, image.width, image.height, chunks,
                           palette->pixels.data()))
        return fail(ErrorCode::internal, "PNG: {}", writer.sink.error);
    return std::move(writer.sink.bytes);
}

}  // namespace stormcellar::render
