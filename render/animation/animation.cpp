#include "stormcellar/render/animation.h"

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include "base/floating_point.h"
#include "render/animation/animation_format.h"
#include "render/image/check_size.h"

namespace stormcellar::render {
namespace {

using MakeEncoder = Result<std::unique_ptr<FrameEncoder>> (*)(const AnimationOptions&);

template <std::unique_ptr<FrameEncoder> (*make)(const AnimationOptions&)>
Result<std::unique_ptr<FrameEncoder>> make_built_in(const AnimationOptions& options) {
    return make(options);
}

// Returns the function that makes a video encoder; null if this build has no videos.
template <VideoContainer container>
constexpr MakeEncoder make_video() {
#if STORMCELLAR_VIDEO
    return [](const AnimationOptions& options) { return make_video_encoder(container, options); };
#else
    return nullptr;
#endif
}

struct Format {
    std::string_view ending;
    MakeEncoder make;
};

constexpr std::array formats{
    Format{".webp", make_built_in<make_webp_encoder>},
    Format{".gif", make_built_in<make_gif_encoder>},
    Format{".apng", make_built_in<make_apng_encoder>},
    Format{".mp4", make_video<VideoContainer::mp4>()},
    Format{".webm", make_video<VideoContainer::webm>()},
};

// Puts the name of the output before the error's message, unless the message begins with it.
Error named(const std::string& output, Error error) {
    if (!error.message.starts_with(output)) {
        error.message = fmt::format("{}: {}", output, error.message);
    }
    return error;
}

// Writes one file. Writes the encoder's bytes when they are complete.
class FileWriter final : public AnimationWriter {
  public:
    FileWriter(std::string output, std::unique_ptr<FrameEncoder> encoder, FileSystem& file_system)
        : output_(std::move(output)), encoder_(std::move(encoder)), file_system_(&file_system) {}

    Status add(const Image& frame) override {
        return unless_failed([&]() -> Status {
            if (count_ == 0) {
                width_ = frame.width;
                height_ = frame.height;
            }
            if (auto fits = check_frame(frame, width_, height_, encoder_->largest_side()); !fits) {
                return fits;
            }
            ++count_;
            return encoder_->add(frame);
        });
    }

    Status finish() override {
        return unless_failed([&]() -> Status {
            if (finished_) return fail(ErrorCode::bad_argument, "is finished already");
            if (count_ == 0) return fail(ErrorCode::bad_argument, "there is no frame to write");
            finished_ = true;
            const auto bytes = encoder_->finish();
            if (!bytes) return pass_on(bytes);
            return write_file_atomically(*file_system_, output_, *bytes);
        });
    }

  private:
    Status unless_failed(const std::function<Status()>& work) {
        if (!error_) {
            if (auto status = work(); !status) error_ = named(output_, status.error());
        }
        if (error_) return tl::unexpected(*error_);
        return {};
    }

    std::string output_;
    std::unique_ptr<FrameEncoder> encoder_;
    FileSystem* file_system_;
    std::optional<Error> error_;
    std::size_t count_ = 0;
    int width_ = 0, height_ = 0;
    bool finished_ = false;
};

Status check(const AnimationOptions& options) {
    // NaN is outside of every range.
    const auto outside = [](double value, NumberRange range) {
        return !is_within(value, range.least, range.most);
    };
    if (const NumberRange range = limits::frames_per_second;
        outside(options.frames_per_second, range)) {
        return fail(ErrorCode::bad_argument, "frames per second must be {} to {}, not {}",
                    range.least, range.most, options.frames_per_second);
    }
    if (const NumberRange range = limits::last_frame_dwell_s;
        outside(options.last_frame_dwell_s, range)) {
        return fail(ErrorCode::bad_argument, "the last frame's dwell must be {} to {} s, not {}",
                    range.least, range.most, options.last_frame_dwell_s);
    }
    for (const auto& [keyword, text] : options.metadata) {
        if (keyword.empty() || keyword.size() > 79 || keyword.find('\0') != std::string::npos ||
            text.find('\0') != std::string::npos) {
            return fail(ErrorCode::bad_argument,
                        "metadata has keywords of 1 to 79 characters and no zero bytes");
        }
    }
    return {};
}

// Checks that the file can be created. For that, creates a temporary file beside it and removes it
// again.
Status probe(const std::string& output, FileSystem& file_system) {
    std::error_code ignored;
    if (std::filesystem::is_directory(output, ignored)) {
        return fail(ErrorCode::not_a_file, "{}: is a directory", output);
    }
    const auto parent = std::filesystem::path(output).parent_path();
    if (!parent.empty() && !std::filesystem::exists(parent, ignored)) {
        return fail(ErrorCode::not_found, "{}: there is no directory {}", output, parent.native());
    }
    const auto file = AtomicFile::create(file_system, output);
    if (!file) return tl::unexpected(named(output, file.error()));
    return {};
}

}  // namespace

std::string known_animation_endings() {
    std::string list;
    for (const Format& format : formats) {
        if (format.make != nullptr) list += fmt::format("{}, ", format.ending);
    }
    return list + "or DIR/ for PNG files";
}

Status check_animation_name(const std::string& output) {
    const std::string ending = std::filesystem::path(output).extension();
    if (output.ends_with('/')) return {};
    for (const Format& format : formats) {
        if (ending == format.ending) return {};
    }
    std::error_code ignored;
    if (std::filesystem::is_directory(output, ignored)) {
        return fail(ErrorCode::bad_argument,
                    "{0}: is a directory; name it {0}/ to write PNG files into it", output);
    }
    return fail(ErrorCode::bad_argument, "{}: the ending '{}' is not known; this build writes {}",
                output, ending, known_animation_endings());
}

Result<std::unique_ptr<AnimationWriter>> AnimationWriter::create(const std::string& output,
                                                                 const AnimationOptions& options,
                                                                 FileSystem& file_system) {
    if (auto valid = check(options); !valid) return pass_on(valid);
    if (auto valid = check_animation_name(output); !valid) return pass_on(valid);
    if (output.ends_with('/')) return make_png_directory_writer(output, options, file_system);
    const std::string ending = std::filesystem::path(output).extension();
    for (const Format& format : formats) {
        if (ending != format.ending || format.make == nullptr) continue;
        if (auto writable = probe(output, file_system); !writable) return pass_on(writable);
        auto encoder = format.make(options);
        if (!encoder) return tl::unexpected(named(output, encoder.error()));
        return std::make_unique<FileWriter>(output, std::move(*encoder), file_system);
    }
    return fail(ErrorCode::bad_argument,
                "{}: this build has no FFmpeg (STORMCELLAR_VIDEO), so it only writes {}", output,
                known_animation_endings());
}

Status check_frame(const Image& frame, int first_width, int first_height, int largest_side) {
    if (auto fits = check_size(frame, largest_side, "frame"); !fits) return fits;
    if (frame.width != first_width || frame.height != first_height) {
        return fail(ErrorCode::bad_argument,
                    "a frame of {} by {} pixels cannot follow one of {} by {}", frame.width,
                    frame.height, first_width, first_height);
    }
    return {};
}

std::int64_t frame_start(const AnimationOptions& options, std::size_t index,
                         double ticks_per_second) {
    return std::llround(static_cast<double>(index) * ticks_per_second / options.frames_per_second);
}

std::int64_t frame_duration(const AnimationOptions& options, std::size_t index, bool last,
                            double ticks_per_second) {
    const auto dwell = last ? std::llround(options.last_frame_dwell_s * ticks_per_second) : 0;
    return frame_start(options, index + 1, ticks_per_second) -
           frame_start(options, index, ticks_per_second) + dwell;
}

}  // namespace stormcellar::render
