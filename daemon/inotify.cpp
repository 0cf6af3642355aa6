#include "daemon/inotify.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <sys/inotify.h>
#include <unistd.h>

namespace stormcellar::daemon {
namespace {

constexpr std::uint32_t wanted = IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM |
                                 IN_CREATE | IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF |
                                 IN_ONLYDIR | IN_DONT_FOLLOW | IN_EXCL_UNLINK;

ErrorCode code_of(int error_number) {
    switch (error_number) {
        case ENOSPC:
            return ErrorCode::no_space;
        case ENOENT:
        case ENOTDIR:
        case ELOOP:
            return ErrorCode::not_found;
        case EACCES:
            return ErrorCode::permission;
        default:
            return ErrorCode::io;
    }
}

class Inotify final : public EventSource {
  public:
    explicit Inotify(int descriptor) : descriptor_(descriptor) {}
    ~Inotify() override { ::close(descriptor_); }

    [[nodiscard]] int descriptor() const override { return descriptor_; }

    Result<int> watch(const std::filesystem::path& directory) override {
        const int number = ::inotify_add_watch(descriptor_, directory.c_str(), wanted);
        if (number >= 0) return number;
        const int error_number = errno;
        if (error_number == ENOSPC) {
            return fail(ErrorCode::no_space,
                        "{}: no inotify watches left; raise the sysctl fs.inotify.max_user_watches",
                        directory.native());
        }
        return fail(code_of(error_number), "{}: {}", directory.native(),
                    std::system_category().message(error_number));
    }

    void unwatch(int watch) override { ::inotify_rm_watch(descriptor_, watch); }

    std::vector<DirectoryEvent> read() override {
        alignas(inotify_event) std::array<char, 65536> buffer;
        const ssize_t length = ::read(descriptor_, buffer.data(), buffer.size());
        std::vector<DirectoryEvent> events;
        std::size_t at = 0;
        while (length > 0 && at + sizeof(inotify_event) <= static_cast<std::size_t>(length)) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            const char* name = buffer.data() + at + sizeof event;
            // The name is padded with zeros to `len` bytes.
            events.push_back({event.wd, event.mask, {name, ::strnlen(name, event.len)}});
            at += sizeof event + event.len;
        }
        return events;
    }

  private:
    int descriptor_;
};

class NoEvents final : public EventSource {
  public:
    [[nodiscard]] int descriptor() const override { return -1; }
    Result<int> watch(const std::filesystem::path&) override { return 0; }
    void unwatch(int) override {}
    std::vector<DirectoryEvent> read() override { return {}; }
};

}  // namespace

Result<std::unique_ptr<EventSource>> open_inotify() {
    const int descriptor = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (descriptor < 0) {
        const int error_number = errno;
        return fail(
            code_of(error_number), "inotify: {}{}", std::system_category().message(error_number),
            error_number == EMFILE ? "; raise the sysctl fs.inotify.max_user_instances" : "");
    }
    return std::make_unique<Inotify>(descriptor);
}

std::unique_ptr<EventSource> no_events() {
    return std::make_unique<NoEvents>();
}

}  // namespace stormcellar::daemon
