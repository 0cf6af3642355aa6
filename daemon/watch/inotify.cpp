#include "daemon/watch/inotify.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include <sys/inotify.h>
#include <unistd.h>

#include "base/system_error.h"
#include "daemon/process/silent_file_systems.h"
#include "stormcellar/base/descriptor.h"

namespace stormcellar::daemon {
namespace {

constexpr std::uint32_t wanted = IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM |
                                 IN_CREATE | IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF |
                                 IN_ONLYDIR | IN_DONT_FOLLOW | IN_EXCL_UNLINK;

ErrorCode code_of(int error_number) {
    return error_number == ELOOP ? ErrorCode::not_found : error_code_of(error_number);
}

// Returns the smallest limit that applies to the user, with its value, for example
// "fs.inotify.max_user_watches (16384 now)". `name` is the name of the limit without "max_".
std::string limit_named(std::string_view name) {
    std::string least_name = fmt::format("fs.inotify.max_{}", name);
    std::optional<std::uint64_t> least;
    // A second limit applies to the users of a container.
    const std::string_view kind = name.substr(name.find('_') + 1);
    for (const std::string& sysctl :
         {fmt::format("fs.inotify.max_{}", name), fmt::format("user.max_inotify_{}", kind)}) {
        std::string path = "/proc/sys/" + sysctl;
        std::replace(path.begin() + 10, path.end(), '.', '/');
        std::uint64_t value = 0;
        if (!(std::ifstream(path) >> value) || (least && *least <= value)) continue;
        least = value;
        least_name = sysctl;
    }
    return least ? fmt::format("{} (now {})", least_name, *least) : least_name;
}

class Inotify final : public EventSource {
  public:
    explicit Inotify(int descriptor) : descriptor_(descriptor) {}

    [[nodiscard]] int descriptor() const override { return descriptor_.number(); }

    Result<int> watch(const std::filesystem::path& directory) override {
        const int number = ::inotify_add_watch(descriptor_.number(), directory.c_str(), wanted);
        if (number >= 0) return number;
        const int error_number = errno;
        const std::filesystem::path named =
            directory.filename() == "." ? directory.parent_path() : directory;
        if (error_number == ENOSPC) {
            return fail(ErrorCode::no_space, "{}: no inotify watch is left; raise the sysctl {}",
                        named.native(), limit_named("user_watches"));
        }
        return fail(code_of(error_number), "{}: {}", named.native(),
                    std::system_category().message(error_number));
    }

    void unwatch(int watch) override { ::inotify_rm_watch(descriptor_.number(), watch); }

    std::optional<std::string> silence(const std::filesystem::path& directory) override {
        const auto name = silent_file_system_of(directory);
        if (!name) return std::nullopt;
        return fmt::format("{}: is on {}, where the kernel does not report every change",
                           directory.native(), *name);
    }

    std::vector<DirectoryEvent> read() override {
        alignas(inotify_event) std::array<char, 65536> buffer;
        const ssize_t length = ::read(descriptor_.number(), buffer.data(), buffer.size());
        std::vector<DirectoryEvent> events;
        std::size_t at = 0;
        while (length > 0 && at + sizeof(inotify_event) <= static_cast<std::size_t>(length)) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            const char* name = buffer.data() + at + sizeof event;
            // The kernel pads the name with zeros to `len` bytes.
            events.push_back({event.wd, event.mask, {name, ::strnlen(name, event.len)}});
            at += sizeof event + event.len;
        }
        return events;
    }

  private:
    Descriptor descriptor_;
};

class NoEvents final : public EventSource {
  public:
    [[nodiscard]] int descriptor() const override { return -1; }
    Result<int> watch(const std::filesystem::path&) override { return 0; }
    void unwatch(int) override {}
    std::optional<std::string> silence(const std::filesystem::path&) override { return ""; }
    std::vector<DirectoryEvent> read() override { return {}; }
};

}  // namespace

Result<std::unique_ptr<EventSource>> open_inotify() {
    const int descriptor = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (descriptor < 0) {
        const int error_number = errno;
        return fail(
            code_of(error_number), "inotify: {}{}", std::system_category().message(error_number),
            error_number == EMFILE ? "; raise the sysctl " + limit_named("user_instances") : "");
    }
    return std::make_unique<Inotify>(descriptor);
}

std::unique_ptr<EventSource> no_events() {
    return std::make_unique<NoEvents>();
}

}  // namespace stormcellar::daemon
