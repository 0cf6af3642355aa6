#include "daemon/queue/tried_files.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "stormcellar/base/file_system.h"

namespace stormcellar::daemon {
namespace {

constexpr std::uint64_t most_tried_bytes = std::uint64_t{1} << 20;

// Files that ran together when the process ended are tried again at different times, so that the
// file that ends the process runs alone.
constexpr std::chrono::seconds apart{10};

// Reads a number and the blank after it.
std::optional<std::int64_t> take_number(std::string_view& text) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end == text.data() + text.size() || *end != ' ')
        return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
    return number;
}

std::chrono::seconds wait_after(int ends) {
    return std::chrono::seconds{2} * (1 << (2 * std::clamp(ends - 1, 0, 5)));
}

}  // namespace

TriedFiles::TriedFiles(const std::filesystem::path& file) {
    if (const auto bytes = read_file(file, most_tried_bytes))
        read({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    file_ = Descriptor{::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0640)};
    write();
}

// Reads the list. Each entry is "ENDS RUNNING SIZE TIME PATH" and a zero byte; an empty entry ends
// the list. Skips invalid entries and files that no longer exist.
void TriedFiles::read(const std::string& text) {
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::size_t end = rest.find('\0');
        if (end == std::string_view::npos) return;
        std::string_view entry = rest.substr(0, end);
        if (entry.empty()) return;
        rest.remove_prefix(end + 1);
        const auto ends = take_number(entry), running = take_number(entry);
        const auto size = take_number(entry), modified = take_number(entry);
        if (!modified || !size || !running || !ends || tried_.size() == most_remembered) continue;
        Tried tried;
        tried.ends = static_cast<int>(std::clamp<std::int64_t>(*ends, 0, most_ends));
        tried.ends = std::min(most_ends, tried.ends + (*running != 0 ? 1 : 0));
        tried.stamp.size_bytes = static_cast<std::uint64_t>(*size);
        tried.stamp.modified_ns = *modified;
        const std::string path{entry};
        if (::access(path.c_str(), F_OK) == 0) tried_[path] = tried;
    }
}

void TriedFiles::write() {
    if (!file_.is_open()) return;
    std::string text;
    for (const auto& [path, tried] : tried_) {
        text += fmt::format("{} {} {} {} {}", tried.ends, tried.is_running ? 1 : 0,
                            tried.stamp.size_bytes, tried.stamp.modified_ns, path);
        text += '\0';
    }
    // End the list with an empty entry: if the process ends before the file is truncated, the rest
    // of an older, longer list follows.
    text += '\0';
    const ssize_t written = ::pwrite(file_.number(), text.data(), text.size(), 0);
    if (::ftruncate(file_.number(), std::max<ssize_t>(0, written)) != 0) file_ = Descriptor{};
}

std::map<std::filesystem::path, std::chrono::seconds> TriedFiles::waits() const {
    const MutexLock lock(mutex_);
    std::map<std::filesystem::path, std::chrono::seconds> waits;
    std::map<int, int> before;  // number of earlier files that have ended the process equally often
    for (const auto& [path, tried] : tried_) {
        if (tried.ends < most_ends)
            waits[path] = wait_after(tried.ends) + apart * before[tried.ends]++;
    }
    return waits;
}

bool TriedFiles::is_given_up(const std::filesystem::path& path, const FileStamp& stamp) const {
    const MutexLock lock(mutex_);
    const auto tried = tried_.find(path.native());
    return tried != tried_.end() && tried->second.ends >= most_ends &&
           tried->second.stamp.size_bytes == stamp.size_bytes &&
           tried->second.stamp.modified_ns == stamp.modified_ns;
}

void TriedFiles::begin(const std::filesystem::path& path, const FileStamp& stamp) {
    const MutexLock lock(mutex_);
    Tried& tried = tried_[path.native()];
    const bool is_another =
        tried.stamp.size_bytes != stamp.size_bytes || tried.stamp.modified_ns != stamp.modified_ns;
    if (is_another && tried.ends >= most_ends) tried.ends = 0;
    tried.stamp = stamp;
    tried.is_running = true;
    write();
}

void TriedFiles::end(const std::filesystem::path& path) {
    const MutexLock lock(mutex_);
    tried_.erase(path.native());
    write();
}

}  // namespace stormcellar::daemon
