#include "daemon/status/status_file.h"

#include <span>

#include <fmt/format.h>

#include "base/printable.h"
#include "daemon/log/log.h"

namespace stormcellar::daemon {

StatusFile::StatusFile(FileSystem& file_system, const std::filesystem::path& directory,
                       Notifier& notifier)
    : file_system_(file_system),
      path_(directory / "status.json"),
      temporary_(directory / fmt::format("{}status", temporary_prefix)),
      notifier_(notifier) {}

Status StatusFile::write(const std::string& text) {
    // A daemon that was killed while writing may have left this file.
    (void)file_system_.remove(temporary_);
    const Result<int> descriptor = file_system_.create_exclusive(temporary_);
    if (!descriptor) return pass_on(descriptor);
    Status written = file_system_.write_at(*descriptor, 0, std::as_bytes(std::span{text}));
    file_system_.close(*descriptor);
    if (written) written = file_system_.rename(temporary_, path_);
    if (!written) (void)file_system_.remove(temporary_);
    return written;
}

bool StatusFile::publish(const std::function<Texts()>& make, SteadyTime now, bool force) {
    if (!force && (!changed_ || now < next_)) return false;
    changed_ = false;
    next_ = now + std::chrono::seconds{1};
    const Texts texts = make();
    notifier_.send("STATUS=" + texts.line);
    const Status written = write(texts.json);
    if (!written && !failing_) {
        log_error({.event = Event::status_unwritten, .file = path_},
                  "cannot write the status file {}: {}", printable(path_.native()),
                  printable(written.error().message));
    }
    failing_ = !written;
    changed_ = failing_;  // true: the next call tries again
    return true;
}

std::optional<SteadyTime> StatusFile::next_time() const {
    if (!changed_) return std::nullopt;
    return next_;
}

}  // namespace stormcellar::daemon
