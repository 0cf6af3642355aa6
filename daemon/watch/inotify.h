// daemon/watch/inotify.h -- the kernel's reports about directories. They are behind an interface,
// so that tests can force rare cases: an overflowing queue, no watches left.
//
// Threads   One thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/interface.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

struct DirectoryEvent {
    int watch = -1;          // number of the directory's watch; -1 for an overflow
    std::uint32_t mask = 0;  // IN_* of <sys/inotify.h>
    std::string name;        // name of the entry; empty if the event is about the directory itself
};

class EventSource : public Interface {
  public:
    // Returns a descriptor that is readable when events are waiting; -1: nothing to poll.
    [[nodiscard]] virtual int descriptor() const = 0;
    // Watches a directory and returns the number of the watch. A directory that is already watched
    // keeps its number. DIR may not be a link; to watch the target of a link, pass "DIR/.". Errors:
    // no_space if the system's limit of watches is reached; not_found, permission, io.
    virtual Result<int> watch(const std::filesystem::path& directory) = 0;
    virtual void unwatch(int watch) = 0;
    // Returns the reason why the directory may change without events, so that it must be polled.
    // Returns none if events report all changes. Returns an empty text if an earlier call gave the
    // reason.
    virtual std::optional<std::string> silence(const std::filesystem::path& /*directory*/) {
        return std::nullopt;
    }
    // Returns the waiting events, oldest first, but at most about 64 KiB of them. Never blocks.
    virtual std::vector<DirectoryEvent> read() = 0;
};

// Opens an inotify instance. Fails if the system has none left; the message names the sysctl.
[[nodiscard]] Result<std::unique_ptr<EventSource>> open_inotify();

// Returns a source without events. Every directory is then silent and must be polled. Use it if
// open_inotify() fails.
[[nodiscard]] std::unique_ptr<EventSource> no_events();

}  // namespace stormcellar::daemon
