#include "daemon/queue/growing_files.h"

#include <algorithm>

namespace stormcellar::daemon {

bool GrowingFiles::has_room_for(const std::string& station) {
    if (files_.size() < limit_) return true;
    const auto largest = std::max_element(
        by_station_.begin(), by_station_.end(),
        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    if (largest == by_station_.end()) return false;
    const auto own = by_station_.find(station);
    const std::size_t own_count = own == by_station_.end() ? 0 : own->second.size();
    if (largest->second.size() <= own_count + 1) return false;
    displaced_.emplace_back(*largest->second.begin());
    forget(displaced_.back());
    return true;
}

void GrowingFiles::add(const std::filesystem::path& path, File file, SteadyTime now) {
    if (files_.empty()) next_poll_ = now + settle;
    forget(path);
    by_station_[file.station].insert(path.native());
    files_.emplace(path.native(), std::move(file));
}

GrowingFiles::Files::iterator GrowingFiles::erase(Files::iterator file) {
    const auto own = by_station_.find(file->second.station);
    own->second.erase(file->first);
    if (own->second.empty()) by_station_.erase(own);
    return files_.erase(file);
}

void GrowingFiles::forget(const std::filesystem::path& path) {
    if (const auto known = files_.find(path.native()); known != files_.end()) erase(known);
}

bool GrowingFiles::add_new(const std::filesystem::path& path, const FileStamp& stamp,
                           SteadyTime now, const std::string& station) {
    if (files_.contains(path.native())) return true;
    if (!has_room_for(station)) return false;
    File file{.looked_at = {}, .last = stamp, .since = now, .changed_at = now};
    file.station = station;
    add(path, std::move(file), now);
    return true;
}

bool GrowingFiles::add_incomplete(const std::filesystem::path& path, const FileStamp& stamp,
                                  SteadyTime now, bool followed, const std::string& station) {
    if (!files_.contains(path.native()) && !has_room_for(station)) return false;
    add(path,
        {.looked_at = stamp,
         .last = stamp,
         .since = now,
         .changed_at = now,
         .incomplete = true,
         .followed = followed,
         .station = station},
        now);
    return true;
}

std::optional<GrowingFiles::Due> GrowingFiles::decide(const std::filesystem::path& path,
                                                      const File& file, SteadyTime now) const {
    const bool quiet = now - file.changed_at >= (file.followed ? patience * quiet_ : quiet_);
    if (file.incomplete && file.last == file.looked_at) {
        if (quiet) return Due{path, file.last, true};
        return std::nullopt;
    }
    // An empty file has probably just been created, and its writer has not written yet.
    const bool settled = now - file.changed_at >= settle && file.last.size_bytes > 0;
    const bool is_first = !file.incomplete && file.last.size_bytes > 0;
    const bool overdue = now - file.since >= (is_first ? std::min<Duration>(quiet_, busy) : quiet_);
    if (settled || quiet || overdue) return Due{path, file.last, false};
    return std::nullopt;
}

GrowingFiles::Files::iterator GrowingFiles::look_at(Files::iterator entry, SteadyTime now,
                                                    const Look& look, std::vector<Due>& due) {
    auto& [path, file] = *entry;
    const FileFound found = look(path);
    if (found.standing == Standing::unknown) return std::next(entry);
    const bool was_there = file.last != FileStamp{};
    if (found.standing != Standing::regular && (was_there || !file.incomplete)) {
        if (file.incomplete) due.push_back({path, {}, false});
        return erase(entry);
    }
    if (found.stamp != file.last) {
        file.last = found.stamp;
        file.changed_at = now;
    }
    auto decided = decide(path, file, now);
    if (!decided) return std::next(entry);
    due.push_back(std::move(*decided));
    return erase(entry);
}

std::vector<GrowingFiles::Due> GrowingFiles::poll(SteadyTime now, const Look& look) {
    std::vector<Due> due;
    if (files_.empty() || now < next_poll_) return due;
    // Poll up to `most_looks` files in each round, and begin at most one round a second. Divide a
    // round into parts, so that the caller never waits for a whole round.
    if (looks_left_ == 0) {
        looks_left_ = std::min(files_.size(), most_looks);
        next_round_ = now + settle;
    }
    auto entry = files_.lower_bound(next_name_);
    for (std::size_t i = 0; i < most_looks_at_once && looks_left_ > 0; ++i) {
        --looks_left_;
        if (entry == files_.end()) entry = files_.begin();
        entry = look_at(entry, now, look, due);
        if (files_.empty()) looks_left_ = 0;
    }
    next_name_ = entry == files_.end() ? std::string{} : entry->first;
    next_poll_ = looks_left_ == 0 ? next_round_ : now;
    return due;
}

std::vector<GrowingFiles::Wait> GrowingFiles::waits(SteadyTime now, std::size_t most) const {
    std::vector<Wait> waits;
    for (const auto& [path, file] : files_) {
        if (!file.incomplete || file.last != file.looked_at) continue;
        const Duration quiet = file.followed ? patience * quiet_ : quiet_;
        waits.push_back({path, std::max(Duration{}, file.changed_at + quiet - now)});
    }
    const auto count = static_cast<std::ptrdiff_t>(std::min(most, waits.size()));
    std::partial_sort(waits.begin(), waits.begin() + count, waits.end(),
                      [](const Wait& a, const Wait& b) { return a.left < b.left; });
    waits.resize(static_cast<std::size_t>(count));
    return waits;
}

std::optional<SteadyTime> GrowingFiles::next_time() const {
    if (files_.empty()) return std::nullopt;
    return next_poll_;
}

std::optional<SteadyTime> GrowingFiles::found_incomplete_at(
    const std::filesystem::path& path) const {
    const auto found = files_.find(path.native());
    if (found == files_.end() || !found->second.incomplete) return std::nullopt;
    return found->second.since;
}

}  // namespace stormcellar::daemon
