#include "pipeline/ingest/followed_files.h"

#include <algorithm>
#include <utility>

namespace stormcellar::pipeline {
namespace {

constexpr std::chrono::minutes farthest_ahead{10};  // a radar's clock may be ahead by this much

}  // namespace

std::shared_ptr<FollowedFile> FollowedFiles::find(const std::filesystem::path& path) const {
    const MutexLock lock(mutex_);
    return files_.find(path);
}

std::shared_ptr<FollowedFile> FollowedFiles::begin(const std::filesystem::path& path,
                                                   const std::string& fallback_station,
                                                   const std::string& station) {
    {
        const MutexLock lock(mutex_);
        if (files_.was_given_up(path) || !files_.make_place(station)) return nullptr;
    }
    FollowedFile::Options options = options_;
    options.fallback_station = fallback_station;
    auto begun = FollowedFile::begin(path, options);
    if (!begun) return nullptr;
    std::shared_ptr<FollowedFile> file = std::move(*begun);
    const MutexLock lock(mutex_);
    files_.add(path, file, station);
    return file;
}

bool FollowedFiles::grew(const std::filesystem::path& path, const FollowedFile& file,
                         const std::string& station) {
    const MutexLock lock(mutex_);
    const bool stands = files_.grew(path, &file, station, file.growth());
    drop_last_beyond_limits();
    return stands;
}

void FollowedFiles::give_up(const std::filesystem::path& path) {
    const MutexLock lock(mutex_);
    files_.give_up(path);
}

void FollowedFiles::drop_last_beyond_limits() {
    std::uint64_t shelf = files_.shelf_bytes();
    for (const auto& [station, volume] : last_)
        shelf += volume->shelf->bytes();
    // Names of sites come from outside, so there may be as many sites as files.
    while (!last_.empty() && (last_.size() > limits_.count || shelf > limits_.shelf_bytes)) {
        const auto oldest =
            std::min_element(last_.begin(), last_.end(), [](const auto& a, const auto& b) {
                return a.second->facts.start_time() < b.second->facts.start_time();
            });
        shelf -= oldest->second->shelf->bytes();
        last_.erase(oldest);
    }
}

std::uint64_t FollowedFiles::take_given_up() {
    const MutexLock lock(mutex_);
    return files_.take_given_up();
}

void FollowedFiles::forget(const std::filesystem::path& path) {
    const MutexLock lock(mutex_);
    files_.forget(path);
}

void FollowedFiles::keep_last(std::shared_ptr<const ShelvedVolume> volume) {
    if (!volume || volume->facts.station.empty()) return;
    // Do not keep a volume that claims to be from the future, because no later volume would replace
    // it.
    if (volume->facts.start_time() > now_utc() + farthest_ahead) return;
    const MutexLock lock(mutex_);
    auto& last = last_[volume->facts.station];
    if (last && last->facts.start_time() > volume->facts.start_time()) return;
    last = std::move(volume);
    drop_last_beyond_limits();
}

std::shared_ptr<const ShelvedVolume> FollowedFiles::last_of(const std::string& station) const {
    const MutexLock lock(mutex_);
    const auto at = last_.find(station);
    return at == last_.end() ? nullptr : at->second;
}

std::size_t FollowedFiles::count() const {
    const MutexLock lock(mutex_);
    return files_.count();
}

std::uint64_t FollowedFiles::held_bytes() const {
    const MutexLock lock(mutex_);
    return files_.held_bytes();
}

}  // namespace stormcellar::pipeline
