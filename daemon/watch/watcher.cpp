#include "daemon/watch/watcher.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <sys/inotify.h>

#include "base/beneath.h"
#include "daemon/watch/tree_walk.h"
#include "pipeline/drop/drop_names.h"

namespace stormcellar::daemon {
namespace {

constexpr int events_a_step = 32;
// Limit of the time that the thread owes for reading directories that come or go. The debt
// decreases by a tenth of a second each second. Beyond the limit, directories that come or go are
// left to the next scan.
constexpr double most_owed_s = 0.2;
constexpr double paid_back_each_second = 0.1;

double seconds_between(std::chrono::steady_clock::time_point from,
                       std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Watcher::Watcher(std::filesystem::path drop, EventSource& events, WatchListener& listener)
    : drop_(std::move(drop)), events_(events), listener_(listener) {}

Status Watcher::scan() {
    unwatched_ = silent_ = 0;
    unreadable_ = {};
    saw_all_ = true;
    ++scan_;
    Status scanned = scan_below(drop_);
    if (scanned && saw_all_) forget_unseen();
    told_unwatched_ = told_unwatched_ && unwatched_ > 0;
    told_silent_ = told_silent_ && silent_ > 0;
    return scanned;
}

Status Watcher::scan_below(const std::filesystem::path& directory) {
    const auto depth = std::distance(directory.begin(), directory.end()) -
                       std::distance(drop_.begin(), drop_.end());
    return walk(directory,
                {[this](const std::filesystem::path& found) { add_watch(found); },
                 [this](const std::filesystem::path& path, const FileStamp& stamp) {
                     listener_.file_found(path, stamp);
                 },
                 [this](const std::filesystem::path& path, const Error& problem) {
                     report_problem(path, problem);
                 },
                 [this](const std::filesystem::path& path, mode_t mode) {
                     listener_.entry_left_out(path, kind_of_file(mode));
                 },
                 [this] {
                     saw_all_ = false;
                     listener_.entry_unseen();
                 },
                 [this] { step(); }},
                static_cast<int>(depth));
}

void Watcher::report_problem(const std::filesystem::path& directory, const Error& problem) {
    const std::string remedy = remedy_below(problem.code);
    const bool is_unreadable =
        problem.code == ErrorCode::permission || problem.code == ErrorCode::io;
    if (is_unreadable) {
        const std::string reason = problem.message.substr(
            std::min(problem.message.size(), directory.native().size() + std::size(": ") - 1));
        unreadable_.add(directory, reason + remedy);
    }
    // Do not use `unsupported` and `no_space` here, because they mean that a directory is not
    // watched.
    const ErrorCode code =
        problem.code == ErrorCode::permission ? ErrorCode::permission : ErrorCode::io;
    listener_.directory_problem({code, problem.message + remedy});
}

void Watcher::look_for_silence(const std::filesystem::path& directory) {
    const std::optional<std::string> why = events_.silence(directory);
    if (!why) return;
    ++silent_;
    if (why->empty() || std::exchange(told_silent_, true)) return;
    listener_.directory_problem({ErrorCode::unsupported, *why});
}

void Watcher::add_watch(const std::filesystem::path& directory) {
    look_for_silence(directory);
    // The drop directory itself may be a link.
    const Result<int> watch = events_.watch(directory == drop_ ? drop_ / "." : directory);
    if (!watch) {
        // Report no problem if the directory has vanished. If it may not be read, the walk reports
        // that.
        const ErrorCode code = watch.error().code;
        if (code == ErrorCode::not_found || code == ErrorCode::permission) return;
        ++unwatched_;
        if (!std::exchange(told_unwatched_, true)) listener_.directory_problem(watch.error());
        return;
    }
    // A renamed directory keeps its watch, but its old name may now be another directory's.
    const std::string& path = directory.native();
    if (const auto old = path_of_.find(*watch); old != path_of_.end() && old->second.path != path) {
        watch_of_.erase(old->second.path);
    }
    if (const auto old = watch_of_.find(path); old != watch_of_.end() && old->second != *watch) {
        path_of_.erase(old->second);
    }
    path_of_[*watch] = {path, scan_};
    watch_of_[path] = *watch;
}

// Forgets the directories that the scan did not see: they were moved away, or vanished while events
// were lost.
void Watcher::forget_unseen() {
    std::vector<int> watches;
    for (const auto& [watch, directory] : path_of_) {
        if (directory.scan != scan_) watches.push_back(watch);
    }
    for (const int watch : watches) {
        events_.unwatch(watch);
        forget_watch(watch);
    }
}

void Watcher::forget_watch(int watch) {
    const auto found = path_of_.find(watch);
    if (found == path_of_.end()) return;
    if (const auto entry = watch_of_.find(found->second.path);
        entry != watch_of_.end() && entry->second == watch) {
        watch_of_.erase(entry);
    }
    path_of_.erase(found);
}

void Watcher::unwatch_tree(const std::filesystem::path& directory) {
    std::vector<int> watches;
    if (const auto itself = watch_of_.find(directory.native()); itself != watch_of_.end())
        watches.push_back(itself->second);
    const std::string below = directory.native() + "/";
    for (auto entry = watch_of_.lower_bound(below);
         entry != watch_of_.end() && entry->first.starts_with(below); ++entry) {
        watches.push_back(entry->second);
    }
    for (const int watch : watches) {
        events_.unwatch(watch);
        forget_watch(watch);
    }
}

void Watcher::step() {
    if (step_) step_();
    if (!is_reading_) read_events();
}

void Watcher::read_events() {
    is_reading_ = true;
    int handled = 0;
    for (const DirectoryEvent& event : events_.read()) {
        handle(event);
        if (++handled % events_a_step == 0) step();
    }
    is_reading_ = false;
}

void Watcher::handle(const DirectoryEvent& event) {
    if ((event.mask & IN_Q_OVERFLOW) != 0) {
        listener_.events_lost();
        return;
    }
    const auto found = path_of_.find(event.watch);
    if (found == path_of_.end()) return;  // the watch was removed after the event
    const std::filesystem::path directory = found->second.path;
    if ((event.mask & (IN_DELETE_SELF | IN_MOVE_SELF)) != 0 && directory == drop_) {
        unwatch_tree(drop_);
        listener_.drop_vanished();
        return;
    }
    if ((event.mask & (IN_IGNORED | IN_UNMOUNT)) != 0) {
        forget_watch(event.watch);
        return;
    }
    if (pipeline::is_temporary_name(event.name)) return;
    const std::filesystem::path path = directory / event.name;
    if (path.native().size() >= most_path_bytes) return;  // scans report such a path
    if ((event.mask & IN_ISDIR) != 0) {
        handle_directory(event, path);
    } else {
        handle_file(event, path);
    }
}

void Watcher::handle_directory(const DirectoryEvent& event, const std::filesystem::path& path) {
    const auto began = Clock::now();
    owed_s_ = std::max(0.0, owed_s_ - paid_back_each_second * seconds_between(owed_at_, began));
    owed_at_ = began;
    const bool has_time = owed_s_ < most_owed_s;
    if ((event.mask & (IN_DELETE | IN_MOVED_FROM)) != 0) {
        // If there is no time now, the next scan removes the watches. If the directory is deleted,
        // the kernel removes them.
        if (has_time) unwatch_tree(path);
        listener_.directory_gone(path, (event.mask & IN_DELETE) != 0);
    } else if ((event.mask & (IN_CREATE | IN_MOVED_TO)) != 0) {
        if (!has_time) return listener_.directory_unread();
        const Status scanned = scan_below(path);
        if (!scanned && scanned.error().code != ErrorCode::not_found) {
            report_problem(path, scanned.error());
            if (scanned.error().cause() == Cause::system) listener_.entry_unseen();
        }
    }
    owed_s_ += seconds_between(began, Clock::now());
}

void Watcher::handle_file(const DirectoryEvent& event, const std::filesystem::path& path) {
    if ((event.mask & (IN_DELETE | IN_MOVED_FROM)) != 0) {
        listener_.file_gone(path);
        return;
    }
    const bool closed_or_made = (event.mask & (IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE)) != 0;
    if (!closed_or_made && !listener_.follows(path)) return;
    const FileFound found = look_at(path, drop_);
    if (found.standing == Standing::other) listener_.entry_left_out(path, kind_of_file(found.mode));
    if (found.standing == Standing::unknown) listener_.entry_unseen();
    if (found.standing != Standing::regular) return;
    if (!closed_or_made) {
        listener_.file_grew(path, found.stamp);
    } else if ((event.mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0) {
        listener_.file_closed(path, found.stamp);
    } else if ((event.mask & IN_CREATE) != 0) {
        listener_.file_created(path, found.stamp);
    }
}

}  // namespace stormcellar::daemon
