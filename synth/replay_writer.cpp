#include "synth/replay_writer.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> system_failure(const fs::path& path) {
    return fail(ErrorCode::io, "{}: {}", path.native(), std::system_category().message(errno));
}

Result<int> open_for(const fs::path& path, int flags) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0644);
    if (file < 0) return system_failure(path);
    return file;
}

Status write_all(const fs::path& path, int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return system_failure(path);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

}  // namespace

PieceWriter::~PieceWriter() {
    for (const auto& [path, file] : open_)
        ::close(file);
}

Status PieceWriter::append(const fs::path& path, std::span<const std::byte> bytes) {
    const auto known = std::find_if(open_.begin(), open_.end(),
                                    [&path](const auto& entry) { return entry.first == path; });
    if (known != open_.end()) {
        open_.splice(open_.end(), open_, known);
    } else {
        const auto file = open_for(path, O_APPEND);
        if (!file) return pass_on(file);
        open_.emplace_back(path, *file);
    }
    auto written = write_all(path, open_.back().second, bytes);
    if (!written) return written;
    while (open_.size() > most_open_) {
        auto closed = close_oldest();
        if (!closed) return closed;
    }
    return {};
}

Status PieceWriter::put(const fs::path& path, std::span<const std::byte> bytes) {
    const auto file = open_for(path, O_TRUNC);
    if (!file) return pass_on(file);
    auto written = write_all(path, *file, bytes);
    if (::close(*file) != 0 && written) return system_failure(path);
    return written;
}

Status PieceWriter::close_oldest() {
    const auto [path, file] = std::move(open_.front());
    open_.pop_front();
    if (::close(file) != 0) return system_failure(path);
    return {};
}

Status PieceWriter::close() {
    Status outcome;
    while (!open_.empty()) {
        auto closed = close_oldest();
        if (!closed && outcome) outcome = std::move(closed);
    }
    return outcome;
}

}  // namespace stormcellar::synth
