// Writes a directory of PNG files. First makes a temporary directory beside the final place, and
// then renames it.
#include <optional>
#include <utility>

#include "base/atomic_directory.h"
#include "render/animation/animation_format.h"
#include "stormcellar/render/png_file.h"

namespace stormcellar::render {
namespace {

namespace fs = std::filesystem;

constexpr int largest_png_side = 1 << 20;

std::string frame_name(std::size_t index) {
    return fmt::format("frame_{:04}.png", index);
}

bool is_frame_name(std::string_view name) {
    constexpr std::string_view prefix = "frame_", ending = ".png";
    if (!name.starts_with(prefix) || !name.ends_with(ending)) return false;
    if (name.size() < prefix.size() + 4 + ending.size()) return false;
    name.remove_prefix(prefix.size());
    name.remove_suffix(ending.size());
    return name.find_first_not_of("0123456789") == std::string_view::npos;
}

// Refuses to replace a directory that holds anything but frames.
Status holds_only_frames(const fs::path& directory) {
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end;
         it.increment(error)) {
        const std::string name = it->path().filename();
        if (!is_frame_name(name)) {
            return fail(ErrorCode::bad_argument,
                        "holds {}, which is not a frame; name a new or empty directory", name);
        }
    }
    if (error) return fail(ErrorCode::io, "{}", error.message());
    return {};
}

class PngDirectoryWriter final : public AnimationWriter {
  public:
    PngDirectoryWriter(fs::path directory, const AnimationOptions& options, FileSystem& file_system)
        : directory_(std::move(directory)), options_(options), file_system_(&file_system) {}

    Status start() {
        auto made = AtomicDirectory::create(*file_system_, directory_, holds_only_frames);
        if (!made) return refuse(made.error());
        new_.emplace(std::move(*made));
        return {};
    }

    Status add(const Image& frame) override {
        if (error_) return tl::unexpected(*error_);
        if (count_ == 0) {
            width_ = frame.width;
            height_ = frame.height;
        }
        if (const auto fits = check_frame(frame, width_, height_, largest_png_side); !fits) {
            return refuse(fits.error());
        }
        const auto bytes = encode_png(frame, options_.metadata);
        if (!bytes) return refuse(bytes.error());
        const auto written = new_->write(frame_name(count_), *bytes);
        if (!written) return refuse(written.error());
        ++count_;
        return {};
    }

    Status finish() override {
        if (error_) return tl::unexpected(*error_);
        if (count_ == 0) return refuse({ErrorCode::bad_argument, "there is no frame to write"});
        const auto placed = new_->commit();
        if (!placed) return refuse(placed.error());
        error_ = Error{ErrorCode::bad_argument,
                       fmt::format("{}/: is finished already", directory_.native())};
        return {};
    }

  private:
    Status refuse(Error error) {
        if (!error.message.starts_with(directory_.native())) {
            error.message = fmt::format("{}/: {}", directory_.native(), error.message);
        }
        error_ = std::move(error);
        return tl::unexpected(*error_);
    }

    fs::path directory_;  // without the '/'
    AnimationOptions options_;
    FileSystem* file_system_;
    std::optional<AtomicDirectory> new_;  // none before start()
    std::optional<Error> error_;
    std::size_t count_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace

Result<std::unique_ptr<AnimationWriter>> make_png_directory_writer(const std::string& output,
                                                                   const AnimationOptions& options,
                                                                   FileSystem& file_system) {
    const auto last = output.find_last_not_of('/');
    if (last == std::string::npos) {
        return fail(ErrorCode::bad_argument, "{}: not a directory for frames", output);
    }
    auto writer =
        std::make_unique<PngDirectoryWriter>(output.substr(0, last + 1), options, file_system);
    if (auto started = writer->start(); !started) return pass_on(started);
    return writer;
}

}  // namespace stormcellar::render
