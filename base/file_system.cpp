#include "stormcellar/base/file_system.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/host_name.h"
#include "base/system_error.h"
#include "stormcellar/base/descriptor.h"

namespace stormcellar {
namespace {

class RealFileSystem final : public FileSystem {
  public:
    Result<int> create_exclusive(const std::filesystem::path& path) override {
        const int descriptor =
            ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0644);
        if (descriptor < 0) return system_failure(path.native(), errno);
        return descriptor;
    }

    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override {
        while (!bytes.empty()) {
            const ssize_t n =
                ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) return system_failure("write", errno);
            bytes = bytes.subspan(static_cast<std::size_t>(n));
            offset += static_cast<std::uint64_t>(n);
        }
        return {};
    }

    Status set_size(int descriptor, std::uint64_t size) override {
        if (::ftruncate(descriptor, static_cast<off_t>(size)) != 0) {
            return system_failure("set size", errno);
        }
        return {};
    }

    Status sync(int descriptor) override {
        if (::fsync(descriptor) != 0) return system_failure("sync", errno);
        return {};
    }

    void close(int descriptor) override { ::close(descriptor); }

    Status rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        if (::rename(from.c_str(), to.c_str()) != 0) return system_failure(to.native(), errno);
        return {};
    }

    Status sync_directory(const std::filesystem::path& directory) override {
        const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (descriptor < 0) return system_failure(directory.native(), errno);
        const int result = ::fsync(descriptor);
        const int error_number = errno;
        ::close(descriptor);
        if (result != 0) return system_failure(directory.native(), error_number);
        return {};
    }

    Status remove(const std::filesystem::path& path) override {
        if (::unlink(path.c_str()) != 0) return system_failure(path.native(), errno);
        return {};
    }
};

// Returns a unique name, which contains the host's name, the process id and a counter, because
// several hosts may share a directory.
std::filesystem::path temporary_name(const std::filesystem::path& final_path) {
    static std::atomic<std::uint64_t> counter{0};
    return final_path.parent_path() /
           fmt::format("{}{}", own_temporary_prefix(), counter.fetch_add(1));
}

std::filesystem::path directory_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path{"."};
}

// Returns the file that a rename may replace: none, a regular file, or the file that a link leads
// to. A rename would destroy a device, a directory or a FIFO.
Result<std::filesystem::path> file_behind(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status link = std::filesystem::symlink_status(path, error);
    if (!std::filesystem::exists(link)) return path;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::is_regular_file(status)) {
        return fail(ErrorCode::not_a_file, "{}: exists and is not a regular file", path.native());
    }
    if (!std::filesystem::is_symlink(link)) return path;
    std::filesystem::path target = std::filesystem::canonical(path, error);
    if (error) return fail(ErrorCode::io, "{}: {}", path.native(), error.message());
    return target;
}

// Adds the path to the error of an operation on a descriptor, because a descriptor does not know
// its path.
Status name_failure(Status status, const std::filesystem::path& path) {
    if (!status)
        status.error().message = fmt::format("{}: {}", path.native(), status.error().message);
    return status;
}

// Reads to the end. The file may be growing or shrinking, so its size is only a hint.
Result<std::vector<std::byte>> read_to_end(int descriptor, const std::filesystem::path& path,
                                           std::uint64_t size_hint, std::uint64_t limit) {
    std::vector<std::byte> bytes;
    bytes.reserve(size_hint + 1);
    std::size_t filled = 0;
    for (;;) {
        if (filled == bytes.size()) {
            const std::size_t more = std::max(bytes.capacity(), bytes.size() * 2 + 65536);
            bytes.resize(std::min<std::uint64_t>(more - 1, limit) + 1);
        }
        const ssize_t n = ::read(descriptor, bytes.data() + filled, bytes.size() - filled);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return system_failure(path.native(), errno);
        if (n == 0) break;
        filled += static_cast<std::size_t>(n);
        if (filled > limit) {
            return fail(ErrorCode::unsupported, "{}: is larger than the limit of {} bytes",
                        path.native(), limit);
        }
    }
    bytes.resize(filled);
    return bytes;
}

}  // namespace

std::string own_temporary_prefix() {
    static const std::string host = host_name();
    return fmt::format("{}{}-{}-", temporary_prefix, host, ::getpid());
}

Status remove_temporaries(FileSystem& file_system, const std::filesystem::path& directory) {
    std::error_code error;
    std::vector<std::filesystem::path> found;
    for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().filename().native().starts_with(temporary_prefix))
            found.push_back(entry->path());
    }
    if (error && error != std::errc::no_such_file_or_directory)
        return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    for (const std::filesystem::path& path : found) {
        Status removed = file_system.remove(path);
        if (!removed && removed.error().code != ErrorCode::not_found) return removed;
    }
    return {};
}

FileSystem& real_file_system() {
    static RealFileSystem file_system;
    return file_system;
}

Status check_target(const std::filesystem::path& path) {
    const auto target = file_behind(path);
    if (!target) return pass_on(target);
    const std::filesystem::path directory = directory_of(*target);
    std::error_code error;
    if (!std::filesystem::is_directory(directory, error)) {
        return fail(ErrorCode::not_found, "{}: there is no directory {}", path.native(),
                    directory.native());
    }
    if (::access(directory.c_str(), W_OK) != 0) return system_failure(path.native(), errno);
    return {};
}

AtomicFile::AtomicFile(FileSystem& file_system, std::filesystem::path final_path,
                       std::filesystem::path temporary_path, int descriptor)
    : file_system_(&file_system),
      final_path_(std::move(final_path)),
      temporary_path_(std::move(temporary_path)),
      descriptor_(descriptor) {}

Result<AtomicFile> AtomicFile::create(FileSystem& file_system, std::filesystem::path final_path) {
    auto target = file_behind(final_path);
    if (!target) return pass_on(target);
    final_path = std::move(*target);
    std::filesystem::path temporary_path = temporary_name(final_path);
    const Result<int> descriptor = file_system.create_exclusive(temporary_path);
    if (!descriptor) {
        // The directory is the cause, but the message must name the path that the caller knows.
        const std::string& message = descriptor.error().message;
        return fail(descriptor.error().code, "{}: cannot be created{}", final_path.native(),
                    message.substr(std::min(message.size(), message.rfind(": "))));
    }
    return AtomicFile(file_system, std::move(final_path), std::move(temporary_path), *descriptor);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : file_system_(other.file_system_),
      final_path_(std::move(other.final_path_)),
      temporary_path_(std::move(other.temporary_path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      end_(other.end_) {}

AtomicFile::~AtomicFile() {
    if (descriptor_ < 0) return;
    file_system_->close(descriptor_);
    // ignore an error, because only the failure that led here matters
    (void)file_system_->remove(temporary_path_);
}

Status AtomicFile::append(std::span<const std::byte> bytes) {
    return write_at(end_, bytes);
}

Status AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
    end_ = std::max(end_, offset + bytes.size());
    return name_failure(file_system_->write_at(descriptor_, offset, bytes), final_path_);
}

Status AtomicFile::set_size(std::uint64_t size) {
    end_ = size;
    return name_failure(file_system_->set_size(descriptor_, size), final_path_);
}

Status AtomicFile::commit() {
    if (Status synced = name_failure(file_system_->sync(descriptor_), final_path_); !synced) {
        return synced;
    }
    if (Status renamed = file_system_->rename(temporary_path_, final_path_); !renamed) {
        return renamed;
    }
    file_system_->close(std::exchange(descriptor_, -1));
    return file_system_->sync_directory(directory_of(final_path_));
}

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t limit) {
    // With O_NONBLOCK, a FIFO in place of a file cannot block us.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) return system_failure(path.native(), errno);
    return read_open_file(file.number(), path, limit);
}

Result<std::vector<std::byte>> read_open_file(int descriptor, const std::filesystem::path& path,
                                              std::uint64_t limit) {
    struct stat facts {};
    if (::fstat(descriptor, &facts) != 0) return system_failure(path.native(), errno);
    if (S_ISDIR(facts.st_mode)) {
        return fail(ErrorCode::not_a_file, "{}: is a directory", path.native());
    }
    if (!S_ISREG(facts.st_mode)) {
        return fail(ErrorCode::not_a_file, "{}: is not a regular file", path.native());
    }
    const auto size = static_cast<std::uint64_t>(facts.st_size);
    if (size > limit) {
        return fail(ErrorCode::unsupported, "{}: has {} bytes, more than the limit of {}",
                    path.native(), size, limit);
    }
    return read_to_end(descriptor, path, size, limit);
}

Status write_file_atomically(FileSystem& file_system, const std::filesystem::path& path,
                             std::span<const std::byte> bytes) {
    Result<AtomicFile> file = AtomicFile::create(file_system, path);
    if (!file) return pass_on(file);
    if (Status written = file->append(bytes); !written) return written;
    return file->commit();
}

}  // namespace stormcellar
