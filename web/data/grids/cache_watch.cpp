#include "web/data/grids/cache_watch.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"
#include "web/data/grids/cache_tree.h"

namespace stormcellar::web {
namespace {

using WatchClock = std::chrono::steady_clock;
constexpr std::chrono::seconds look_for_missing_every{1};
constexpr std::chrono::seconds look_when_blind_every{2};
constexpr std::chrono::seconds look_at_times_every{60};
// If no descriptor is left with which to wake the thread, the thread checks this often whether it
// must end.
constexpr int look_for_the_end_every_ms = 100;
constexpr int try_again_after_ms = 1000;

}  // namespace

struct CacheWatch::Impl {
    Impl(std::filesystem::path cache, Listener listener)
        : notify(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)),
          notify_error(notify.is_open() ? 0 : errno),
          stop(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
          tree(std::move(cache), notify.number(), std::move(listener)) {}

    // Reads all events that wait. If it throws because memory is short, the next call begins with a
    // look at everything.
    void read_events() STORMCELLAR_REQUIRES(mutex) {
        const bool has_missed = std::exchange(is_missing_events, true);
        if (has_missed) {
            tree.forget_times();
            scan();
        }
        alignas(inotify_event) std::array<char, 65536> buffer;
        while (true) {
            const ssize_t size = ::read(notify.number(), buffer.data(), buffer.size());
            if (size <= 0) break;
            if (!tree.take(buffer.data(), static_cast<std::size_t>(size))) scan();
        }
        is_missing_events = false;
    }
    void scan() STORMCELLAR_REQUIRES(mutex) {
        tree.scan();
        scanned = WatchClock::now();
    }
    [[nodiscard]] std::chrono::seconds pause() const STORMCELLAR_REQUIRES(mutex) {
        if (!tree.is_there()) return look_for_missing_every;
        return tree.is_blind() ? look_when_blind_every : look_at_times_every;
    }
    void watch() {
        std::array<pollfd, 2> waiting{pollfd{stop.number(), POLLIN, 0},
                                      pollfd{notify.number(), POLLIN, 0}};
        while (true) {
            int timeout_ms = 0;
            try {
                const MutexLock lock(mutex);
                if (notify.is_open()) read_events();
                if (WatchClock::now() >= scanned + pause()) scan();
                const auto left = scanned + pause() - WatchClock::now();
                timeout_ms =
                    static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count());
            } catch (const std::exception&) {
                timeout_ms = try_again_after_ms;
            }
            if (!stop.is_open()) timeout_ms = std::min(timeout_ms, look_for_the_end_every_ms);
            ::poll(waiting.data(), waiting.size(), std::max(timeout_ms, 1));
            if (is_stopping) return;
        }
    }

    Descriptor notify;
    int notify_error = 0;
    Descriptor stop;  // wakes the thread
    std::atomic<bool> is_stopping = false;
    mutable Mutex mutex;
    CacheTree tree STORMCELLAR_GUARDED_BY(mutex);
    bool is_missing_events STORMCELLAR_GUARDED_BY(mutex) = false;
    WatchClock::time_point scanned STORMCELLAR_GUARDED_BY(mutex){};
    std::thread thread;
};

CacheWatch::CacheWatch(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::unique_ptr<CacheWatch> CacheWatch::open(std::filesystem::path cache, Listener listener) {
    auto impl = std::make_unique<Impl>(std::move(cache), std::move(listener));
    {
        const MutexLock lock(impl->mutex);
        impl->scan();
    }
    impl->thread = std::thread([watched = impl.get()] { watched->watch(); });
    return std::unique_ptr<CacheWatch>(new CacheWatch(std::move(impl)));
}

CacheWatch::~CacheWatch() {
    impl_->is_stopping = true;
    const std::uint64_t one = 1;
    // Adding to an eventfd counter fails only if it is full, which this counter never is.
    [[maybe_unused]] const ssize_t written = ::write(impl_->stop.number(), &one, sizeof one);
    impl_->thread.join();
}

void CacheWatch::catch_up() {
    const MutexLock lock(impl_->mutex);
    if (impl_->notify.is_open()) impl_->read_events();
}

void CacheWatch::rescan() {
    const MutexLock lock(impl_->mutex);
    if (impl_->notify.is_open()) impl_->read_events();
    impl_->scan();
}

std::optional<std::string> CacheWatch::problem() const {
    const MutexLock lock(impl_->mutex);
    if (!impl_->tree.is_there()) return "the cache is not there";
    if (impl_->notify_error != 0) {
        return fmt::format("inotify: {}; the cache is read every {} seconds",
                           std::system_category().message(impl_->notify_error),
                           look_when_blind_every.count());
    }
    if (impl_->tree.is_blind()) {
        return fmt::format(
            "not every directory of the cache can be watched and read (see its rights, and the "
            "sysctl fs.inotify.max_user_watches); the cache is read every {} seconds",
            look_when_blind_every.count());
    }
    return std::nullopt;
}

}  // namespace stormcellar::web
