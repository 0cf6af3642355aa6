// notify/notify_service.h -- follows the areas of all rules, and runs a thread for each rule to
// deliver the rule's messages.
//
// Each rule has a directory and a thread of its own, so that a server that hangs does not delay the
// messages of other rules.
//
// Threads   One thread at a time. The destructor ends the object's own threads, within a second or
//           so.
// Errors    open(): a directory cannot be made or read, or a password file is of no use.
#pragma once

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "base/steady_time.h"
#include "notify/area_watch.h"
#include "notify/courier.h"
#include "notify/notify_config.h"
#include "notify/outbox.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::notify {

class NotifyService {
  public:
    static Result<std::unique_ptr<NotifyService>> open(FileSystem& file_system,
                                                       const NotifyConfig& config);
    NotifyService(const NotifyService&) = delete;
    NotifyService& operator=(const NotifyService&) = delete;
    ~NotifyService();

    // Looks for new grids, and writes messages about their cells. Begins with no further area after
    // 20 s, so that the caller can feed its watchdog; the next call begins with the next area.
    // Returns the last of the errors. After an error a later call tries the same area again, and
    // writes no message twice.
    Status turn(UtcTime now);
    // Returns the time since the last sign of progress of the thread that has been silent longest.
    [[nodiscard]] std::chrono::milliseconds longest_silence() const;

  private:
    struct Post;  // a rule with its outbox and its thread
    explicit NotifyService(const NotifyConfig& config);
    Status add(FileSystem& file_system, const NotifyRule& rule);
    Status look_at(AreaWatch& area, UtcTime now);
    Status report(Post& post, const retrieve::TrackedScan& scan);
    void run(Post& post);
    void wait() STORMCELLAR_EXCLUDES(mutex_);

    const NotifyConfig config_;
    std::vector<AreaWatch> areas_;
    std::size_t next_area_ = 0;
    std::atomic<bool> stop_{false};
    Mutex mutex_;  // hold it to set stop_, or a thread about to wait would miss the change
    ConditionVariable stopped_;
    std::vector<std::unique_ptr<Post>> posts_;
};

}  // namespace stormcellar::notify
