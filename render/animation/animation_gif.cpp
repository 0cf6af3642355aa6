// Writes GIF loops with giflib. FFmpeg's writer has no comments, and would add a palette to each
// frame. Netscape's application block holds the loop count. The palette is known only after the
// last frame, so frames are kept in memory, deflated, until then.
#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <utility>

#include <gif_lib.h>
#include <zlib.h>

#include "render/animation/animation_format.h"
#include "render/animation/frame_change.h"
#include "render/animation/palette.h"
#include "render/image/xmp.h"

namespace stormcellar::render {
namespace {

constexpr std::size_t most_colors = 255;  // one entry is left for "unchanged"
constexpr double gif_ticks_per_second = 100;
// Viewers ignore a shorter delay, and then show the frame slowly.
constexpr std::int64_t shortest_ticks = 2;

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

// Writes a GIF into memory with giflib. Keeps the first failure; later calls then do nothing.
class GifFile {
  public:
    GifFile() {
        int error = 0;
        file_ = EGifOpen(&bytes_, append, &error);
        if (file_ == nullptr) return;
        EGifSetGifVersion(file_, true);
        ok_ = true;
    }
    GifFile(const GifFile&) = delete;
    GifFile& operator=(const GifFile&) = delete;
    ~GifFile() {
        if (file_ != nullptr) close();
    }

    template <typename Call, typename... Arguments>
    void put(Call call, Arguments... arguments) {
        ok_ = ok_ && call(file_, arguments...) == GIF_OK;
    }

    Result<Bytes> finish() {
        const bool closed = close();
        if (!ok_ || !closed) return fail(ErrorCode::internal, "GIF: giflib cannot write the file");
        return std::move(bytes_);
    }

  private:
    static int append(GifFileType* file, const GifByteType* bytes, int count) {
        auto& all = *static_cast<Bytes*>(file->UserData);
        const auto* first = reinterpret_cast<const std::byte*>(bytes);
        all.insert(all.end(), first, first + count);
        return count;
    }
    bool close() {
        int error = 0;
        GifFileType* file = std::exchange(file_, nullptr);
        return file != nullptr && EGifCloseFile(file, &error) == GIF_OK;
    }

    Bytes bytes_;
    GifFileType* file_ = nullptr;
    bool ok_ = false;
};

struct FreeColorMap {
    void operator()(ColorMapObject* map) const { GifFreeMapObject(map); }
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
        PaletteMap map(histogram_.palette(most_colors));
        // The entry after the colors means "unchanged".
        const int as_before = static_cast<int>(map.palette().size());
        GifFile file;
        write_head(file, map.palette());
        Image frame(width_, height_, {});
        std::vector<std::uint8_t> before;
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            if (auto read = inflate_into(kept_[i], frame.rgba); !read) return pass_on(read);
            auto indices = map.indices(frame);
            write_frame(file, i, before, indices, as_before);
            before = std::move(indices);
        }
        return file.finish();
    }

  private:
    void write_head(GifFile& file, const std::vector<Rgb8>& palette) const {
        // The size of a table is a power of two. It must have room for the entry "unchanged".
        const int bits = std::max(2, static_cast<int>(std::bit_width(palette.size())));
        const std::unique_ptr<ColorMapObject, FreeColorMap> table(
            GifMakeMapObject(1 << bits, nullptr));
        if (table == nullptr) return;
        for (std::size_t i = 0; i < palette.size(); ++i)
            table->Colors[i] = {palette[i][0], palette[i][1], palette[i][2]};
        file.put(EGifPutScreenDesc, width_, height_, 8, 0, table.get());
        file.put(EGifPutExtensionLeader, APPLICATION_EXT_FUNC_CODE);
        file.put(EGifPutExtensionBlock, 11, "NETSCAPE2.0");
        file.put(EGifPutExtensionBlock, 3, "\x01\x00\x00");  // loop without end
        file.put(EGifPutExtensionTrailer);
        if (!options_.metadata.empty()) {
            file.put(EGifPutComment, text_of(options_.metadata).c_str());
        }
    }

    // Writes the rectangle that changed. Pixels in it that did not change are written as
    // "unchanged".
    void write_frame(GifFile& file, std::size_t index, const std::vector<std::uint8_t>& before,
                     const std::vector<std::uint8_t>& indices, int as_before) const {
        const bool first = before.empty();
        const Rectangle part = first ? Rectangle{0, 0, width_, height_}
                                     : changed_rectangle(before, indices, width_, height_, 1);
        const auto delay =
            frame_duration(options_, index, index + 1 == kept_.size(), gif_ticks_per_second);
        const GraphicsControlBlock control{DISPOSE_DO_NOT, false,
                                           static_cast<int>(std::max(shortest_ticks, delay)),
                                           first ? NO_TRANSPARENT_COLOR : as_before};
        std::array<GifByteType, 4> extension{};
        EGifGCBToExtension(&control, extension.data());
        file.put(EGifPutExtension, GRAPHICS_EXT_FUNC_CODE, 4, extension.data());
        file.put(EGifPutImageDesc, part.x, part.y, part.width, part.height, false, nullptr);
        std::vector<GifPixelType> row(static_cast<std::size_t>(part.width));
        for (int y = part.y; y < part.y + part.height; ++y) {
            const std::size_t start =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(part.x);
            for (std::size_t x = 0; x < row.size(); ++x) {
                const std::size_t i = start + x;
                const bool same = !first && before[i] == indices[i];
                row[x] = same ? static_cast<GifPixelType>(as_before) : indices[i];
            }
            file.put(EGifPutLine, row.data(), part.width);
        }
    }

    AnimationOptions options_;
    int width_ = 0, height_ = 0;
    ColorHistogram histogram_;
    std::vector<std::vector<std::uint8_t>> kept_;
};

}  // namespace

std::unique_ptr<FrameEncoder> make_gif_encoder(const AnimationOptions& options) {
    return std::make_unique<GifEncoder>(options);
}

}  // namespace stormcellar::render
