#include "notify/outbox.h"

#include <algorithm>
#include <memory>
#include <span>
#include <system_error>
#include <utility>

namespace stormcellar::notify {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view waits = ".json", is_done = ".sent";
constexpr std::size_t seconds_length = 15;  // YYYYMMDD_HHMMSS
constexpr std::size_t time_length = seconds_length + 4;
constexpr std::uint64_t most_message_bytes = std::uint64_t{64} << 10;

bool is_of_a_cell(char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-' || c == '.';
}

}  // namespace

std::string MessageName::id() const {
    const auto milliseconds = time - std::chrono::floor<std::chrono::seconds>(time);
    return fmt::format("{}_{:03}_{}", format_compact(time), milliseconds.count(), cell);
}

std::optional<MessageName> parse_id(std::string_view id) {
    if (id.size() <= time_length + 1 || !std::ranges::all_of(id, is_of_a_cell)) return std::nullopt;
    const auto seconds = parse_compact(id.substr(0, seconds_length));
    if (!seconds) return std::nullopt;
    int milliseconds = 0;
    for (const char c : id.substr(seconds_length + 1, 3))
        milliseconds = 10 * milliseconds + (c - '0');
    MessageName name{*seconds + std::chrono::milliseconds{milliseconds},
                     std::string(id.substr(time_length + 1))};
    // Accept a text only if id() writes the same text.
    return name.id() == id ? std::optional{std::move(name)} : std::nullopt;
}

Result<std::unique_ptr<Outbox>> Outbox::open(FileSystem& file_system, fs::path directory) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    if (Status swept = remove_temporaries(file_system, directory); !swept) return pass_on(swept);
    std::unique_ptr<Outbox> outbox(new Outbox(file_system, std::move(directory)));
    const MutexLock lock(outbox->mutex_);
    for (fs::directory_iterator file(outbox->directory_, error), end; !error && file != end;
         file.increment(error))
        outbox->note(file->path());
    if (error) return fail(ErrorCode::io, "{}: {}", outbox->directory_.native(), error.message());
    return outbox;
}

// Remembers a file of the directory.
void Outbox::note(const fs::path& file) {
    const auto name = parse_id(file.stem().native());
    const std::string ending = file.extension();
    if (!name || (ending != waits && ending != is_done)) return;
    (ending == waits ? waiting_ : settled_).insert(*name);
    UtcTime& last = last_[name->cell];
    last = std::max(last, name->time);
}

fs::path Outbox::path_of(const MessageName& name, std::string_view ending) const {
    return directory_ / fmt::format("{}{}", name.id(), ending);
}

Result<std::size_t> Outbox::put(const MessageName& name, const std::string& text) {
    const MutexLock lock(mutex_);
    const fs::path path = path_of(name, waits);
    if (Status written = write_file_atomically(file_system_, path,
                                               std::as_bytes(std::span(text.data(), text.size())));
        !written)
        return pass_on(written);
    note(path);
    std::size_t dropped = 0;
    for (; waiting_.size() > most_waiting; ++dropped) {
        const MessageName oldest = *waiting_.begin();
        if (Status settled = settle_locked(oldest); !settled) return pass_on(settled);
    }
    return dropped;
}

std::optional<MessageName> Outbox::oldest() const {
    const MutexLock lock(mutex_);
    return waiting_.empty() ? std::nullopt : std::optional{*waiting_.begin()};
}

Result<std::string> Outbox::read(const MessageName& name) const {
    const auto bytes = read_file(path_of(name, waits), most_message_bytes);
    if (!bytes) return pass_on(bytes);
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

Status Outbox::settle(const MessageName& name) {
    const MutexLock lock(mutex_);
    return settle_locked(name);
}

Status Outbox::settle_locked(const MessageName& name) {
    // Even if the rename fails, forget that the message waits. Otherwise it would be delivered
    // again and again until the disk works.
    waiting_.erase(name);
    settled_.insert(name);
    if (Status renamed = file_system_.rename(path_of(name, waits), path_of(name, is_done));
        !renamed)
        return renamed;
    return file_system_.sync_directory(directory_);
}

std::optional<UtcTime> Outbox::last_of(const std::string& cell) const {
    const MutexLock lock(mutex_);
    const auto last = last_.find(cell);
    return last == last_.end() ? std::nullopt : std::optional{last->second};
}

void Outbox::forget_before(UtcTime time) {
    const MutexLock lock(mutex_);
    while (!settled_.empty() && settled_.begin()->time < time) {
        (void)file_system_.remove(path_of(*settled_.begin(), is_done));
        settled_.erase(settled_.begin());
    }
    std::erase_if(last_, [&](const auto& one) { return one.second < time; });
}

std::size_t Outbox::waiting() const {
    const MutexLock lock(mutex_);
    return waiting_.size();
}

}  // namespace stormcellar::notify
