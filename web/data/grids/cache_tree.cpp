#include "web/data/grids/cache_tree.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <set>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/stat.h>

namespace stormcellar::web {
namespace {

constexpr std::uint32_t watched_events = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE |
                                         IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR |
                                         IN_DONT_FOLLOW | IN_EXCL_UNLINK;
// The time of a file may be behind the clock by a tick, and network file systems have clocks of
// their own. This slack covers both.
constexpr std::int64_t clock_slack_ns = 2'000'000'000;

std::int64_t nanoseconds_of(const timespec& time) {
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::int64_t file_clock_now_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    return nanoseconds_of(now);
}

struct CloseListing {
    void operator()(DIR* listing) const { ::closedir(listing); }
};

// Returns the sorted names of the directories, or of the regular files, in a directory. Leaves out
// names that begin with a dot. Includes entries of unknown type, which the caller must check.
// Returns none if the names cannot be read.
std::optional<std::vector<std::string>> entry_names(const std::filesystem::path& directory,
                                                    bool directories) {
    const int number = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (number < 0) return std::nullopt;
    const std::unique_ptr<DIR, CloseListing> listing(::fdopendir(number));
    if (!listing) {
        ::close(number);
        return std::nullopt;
    }
    std::vector<std::string> names;
    while (const dirent* entry = ::readdir(listing.get())) {
        const bool fits =
            entry->d_type == DT_UNKNOWN || entry->d_type == (directories ? DT_DIR : DT_REG);
        if (fits && entry->d_name[0] != '.') names.emplace_back(entry->d_name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

CacheTree::CacheTree(std::filesystem::path cache, int notify, CacheWatch::Listener listener)
    : cache_(std::move(cache)), notify_(notify), listener_(std::move(listener)) {}

std::filesystem::path CacheTree::path_of(const Place& place) const {
    // The cache itself may be a link. "DIR/." is the directory that the link points to.
    if (place.domain.empty()) return cache_ / ".";
    std::filesystem::path path = cache_ / place.domain;
    if (place.moment) path /= std::string(level2::moment_name(*place.moment));
    if (!place.day.empty()) path /= place.day;
    return path;
}

void CacheTree::tell(CacheEvent event, const Place& place, UtcTime time) const {
    listener_({event, {place.domain, *place.moment, time}});
}

void CacheTree::tell_everything() {
    listener_({CacheEvent::everything, {}});
}

// Sets the watch before it notes the time and reads the names, so that a change in between is
// either read or reported.
std::optional<bool> CacheTree::look(const Place& place, Seen& seen) {
    const std::filesystem::path path = path_of(place);
    struct stat facts {};
    // If a directory cannot be read, it is not gone, so keep what is known about it.
    enum class Found { directory, nothing, unreadable };
    const auto find = [&] {
        if (::lstat(path.c_str(), &facts) != 0)
            return errno == ENOENT || errno == ENOTDIR ? Found::nothing : Found::unreadable;
        return S_ISDIR(facts.st_mode) ? Found::directory : Found::nothing;
    };
    const auto is_the_same = [&] {
        return seen.device == facts.st_dev && seen.inode == facts.st_ino;
    };
    Found found = find();
    if (found == Found::directory && !is_the_same()) unwatch(seen);
    if (found == Found::directory && seen.watch < 0) {
        if (notify_ >= 0) seen.watch = ::inotify_add_watch(notify_, path.c_str(), watched_events);
        if (seen.watch >= 0) places_[seen.watch] = place;
        found = find();
    }
    if (found == Found::nothing) return std::nullopt;
    if (found == Found::unreadable || seen.watch < 0) blind_ = true;
    if (found == Found::unreadable) return false;
    // Names that changed within the last tick of the clock may not have changed the time.
    const std::int64_t modified_ns = nanoseconds_of(facts.st_mtim);
    const bool must_read = !is_the_same() || modified_ns != seen.modified_ns ||
                           seen.read_ns < modified_ns + clock_slack_ns;
    seen.device = facts.st_dev;
    seen.inode = facts.st_ino;
    seen.modified_ns = modified_ns;
    return must_read;
}

void CacheTree::unwatch(Seen& seen) {
    if (seen.watch >= 0) {
        ::inotify_rm_watch(notify_, seen.watch);
        places_.erase(seen.watch);
    }
    seen = {};
}

void CacheTree::scan() {
    blind_ = false;
    root_gone_ = false;
    const auto must_read = look({}, root_);
    is_there_ = must_read.has_value();
    if (!is_there_) return drop_all();
    std::set<std::string> names;
    for (const auto& [domain, known] : domains_)
        names.insert(domain);
    if (*must_read) {
        const std::int64_t now = file_clock_now_ns();
        if (const auto read = entry_names(path_of({}), true)) {
            names.insert(read->begin(), read->end());
            root_.read_ns = now;
        } else {
            blind_ = true;
        }
    }
    for (const std::string& name : names) {
        if (cache::is_domain_name(name)) scan_domain(name);
    }
}

void CacheTree::scan_domain(const std::string& domain) {
    OfDomain& known = domains_[domain];
    const auto must_read = look({domain, {}, {}}, known.seen);
    if (!must_read) return drop_domain(domain);
    std::set<level2::Moment> moments;
    for (const auto& [moment, days] : known.moments)
        moments.insert(moment);
    if (*must_read) {
        const std::int64_t now = file_clock_now_ns();
        if (const auto names = entry_names(path_of({domain, {}, {}}), true)) {
            for (const std::string& name : *names) {
                if (const auto moment = level2::moment_from_name(name)) moments.insert(*moment);
            }
            known.seen.read_ns = now;
        } else {
            blind_ = true;
        }
    }
    for (const level2::Moment moment : moments)
        scan_moment(domain, moment);
}

void CacheTree::scan_moment(const std::string& domain, level2::Moment moment) {
    OfMoment& known = domains_[domain].moments[moment];
    const auto must_read = look({domain, moment, {}}, known.seen);
    if (!must_read) return drop_moment(domain, moment);
    std::set<std::string> days;
    for (const auto& [day, times] : known.days)
        days.insert(day);
    if (*must_read) {
        const std::int64_t now = file_clock_now_ns();
        if (const auto names = entry_names(path_of({domain, moment, {}}), true)) {
            std::copy_if(names->begin(), names->end(), std::inserter(days, days.end()),
                         [](const std::string& name) { return cache::is_day_name(name); });
            known.seen.read_ns = now;
        } else {
            blind_ = true;
        }
    }
    for (const std::string& day : days)
        scan_day({domain, moment, day});
}

void CacheTree::scan_day(const Place& place) {
    Day& day = domains_[place.domain].moments[*place.moment].days[place.day];
    const auto must_read = look(place, day.seen);
    if (!must_read) return drop_day(place);
    if (!*must_read) return;
    const std::int64_t now = file_clock_now_ns();
    const auto names = entry_names(path_of(place), false);
    if (!names) {
        blind_ = true;
        return;
    }
    const std::int64_t read_before_ns = std::exchange(day.seen.read_ns, now);
    compare_day(place, day, *names, read_before_ns);
}

// Reports new names as come and missing names as gone. Reports a file with a known name as changed
// unless its ctime is clearly older than the last read.
void CacheTree::compare_day(const Place& place, Day& day, const std::vector<std::string>& names,
                            std::int64_t read_before_ns) {
    std::vector<std::pair<UtcTime, const std::string*>> found;
    for (const std::string& name : names) {
        const auto time = cache::time_in_file_name(place.domain, *place.moment, name);
        if (time && cache::day_name(*time) == place.day) found.emplace_back(*time, &name);
    }
    std::sort(found.begin(), found.end());
    std::vector<UtcTime> times;
    times.reserve(found.size());
    for (const auto& [time, name] : found)
        times.push_back(time);
    const std::vector<UtcTime> before = std::exchange(day.times, std::move(times));
    for (const UtcTime time : before) {
        if (!std::binary_search(day.times.begin(), day.times.end(), time)) {
            tell(CacheEvent::went, place, time);
        }
    }
    const std::filesystem::path directory = path_of(place);
    for (const auto& [time, name] : found) {
        if (!std::binary_search(before.begin(), before.end(), time)) {
            tell(CacheEvent::came, place, time);
            continue;
        }
        struct stat facts {};
        const bool is_newer = ::lstat((directory / *name).c_str(), &facts) == 0 &&
                              nanoseconds_of(facts.st_ctim) + clock_slack_ns >= read_before_ns;
        if (is_newer) tell(CacheEvent::changed, place, time);
    }
}

void CacheTree::drop_day(const Place& place) {
    auto& days = domains_[place.domain].moments[*place.moment].days;
    const auto found = days.find(place.day);
    if (found == days.end()) return;
    Day day = std::move(found->second);
    days.erase(found);
    unwatch(day.seen);
    for (const UtcTime time : day.times)
        tell(CacheEvent::went, place, time);
}

void CacheTree::drop_moment(const std::string& domain, level2::Moment moment) {
    auto& moments = domains_[domain].moments;
    const auto found = moments.find(moment);
    if (found == moments.end()) return;
    while (!found->second.days.empty()) {
        drop_day({domain, moment, std::string(found->second.days.begin()->first)});
    }
    unwatch(found->second.seen);
    moments.erase(found);
}

void CacheTree::drop_domain(const std::string& domain) {
    const auto found = domains_.find(domain);
    if (found == domains_.end()) return;
    while (!found->second.moments.empty()) {
        drop_moment(domain, found->second.moments.begin()->first);
    }
    unwatch(found->second.seen);
    domains_.erase(found);
}

void CacheTree::drop_all() {
    while (!domains_.empty()) {
        drop_domain(std::string(domains_.begin()->first));
    }
    unwatch(root_);
}

CacheTree::Day* CacheTree::find_day(const Place& place) {
    const auto domain = domains_.find(place.domain);
    if (domain == domains_.end()) return nullptr;
    const auto moment = domain->second.moments.find(*place.moment);
    if (moment == domain->second.moments.end()) return nullptr;
    const auto day = moment->second.days.find(place.day);
    return day == moment->second.days.end() ? nullptr : &day->second;
}

bool CacheTree::take(const char* events, std::size_t size) {
    bool lost = false;
    std::size_t at = 0;
    while (at + sizeof(inotify_event) <= size) {
        inotify_event event{};
        std::memcpy(&event, events + at, sizeof event);
        const char* name = events + at + sizeof event;
        at += sizeof event + event.len;
        if ((event.mask & IN_Q_OVERFLOW) != 0) {
            lost = true;
            continue;
        }
        // The kernel pads the name with zeros.
        handle(event.wd, event.mask, {name, ::strnlen(name, event.len)});
    }
    if (lost) forget_times();
    return !lost && !root_gone_;
}

void CacheTree::forget_times() {
    tell_everything();
    for (auto& [name, domain] : domains_) {
        domain.seen.read_ns = 0;
        for (auto& [moment, days] : domain.moments) {
            days.seen.read_ns = 0;
            for (auto& [day, known] : days.days)
                known.seen.read_ns = 0;
        }
    }
    root_.read_ns = 0;
}

void CacheTree::handle(int watch, std::uint32_t mask, std::string_view name) {
    const auto found = places_.find(watch);
    if (found == places_.end()) return;
    const Place place = found->second;
    const bool is_root = place.domain.empty();
    if ((mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT | IN_IGNORED)) != 0) {
        // If another directory is gone, the events of the directory above it report that.
        if (is_root) root_gone_ = true;
        return;
    }
    if ((mask & IN_ISDIR) != 0) return handle_directory(place, mask, std::string(name));
    if (!place.day.empty()) handle_file(place, mask, name);
}

void CacheTree::handle_directory(const Place& place, std::uint32_t mask, const std::string& name) {
    const bool came = (mask & (IN_CREATE | IN_MOVED_TO)) != 0;
    const bool went = (mask & (IN_DELETE | IN_MOVED_FROM)) != 0;
    if (!came && !went) return;
    if (place.domain.empty()) {
        if (!cache::is_domain_name(name)) return;
        went ? drop_domain(name) : scan_domain(name);
    } else if (!place.moment) {
        const auto moment = level2::moment_from_name(name);
        if (!moment) return;
        went ? drop_moment(place.domain, *moment) : scan_moment(place.domain, *moment);
    } else if (place.day.empty()) {
        if (!cache::is_day_name(name)) return;
        const Place day{place.domain, place.moment, name};
        went ? drop_day(day) : scan_day(day);
    }
}

// Notes the time of the directory after an event, so that the next scan need not read the directory
// again.
void CacheTree::note_time(const Place& place, Seen& seen) const {
    struct stat facts {};
    if (::lstat(path_of(place).c_str(), &facts) != 0) return;
    seen.modified_ns = nanoseconds_of(facts.st_mtim);
    seen.read_ns = file_clock_now_ns();
}

void CacheTree::handle_file(const Place& place, std::uint32_t mask, std::string_view name) {
    Day* day = find_day(place);
    const auto time = cache::time_in_file_name(place.domain, *place.moment, name);
    if (day == nullptr || !time || cache::day_name(*time) != place.day) return;
    const auto at = std::lower_bound(day->times.begin(), day->times.end(), *time);
    const bool is_known = at != day->times.end() && *at == *time;
    struct stat facts {};
    const bool has_facts = ::lstat((path_of(place) / std::string(name)).c_str(), &facts) == 0;
    // If a file cannot be read, it is not gone. A scan will look again.
    if (!has_facts && errno != ENOENT && errno != ENOTDIR) return;
    if (!has_facts || !S_ISREG(facts.st_mode)) {
        // If a grid came and went before its first event was read, report it as gone, too, but only
        // once.
        const bool has_come = (mask & (IN_MOVED_TO | IN_CLOSE_WRITE)) != 0;
        if (!is_known && (has_facts || !has_come || day->gone == *time)) return;
        if (is_known) day->times.erase(at);
        day->gone = *time;
        note_time(place, day->seen);
        return tell(CacheEvent::went, place, *time);
    }
    // A new file is reported when it is closed. But a new hard link is never written, so report it
    // now.
    if ((mask & IN_CREATE) != 0 && facts.st_nlink < 2) return;
    // An event for the new file of this name follows.
    if ((mask & (IN_DELETE | IN_MOVED_FROM)) != 0) return;
    if (!is_known) day->times.insert(at, *time);
    day->gone.reset();
    note_time(place, day->seen);
    tell(is_known ? CacheEvent::changed : CacheEvent::came, place, *time);
}

}  // namespace stormcellar::web
