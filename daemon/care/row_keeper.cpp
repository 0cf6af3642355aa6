#include "daemon/care/row_keeper.h"

#include <exception>
#include <system_error>

#include "base/counted.h"
#include "base/printable.h"
#include "daemon/log/log.h"

namespace stormcellar::daemon {

void RowKeeper::look(SteadyTime now, std::chrono::milliseconds gone_rows_kept_for) {
    if (work_.valid()) {
        if (work_.wait_for(std::chrono::seconds{0}) != std::future_status::ready) return;
        rested_ = began_ + (rest + 1) * work_.get();
    }
    if (now < rested_) return;
    const bool deletes = gone_rows_kept_for.count() > 0 && now >= next_deletion_;
    const auto work = [this, deletes, gone_rows_kept_for] {
        const SteadyTime began = clock_();
        try {
            const AtWork at_work(pulse_);
            mark_missing();
            roll_rows();
            if (deletes) delete_gone(gone_rows_kept_for);
        } catch (const std::exception& error) {  // memory is short
            log_warning({Event::files_gone_failed},
                        "cannot check which cataloged files are gone: {}", error.what());
        }
        return clock_() - began;
    };
    try {
        work_ = std::async(std::launch::async, work);
    } catch (const std::system_error& error) {  // the system has no thread left
        log_warning({Event::files_gone_failed}, "cannot check which cataloged files are gone: {}",
                    error.what());
        return;
    }
    began_ = now;
    if (deletes) next_deletion_ = now + between_deletions;
}

void RowKeeper::mark_missing() {
    const Result<int> marked = sink_.mark_missing([this] { pulse_.beat(); });
    if (!marked) {
        log_warning({Event::files_gone_failed}, "cannot check which cataloged files are gone: {}",
                    printable(marked.error().message));
    } else if (*marked > 0) {
        log_info({Event::files_gone}, "marked {} as gone: no longer there",
                 counted(static_cast<std::uint64_t>(*marked), "file"));
    }
}

void RowKeeper::roll_rows() {
    const Result<std::int64_t> rolled = sink_.roll_rows([this] { pulse_.beat(); });
    if (!rolled) {
        log_warning({Event::files_gone_failed},
                    "cannot delete the catalog rows of files that are gone: {}",
                    printable(rolled.error().message));
    } else if (*rolled > 0) {
        log_info(
            {Event::rows_deleted},
            "deleted the catalog rows of {} marked as gone: the catalog had reached its size limit",
            counted(static_cast<std::uint64_t>(*rolled), "file"));
    }
}

void RowKeeper::delete_gone(std::chrono::milliseconds gone_rows_kept_for) {
    const Result<int> deleted =
        sink_.forget_gone(now_utc() - gone_rows_kept_for, [this] { pulse_.beat(); });
    if (!deleted) {
        log_warning({Event::files_gone_failed},
                    "cannot delete the catalog rows of files that are gone: {}",
                    printable(deleted.error().message));
    } else if (*deleted > 0) {
        log_info({Event::rows_deleted},
                 "deleted the catalog rows of {} marked as gone: they were older than [catalog] "
                 "gone_days",
                 counted(static_cast<std::uint64_t>(*deleted), "file"));
    }
}

}  // namespace stormcellar::daemon
