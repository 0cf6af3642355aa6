// daemon/watch/inotify.h -- what the kernel says about directories, behind an interface so that
// tests can force what is hard to bring about: an overflowing queue, no watches left. Thread
// contract: one thread.
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

    // Readable when events wait; -1: nothing to poll.
    [[nodiscard]] virtual int descriptor() const = 0;
    // The number of the watch; the same one again for a directory that is watched. no_space when
    // the system's limit of watches is reached; not_found, permission, io. "DIR/." may be reached
    // through a link, DIR itself not.
    virtual Result<int> watch(const std::filesystem::path& directory) = 0;
    virtual void unwatch(int watch) = 0;
    // Why changes in the directory may come without events, so that it must be polled; none where
    // they are told of. Empty: that was said already.
    virtual std::optional<std::string> silence(const std::filesystem::path& /*directory*/) {
        return std::nullopt;
    }
    // All that waits now, oldest first; never blocks. At most about 64 KiB of events a call.
    virtual std::vector<DirectoryEvent> read() = 0;
};

// Fails when the system has no inotify instance left, naming the sysctl.
[[nodiscard]] Result<std::unique_ptr<EventSource>> open_inotify();

// No events at all: every directory is silent, and polled. What is left when open_inotify() fails.
[[nodiscard]] std::unique_ptr<EventSource> no_events();

}  // namespace stormcellar::daemon
