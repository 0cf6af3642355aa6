// Writes a directory of PNG files. First makes a temporary directory beside it, and then renames
// that.
#include <atomic>
#include <optional>

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

// A directory with a unique name. It is removed with all its files unless keep() is called.
class TemporaryTree {
  public:
    explicit TemporaryTree(const fs::path& beside) {
        static std::atomic<std::uint64_t> counter{0};
        path_ = beside.parent_path() /
                fmt::format("{}frames-{}", own_temporary_prefix(), counter.fetch_add(1));
    }
    TemporaryTree(const TemporaryTree&) = delete;
    TemporaryTree& operator=(const TemporaryTree&) = delete;
    ~TemporaryTree() {
        std::error_code ignored;
        if (made_) fs::remove_all(path_, ignored);
    }
    Status make() {
        std::error_code error;
        made_ = fs::create_directory(path_, error);
        if (made_) return {};
        if (!error) return fail(ErrorCode::io, "{} is in the way", path_.native());
        const bool missing = error == std::errc::no_such_file_or_directory;
        const bool denied =
            error == std::errc::permission_denied || error == std::errc::read_only_file_system;
        const auto code = missing  ? ErrorCode::not_found
                          : denied ? ErrorCode::permission
                                   : ErrorCode::io;
        return fail(code, "{}", error.message());
    }
    void own() { made_ = true; }    // the directory was made elsewhere
    void keep() { made_ = false; }  // the directory has its final name now
    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
    bool made_ = false;
};

enum class Target { absent, replaceable };

// Finds out whether the name is free. If it is a directory, finds out whether it holds only frames.
Result<Target> look_at(const fs::path& directory) {
    std::error_code error;
    const auto status = fs::symlink_status(directory, error);
    if (status.type() == fs::file_type::not_found) return Target::absent;
    if (status.type() != fs::file_type::directory) {
        return fail(ErrorCode::not_a_file, "exists and is not a directory");
    }
    for (fs::directory_iterator it(directory, error), end; !error && it != end;
         it.increment(error)) {
        const std::string name = it->path().filename();
        if (!is_frame_name(name)) {
            return fail(ErrorCode::bad_argument,
                        "holds {}, which is not a frame; name a new or empty directory", name);
        }
    }
    if (error) return fail(ErrorCode::io, "{}", error.message());
    return Target::replaceable;
}

class PngDirectoryWriter final : public AnimationWriter {
  public:
    PngDirectoryWriter(fs::path directory, const AnimationOptions& options, FileSystem& file_system)
        : directory_(std::move(directory)),
          options_(options),
          file_system_(&file_system),
          new_(directory_) {}

    Status start() {
        if (const auto target = look_at(directory_); !target) return refuse(target.error());
        if (const auto made = new_.make(); !made) return refuse(made.error());
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
        const auto written =
            write_file_atomically(*file_system_, new_.path() / frame_name(count_), *bytes);
        if (!written) return refuse(written.error());
        ++count_;
        return {};
    }

    Status finish() override {
        if (error_) return tl::unexpected(*error_);
        if (count_ == 0) return refuse({ErrorCode::bad_argument, "there is no frame to write"});
        const auto placed = place();
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

    // Moves the old directory aside, and the new one into its place. If the second step fails,
    // moves the old directory back.
    Status place() {
        const auto target = look_at(directory_);
        if (!target) return pass_on(target);
        TemporaryTree old(directory_);
        if (*target == Target::replaceable) {
            if (auto moved = file_system_->rename(directory_, old.path()); !moved) return moved;
        }
        if (auto moved = file_system_->rename(new_.path(), directory_); !moved) {
            if (*target == Target::replaceable) (void)file_system_->rename(old.path(), directory_);
            return moved;
        }
        new_.keep();
        if (*target == Target::replaceable) old.own();
        const fs::path parent = directory_.parent_path();
        return file_system_->sync_directory(parent.empty() ? fs::path{"."} : parent);
    }

    fs::path directory_;  // without the '/'
    AnimationOptions options_;
    FileSystem* file_system_;
    TemporaryTree new_;
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
