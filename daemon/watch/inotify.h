// daemon/watch/inotify.h -- what the kernel reports about directories, as an interface, so that
// tests can force rare cases: an overflowing queue, no watches left. Thread contract: one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

struct DirectoryEvent {
    int watch = -1;          // which directory; -1 for an overflow
    std::uint32_t mask = 0;  // IN_* of <sys/inotify.h>
    std::string name;        // of the entry; empty when the event is about the directory itself
};

class EventSource {
  public:
    EventSource() = default;
    EventSource(const EventSource&) = delete;
    EventSource& operator=(const EventSource&) = delete;
    virtual ~EventSource() = default;

    // Readable when events wait; -1: there is nothing to poll.
    [[nodiscard]] virtual int descriptor() const = 0;
    // The number of the watch; the same number again for a directory that is watched already.
    // Errors: no_space if the system's limit of watches is reached; not_found, permission, io.
    // "DIR/." may be reached through a link, DIR itself may not.
    virtual Result<int> watch(const std::filesystem::path& directory) = 0;
    virtual void unwatch(int watch) = 0;
    // Why changes in the directory may come without events, so that it must be polled; none if the
    // kernel reports them. Empty: that was said already.
    virtual std::optional<std::string> silence(const std::filesystem::path& /*directory*/) {
        return std::nullopt;
    }
    // All events that wait now, oldest first; never blocks. At most about 64 KiB of events a call.
    virtual std::vector<DirectoryEvent> read() = 0;
};

// Fails if the system has no inotify instance left; the error names the sysctl.
[[nodiscard]] Result<std::unique_ptr<EventSource>> open_inotify();

// A source without events: every directory is silent and must be polled. For use if open_inotify()
// fails.
[[nodiscard]] std::unique_ptr<EventSource> no_events();

}  // namespace stormcellar::daemon
