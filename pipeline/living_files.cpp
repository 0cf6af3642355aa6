#include "pipeline/living_files.h"

#include <algorithm>
#include <utility>

namespace stormcellar::pipeline {

std::shared_ptr<LivingFile> LivingFiles::find(const std::filesystem::path& path) {
    const std::scoped_lock lock(mutex_);
    const auto at = files_.find(path);
    return at == files_.end() ? nullptr : at->second.file;
}

std::shared_ptr<LivingFile> LivingFiles::begin(const std::filesystem::path& path,
                                               const std::string& fallback_station) {
    LivingFile::Options options = options_;
    options.fallback_station = fallback_station;
    auto begun = LivingFile::begin(path, options);
    if (!begun) return nullptr;
    std::shared_ptr<LivingFile> file = std::move(*begun);
    const std::scoped_lock lock(mutex_);
    files_.insert_or_assign(path, Followed{file, next_turn_++, 0, 0});
    give_up_beyond_limits(path);
    return file;
}

void LivingFiles::grew(const std::filesystem::path& path, const LivingFile& file) {
    const std::scoped_lock lock(mutex_);
    const auto at = files_.find(path);
    if (at == files_.end()) return;
    at->second.turn = next_turn_++;
    at->second.held_bytes = file.held_bytes();
    at->second.shelf_bytes = file.shelf_bytes();
    give_up_beyond_limits(path);
}

void LivingFiles::drop_last_beyond_limits() {
    std::uint64_t shelf = 0;
    for (const auto& [path, followed] : files_)
        shelf += followed.shelf_bytes;
    for (const auto& [station, volume] : last_)
        shelf += volume->shelf->bytes();
    // As many sites as there are files: names come from outside.
    while (!last_.empty() && (last_.size() > limits_.files || shelf > limits_.shelf_bytes)) {
        const auto oldest =
            std::min_element(last_.begin(), last_.end(), [](const auto& a, const auto& b) {
                return a.second->facts.start_time() < b.second->facts.start_time();
            });
        shelf -= oldest->second->shelf->bytes();
        last_.erase(oldest);
    }
}

void LivingFiles::give_up_beyond_limits(const std::filesystem::path& but) {
    drop_last_beyond_limits();
    std::uint64_t held = 0;
    std::uint64_t shelf = 0;
    for (const auto& [path, followed] : files_) {
        held += followed.held_bytes;
        shelf += followed.shelf_bytes;
    }
    while (files_.size() > 1 && (files_.size() > limits_.files || held > limits_.held_bytes ||
                                 shelf > limits_.shelf_bytes)) {
        auto oldest = files_.end();
        for (auto at = files_.begin(); at != files_.end(); ++at) {
            if (at->first == but) continue;
            if (oldest == files_.end() || at->second.turn < oldest->second.turn) oldest = at;
        }
        held -= oldest->second.held_bytes;
        shelf -= oldest->second.shelf_bytes;
        files_.erase(oldest);
        ++given_up_;
    }
}

std::uint64_t LivingFiles::take_given_up() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(given_up_, 0);
}

void LivingFiles::forget(const std::filesystem::path& path) {
    const std::scoped_lock lock(mutex_);
    files_.erase(path);
}

void LivingFiles::keep_last(std::shared_ptr<const KeptVolume> volume) {
    if (!volume || volume->facts.station.empty()) return;
    const std::scoped_lock lock(mutex_);
    auto& last = last_[volume->facts.station];
    if (last && last->facts.start_time() > volume->facts.start_time()) return;
    last = std::move(volume);
    drop_last_beyond_limits();
}

std::shared_ptr<const KeptVolume> LivingFiles::last_of(const std::string& station) const {
    const std::scoped_lock lock(mutex_);
    const auto at = last_.find(station);
    return at == last_.end() ? nullptr : at->second;
}

std::size_t LivingFiles::count() const {
    const std::scoped_lock lock(mutex_);
    return files_.size();
}

}  // namespace stormcellar::pipeline
