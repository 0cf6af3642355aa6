// fetch/pull/pull_service.h -- runs a thread for each source machine, and writes the status file.
//
// Each machine has a thread and a directory of its own (below [pull] directory), so that a machine
// that hangs or sends wrong data does not affect the others. status.json is also in [pull]
// directory; it is written when something has changed.
//
// Threads   One thread at a time. The destructor ends the object's own threads, within a second or
//           so.
// Errors    open(): the directories cannot be made or read.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/steady_time.h"
#include "fetch/pull/pull_config.h"
#include "fetch/pull/source_puller.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pull {

class PullService {
  public:
    static Result<std::unique_ptr<PullService>> open(FileSystem& file_system,
                                                     const PullConfig& config);
    PullService(const PullService&) = delete;
    PullService& operator=(const PullService&) = delete;
    ~PullService();

    // Writes status.json if its contents have changed. Errors: those of writing.
    Status publish();
    [[nodiscard]] std::vector<SourceStatus> status() const;
    // Returns the time since the last sign of progress of the thread that has been silent longest.
    [[nodiscard]] std::chrono::milliseconds longest_silence() const;

  private:
    PullService(FileSystem& file_system, PullConfig config);
    void run(SourcePuller& puller);
    void wait(SourcePuller& puller) STORMCELLAR_EXCLUDES(mutex_);

    FileSystem& file_system_;
    const PullConfig config_;
    std::atomic<bool> stop_{false};
    Mutex mutex_;  // hold it to set stop_, so that a thread about to wait sees the change
    ConditionVariable stopped_;
    std::string published_;  // the last status, without the time at which it was written
    std::vector<std::unique_ptr<SourcePuller>> pullers_;
    std::vector<std::thread> threads_;  // declared last, because they use the members above
};

}  // namespace stormcellar::pull
